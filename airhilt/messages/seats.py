"""Messages between a run and the people at its seats.

A person acts by a query on ``seat/<seat>/do`` with a `SeatAction`, which the run answers with a
`SeatAnswer`. What the run knows of a seat is its `SeatState` on ``seat/<seat>``.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Base64Bytes, Field, field_validator, model_validator

from airhilt.commands import Command
from airhilt.messages.base import Limit, Message, Nanoseconds, Part, Severity
from airhilt.messages.radio import TransmissionChunk, TransmissionClosed, TransmissionOpened

Use = Literal["voice", "words"]
"""Use to which a person may agree: of the voice, or of typed words."""
FrequencyKhz = Annotated[
    int, Field(ge=118_000, le=137_000, description="in the aeronautical mobile band")
]
HOLDER = r"^[A-Za-z0-9_-]{1,64}$"
SHORTEST_SECRET = 16
"""Least length of the secret of a holder, in characters."""


class SeatAudioOpened(TransmissionOpened):
    """``seat/<seat>/audio``: attachment without payload; a seat begins to receive a transmission.

    Only a seat has it whose receiver has a reception of its own. Whoever keyed is not known there.
    """

    seat: str


class SeatAudioChunk(TransmissionChunk):
    """``seat/<seat>/audio``: attachment to at most 0.5 s of what a seat receives, as PCM."""

    seat: str


class SeatAudioClosed(TransmissionClosed):
    """``seat/<seat>/audio``: attachment without payload; a transmission that a seat got has ended.

    ``snr_db`` is the ratio at the seat.
    """

    seat: str


SeatAudio = Annotated[
    SeatAudioOpened | SeatAudioChunk | SeatAudioClosed, Field(discriminator="phase")
]
"""Messages on ``seat/<seat>/audio``."""


class ActorCommand(Message):
    """``command/<actor>``: command of a person or an external program to an actor."""

    limit = Limit(size_bytes=16_000, rate_hz=50)
    command: Command


FROM_MICROPHONE = "microphone."
"""Beginning of the ids of the transmissions that people speak."""

# --- what a person does -------------------------------------------------------------------------


class TakeSeat(Part):
    """Take the seat. Who has it already keeps it; the person agrees to nothing yet."""

    do: Literal["take"] = "take"


class LeaveSeat(Part):
    """Leave the seat. Its script goes on by itself."""

    do: Literal["leave"] = "leave"


class AgreeToUses(Part):
    """Agree to these uses of voice and typed words from now on, and to no others."""

    do: Literal["agree"] = "agree"
    uses: tuple[Use, ...] = Field(max_length=2)


class TuneFrequencies(Part):
    """Listen to these frequencies from now on; a person who takes a seat listens to all of it."""

    do: Literal["tune"] = "tune"
    frequencies_khz: tuple[FrequencyKhz, ...] = Field(max_length=20, description="empty: none")


class PressToTalk(Part):
    """Press the transmit button."""

    do: Literal["press"] = "press"
    frequency_khz: FrequencyKhz | None = Field(
        default=None, description="null: the first one of the seat"
    )
    delay_s: float = Field(
        default=0.0,
        ge=0.0,
        le=60.0,
        description="from pressing the button until the message was sent, in s of wall time",
    )


class SayVoice(Part):
    """Speak while the button is held: PCM, 16 kHz, mono, 16 bits, little-endian, in base64."""

    do: Literal["say"] = "say"
    pcm: Base64Bytes = Field(
        max_length=32_000,
        description="at most 0.75 s, which are 32,000 characters; empty in the log of a run with "
        "`--no-voice-recording`",
    )

    @field_validator("pcm")
    @classmethod
    def _has_whole_samples(cls, pcm: bytes) -> bytes:
        if len(pcm) % 2:
            raise ValueError(f"{len(pcm)} bytes; expected an even number: samples have 16 bits")
        return pcm


class ReleaseToTalk(Part):
    """Release the transmit button."""

    do: Literal["release"] = "release"


class SayText(Part):
    """Say typed words on the radio, in the voice of the seat."""

    do: Literal["text"] = "text"
    text: str = Field(min_length=1, max_length=600)
    frequency_khz: FrequencyKhz | None = Field(
        default=None, description="null: the first one of the seat"
    )


class FlyCommand(Part):
    """Give a command to the aircraft or vehicle of the seat."""

    do: Literal["fly"] = "fly"
    command: Command


class NasaTlx(Part):
    """Ratings of the NASA Task Load Index (Hart & Staveland 1988), from 0 to 100 in steps of 5.

    Performance is 0 for perfect and 100 for failure.
    """

    mental_demand: int = Field(ge=0, le=100, multiple_of=5)
    physical_demand: int = Field(ge=0, le=100, multiple_of=5)
    temporal_demand: int = Field(ge=0, le=100, multiple_of=5)
    performance: int = Field(ge=0, le=100, multiple_of=5)
    effort: int = Field(ge=0, le=100, multiple_of=5)
    frustration: int = Field(ge=0, le=100, multiple_of=5)

    @property
    def raw_tlx(self) -> float:
        """Mean of the six ratings (Hart 2006)."""
        ratings: list[int] = list(self.model_dump().values())
        return sum(ratings) / len(ratings)


class AnswerQuestion(Part):
    """Answer the question about workload that is open; without a rating: give none."""

    do: Literal["answer"] = "answer"
    question: int = Field(ge=1, description="its number")
    isa: int | None = Field(
        default=None,
        ge=1,
        le=5,
        description="1 under-utilised, 2 relaxed, 3 comfortable, 4 high, 5 excessive",
    )
    nasa_tlx: NasaTlx | None = None

    @model_validator(mode="after")
    def _has_one_scale(self) -> AnswerQuestion:
        if self.isa is not None and self.nasa_tlx is not None:
            raise ValueError("isa and nasa_tlx; expected one of the two")
        return self


class SetPace(Part):
    """Let the time of the run pass more slowly, stand still, or pass again."""

    do: Literal["pace"] = "pace"
    factor: float = Field(
        ge=0.0, le=1.0, description="of real time; 0 lets it stand still, less than 0.1 is 0.1"
    )

    @field_validator("factor")
    @classmethod
    def _moves_or_stands(cls, factor: float) -> float:
        return factor if factor == 0.0 else max(factor, 0.1)


AfterS = Annotated[float, Field(ge=-10.0, le=10.0)]
"""Time from ``t_ns`` until something was drawn, or its first sample was audible, by the clock of
the browser, in s; negative if that was before."""


class PerceiveAdvisory(Part):
    """Say that an advisory was drawn at the seat, or is audible there."""

    do: Literal["perceive"] = "perceive"
    id: str = Field(max_length=200, description="of the advisory")
    revision: int = Field(ge=0)
    recipient: str = Field(max_length=200)
    way: Literal["seen", "heard"]
    after_s: AfterS = 0.0


class HearCall(Part):
    """Say that a transmission is audible at the seat from its beginning."""

    do: Literal["hear"] = "hear"
    id: str = Field(max_length=200, description="of the transmission")
    after_s: AfterS = 0.0


SeatAct = Annotated[
    TakeSeat
    | LeaveSeat
    | AgreeToUses
    | TuneFrequencies
    | PressToTalk
    | SayVoice
    | ReleaseToTalk
    | SayText
    | FlyCommand
    | AnswerQuestion
    | SetPace
    | PerceiveAdvisory
    | HearCall,
    Field(discriminator="do"),
]
"""Act of a person at a seat."""


class SeatAction(Message):
    """``seat/<seat>/do``: an act at a seat, as a query; the run answers with a `SeatAnswer`.

    Who takes a seat first declares the liveliness token ``seat/<seat>/holder/<holder>``, whose name
    nobody has had before, and chooses a secret. Every act carries both. The seat is held until it
    is left, or the token ends. The log has the acts that were accepted, without the secret.
    """

    limit = Limit(size_bytes=64_000, rate_hz=100)
    holder: str = Field(pattern=HOLDER, description="name of the liveliness token of the holder")
    secret: str = Field(
        default="",
        max_length=64,
        description=f"at least {SHORTEST_SECRET} characters, chosen by who takes the seat",
    )
    act: SeatAct


class SeatAnswer(Part):
    """Answer of the run to a query on ``seat/<seat>/do``."""

    answer: Literal["ok", "refused"]
    reason: str = Field(default="", description="why it is refused, in words")


# --- what the run knows of a seat ---------------------------------------------------------------


class TaskCard(Part):
    """Call of the script that is due, and that the person at a seat is to make.

    A call to the same addressee with the same instructions stands for it.
    """

    line: str = Field(description="id of the line of the script")
    due_ns: Nanoseconds
    addressed: str | None
    frequency_khz: int
    text: str = Field(description="words of the script")


class CommandOffer(Part):
    """Command that the person at a seat may give because of a call, by a `FlyCommand`.

    An automaton would carry it out because of the call.
    """

    number: int = Field(ge=1, description="of the offer in this run")
    call: str = Field(description="id of the call that was taken, or that is due at the seat")
    command: Command


class WorkloadQuestion(Part):
    """Question about workload.

    ISA (Tattersall & Foord 1996) is one number for now, asked while the run goes on; NASA-TLX is
    asked when it has come to its end, and time stands still.
    """

    number: int = Field(ge=1, description="of the question at this seat")
    scale: Literal["isa", "nasa_tlx"]
    asked_ns: Nanoseconds


class SeatNotice(Part):
    """Something that the person at a seat was told in words."""

    told_ns: Nanoseconds
    text: str


class SeatState(Message):
    """``seat/<seat>``: what the run knows of a seat, also answered to a query.

    It is published when it changes.
    """

    seat: str
    category: Literal["unit", "aircraft", "vehicle"] = "unit"
    icao24: str | None = Field(default=None, description="address of the actor; null for a unit")
    has_adsb_in: bool = Field(
        default=False, description="true if the actor shows its crew the ADS-B of others"
    )
    recipients: tuple[str, ...] = Field(
        default=(), description="names under which advisories are for the person at the seat"
    )
    frequencies_khz: tuple[int, ...]
    has_sound: bool = Field(
        default=True, description="false in a run without speech: nobody can be heard"
    )
    recogniser: Literal["none", "embedded", "other"] = Field(
        description="what turns a spoken call into words that automata understand: nothing, the "
        "model that ships with AIRHILT, which has learned from synthetic voices alone, or another"
    )
    voice_is_recorded: bool
    has_own_receiver: bool = Field(
        default=False,
        description="true if the person hears what is on ``seat/<seat>/audio``; false: what the "
        "receiver at the units' site gets",
    )
    may_pause: bool = Field(
        default=True, description="false in a run that refuses pause and slow motion"
    )
    spoken_from: Severity | None = Field(
        default=None,
        description="least severity that the assistant speaks; null: it has no voice, or none any "
        "more",
    )
    phraseology: Literal["faa", "icao"] = "faa"
    phase: Literal["waiting", "taken", "left"] = Field(
        default="waiting",
        description="waiting for its first person, taken, or left: its script goes on by itself",
    )
    holder: str | None = Field(default=None, description="name of the holder's liveliness token")
    uses: tuple[Use, ...] = Field(default=(), description="uses to which the holder agrees")
    tuned_khz: tuple[int, ...] = Field(description="frequencies that the holder listens to")
    tasks: tuple[TaskCard, ...] = Field(default=(), description="the oldest first")
    offers: tuple[CommandOffer, ...] = Field(default=(), description="the oldest first")
    question: WorkloadQuestion | None = Field(default=None, description="that has no answer yet")
    notice: SeatNotice | None = Field(default=None, description="the last one")
    pace: str = Field(default="realtime", description="at which the time passes")


class PageRefusal(Message):
    """``page``: what the page of a run has refused a browser or a stranger, in words.

    In the log it is an event of the kind ``refused``; it changes nothing of the run.
    """

    limit = Limit(size_bytes=2_000, rate_hz=50)
    text: str = Field(min_length=1, max_length=400)


SEAT_AUDIO = "seat/*/audio"
"""Keys of the sound that the receiver of one seat gets: nobody else hears it."""
