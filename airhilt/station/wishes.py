"""The messages of a browser: what it watches, takes, says and does."""

from __future__ import annotations

from typing import Annotated, Literal, Protocol

from pydantic import BaseModel, ConfigDict, Field, model_validator

from airhilt.commands import Command
from airhilt.messages import (
    AdvisoryPerceived,
    CallHeard,
    MicrophoneAudio,
    PaceCommand,
    SeatConsent,
    SeatListening,
    SpokenWords,
    WorkloadAnswer,
)

Frequency = Annotated[int, Field(ge=118_000, le=137_000)]


class Pressed(BaseModel):
    """The transmit button was pressed."""

    model_config = ConfigDict(extra="forbid")
    frequency_khz: Frequency | None = None
    delay_s: float = Field(
        default=0.0, ge=0.0, le=60.0, description="from pressing it until the message was here"
    )


class ConsentAnswer(BaseModel):
    """A person agrees to a use of the voice, or of typed words, or does not."""

    model_config = ConfigDict(extra="forbid")
    answer: SeatConsent
    number: int = Field(
        default=0, ge=0, le=2**53, description="sent back once the station has taken it in"
    )


class Wish(BaseModel):
    """Message of a browser: exactly one of these fields."""

    model_config = ConfigDict(extra="forbid")
    watch: str | None = Field(
        default=None,
        max_length=80,
        pattern=r"^[A-Za-z0-9_.-]+$",
        description="the camera whose pictures are shown, null for none",
    )
    take: str | None = Field(default=None, max_length=80, description="a seat")
    leave: str | None = Field(default=None, max_length=80, description="a seat")
    say: SpokenWords | None = Field(default=None, description="words at the own seat")
    fly: Command | None = Field(default=None, description="a command to the own aircraft")
    press: Pressed | None = Field(
        default=None, description="the transmit button is held: sound follows in binary messages"
    )
    release: bool | None = Field(default=None, description="the transmit button is held no more")
    consent: ConsentAnswer | None = Field(default=None, description="at the own seat")
    perceived: AdvisoryPerceived | None = Field(
        default=None, description="an advisory to the own seat was drawn or is audible"
    )
    heard: CallHeard | None = Field(
        default=None, description="a transmission is audible from its beginning"
    )
    answer: WorkloadAnswer | None = Field(
        default=None, description="to a question about workload at the own seat"
    )
    tune: tuple[Frequency, ...] | None = Field(
        default=None, max_length=20, description="frequencies in kHz that are heard at the own seat"
    )
    pace: PaceCommand | None = Field(
        default=None, description="how fast the time is to pass, from a seat"
    )
    echo: float | None = Field(
        default=None, allow_inf_nan=False, description="a number that is sent back"
    )

    @model_validator(mode="after")
    def _is_one(self) -> Wish:
        if len(self.model_fields_set) != 1:
            names = ", ".join(type(self).model_fields)
            raise ValueError(f"expected exactly one of {names}")
        return self


Claimed = Literal["ours", "taken", "claimed"]
"""Result of a claim to a seat: it is ours, or a person has it at another page, or may be about to
take it there."""


class RunLink(Protocol):
    """Actions of browsers upon a run."""

    def watch(self, cameras: set[str]) -> None:
        """Let the pictures of these cameras come, and no others."""

    def say(self, seat: str, words: SpokenWords) -> None:
        """Let a seat speak in words that were typed."""

    def speak(self, seat: str, audio: MicrophoneAudio) -> None:
        """Press, feed or release the microphone of a seat."""

    def listen(self, seat: str, listening: SeatListening) -> None:
        """Tell to which frequencies the person at a seat listens."""

    def consent(self, seat: str, consent: SeatConsent) -> None:
        """Tell whether the person at a seat agrees to the use of the voice, or of typed words."""

    def perceive(self, seat: str, perceived: AdvisoryPerceived) -> None:
        """Tell that an advisory has reached the person at a seat."""

    def hear(self, seat: str, heard: CallHeard) -> None:
        """Tell that a transmission is audible to the person at a seat."""

    def answer(self, seat: str, answer: WorkloadAnswer) -> None:
        """Answer a question about workload."""

    def claim(self, seat: str) -> Claimed:
        """Keep other pages of the run from taking a seat, and return who has it.

        It is so until the seat was taken and left, or left without having been taken. Claims to
        one seat come one after the other.
        """

    def occupy(self, seat: str, *, is_taken: bool) -> None:
        """Tell that a person has taken a seat, or has left it."""

    def set_pace(self, pace: PaceCommand) -> None:
        """Let the time of the run pass more slowly, stand still, or pass again."""

    def fly(self, seat: str, command: Command) -> None:
        """Give a command to the aircraft or vehicle of a seat."""
