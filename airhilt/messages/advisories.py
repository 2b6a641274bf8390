"""Messages of the assistant: advisories, what they rest on, and their voice."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from airhilt.messages.base import Confidence, Header, Limit, Message, Nanoseconds, Part, Severity


class Climb(Part):
    """Climb or descend to a level and stay there; the turn is made at the same time."""

    action: Literal["altitude"] = "altitude"
    sense: Literal["climb", "descend"]
    altitude_ft: float
    vertical_rate_fpm: float = Field(gt=0.0)
    turn_deg: float = Field(
        default=0.0, ge=-180.0, le=180.0, description="turn from the present track, to the right"
    )


class Turn(Part):
    """Turn by an angle from the present track."""

    action: Literal["turn"] = "turn"
    degrees: float = Field(ge=-180.0, le=180.0, description="positive to the right")


class MaintainLevel(Part):
    """Stay at, or level off at, a level."""

    action: Literal["maintain"] = "maintain"
    altitude_ft: float


class GoAround(Part):
    """Break the approach off."""

    action: Literal["go_around"] = "go_around"
    runway: str


class CancelTakeoff(Part):
    """Do not take off, or reject the takeoff."""

    action: Literal["cancel_takeoff"] = "cancel_takeoff"
    runway: str


class HoldPosition(Part):
    """Stop where you are, short of the runway."""

    action: Literal["hold_position"] = "hold_position"
    runway: str


class Confirm(Part):
    """Ask for, or say again, what was heard with too little confidence."""

    action: Literal["confirm"] = "confirm"
    callsign: str = Field(description="callsign of the aircraft or vehicle that the call concerns")
    slot: str = Field(
        description="part of the call that is in doubt", examples=["callsign", "runway", "altitude"]
    )


Recommendation = Annotated[
    Climb | Turn | MaintainLevel | GoAround | CancelTakeoff | HoldPosition | Confirm,
    Field(discriminator="action"),
]


class Evidence(Part):
    """Evidence on which an advisory rests."""

    sources: tuple[str, ...] = Field(description="modalities that the advisory rests on")
    time_to_loss_s: float | None = Field(
        default=None, description="time until separation is lost, if nobody reacts"
    )
    time_to_closest_approach_s: float | None = None
    horizontal_at_closest_approach_m: float | None = None
    vertical_at_closest_approach_m: float | None = None
    runway: str | None = None
    time_to_go_s: float | None = Field(
        default=None, description="time until the user of the runway reaches the obstacle"
    )
    note: str = ""
    radio_ids: tuple[str, ...] = Field(default=(), description="ids of transmissions")
    camera_ids: tuple[str, ...] = Field(default=(), description="names of cameras")
    tracks: tuple[str, ...] = Field(
        default=(), description="icao24 of ADS-B tracks, and names of other tracks"
    )
    rules: tuple[str, ...] = Field(
        default=(), description="names of the rules that were triggered", examples=[["occupancy"]]
    )
    shares: dict[str, Confidence] = Field(
        default_factory=dict,
        description="share of each modality in the judgement, by its name in `sources`; they add "
        "up to 1; empty: not told",
    )
    inconsistencies: tuple[str, ...] = Field(
        default=(),
        description="faults of the data that the advisory rests on",
        examples=[["ADS-B of AAL123 inconsistent"]],
    )


AdvisoryKind = Literal[
    "loss_of_separation", "readback_mismatch", "runway_conflict", "clarification"
]
"""Kind of conflict, or ``clarification`` of a call that was heard with too little confidence."""
CONTROLLER = "ATC"
"""Recipient of the advisories to the controller."""
Told = Literal["crew", "controller", "both"]
"""Recipients of advisories about conflicts: crews and drivers, the controller, or both."""


class Advisory(Message):
    """``advisory/<recipient>``: advisory on one conflict to one recipient; ``t_ns`` is t_dec.

    ``id`` begins with the name of the worker, so that ids of two workers differ. The advisory is
    published again with a higher ``revision`` when its severity or recommendation changes, and a
    last time with ``active`` false when the conflict is over.
    """

    limit = Limit(size_bytes=32_000, rate_hz=50)
    id: str = Field(pattern=r"^[A-Za-z0-9_.-]{1,80}$")
    revision: int = Field(ge=0)
    recipient: str = Field(
        pattern=r"^[A-Za-z0-9_-]{1,20}$",
        description="ATC, a callsign, or an icao24 while there is no callsign",
    )
    recipients: tuple[str, ...]
    kind: AdvisoryKind
    severity: Severity
    active: bool = True
    traffic: tuple[str, ...] = Field(description="callsigns (or icao24) of those in conflict")
    message: str
    recommendation: Recommendation | None = None
    recommendations: dict[str, Recommendation] = Field(
        default_factory=dict,
        description="to the controller: what is recommended to each aircraft and vehicle, by "
        "callsign",
    )
    evidence: Evidence
    t_ready_ns: Nanoseconds = Field(description="arrival of the last input that it rests on")


class Rejection(Part):
    """Part of the answer of a language model that was not used."""

    subject: str = Field(description="what it is about, such as an advisory and its recipient")
    answered: str = Field(description="what the model answered")
    reason: str


class ModelExchange(Message):
    """``llm/<worker>``: what a language model was asked and answered, and what became of it.

    Where an answer is missing or rejected, the rule's own advisory or text was published.
    """

    limit = Limit(size_bytes=4_000_000, rate_hz=10)
    model: str = Field(description="its name at the endpoint")
    task: Literal["wording", "decision"]
    advisories: tuple[str, ...] = Field(default=(), description="ids of the advisories concerned")
    question: str = Field(description="JSON that the model was given")
    answer: str | None = Field(description="text that it answered; null if none came")
    failure: str = Field(default="", description="why nothing of it was used; empty if it was read")
    rejections: tuple[Rejection, ...] = ()


class AdvisoryAudio(Header):
    """``tts/<advisory id>``: attachment to the audio of an advisory, PCM 16 kHz mono.

    ``t_ns`` is the paper's t_tts: the beginning of the voice.
    """

    limit = Limit(size_bytes=16_000_000, rate_hz=10)
    id: str = Field(description="id of the advisory")
    revision: int = Field(ge=0)
    recipient: str
    text: str
    t_dec_ns: Nanoseconds = Field(description="time of the decision")
    engine: str
    sample_rate_hz: int = 16_000
    samples: int = Field(ge=0)
    word_ends: tuple[int, ...] = Field(
        default=(),
        description="sample at which each word of the text has been said, words being separated "
        "by spaces; empty: not known, so that the characters count in proportion",
    )
    sha256: str = Field(description="of the PCM")

    @property
    def duration_s(self) -> float:
        """Duration of the voice, in s."""
        return self.samples / self.sample_rate_hz

    def said_after_s(self, characters: int) -> float:
        """Return the time from its beginning until so many characters of its text are said, in s.

        Without times of words, the characters count in proportion of the whole duration.
        """
        if not self.text or characters >= len(self.text):
            return self.duration_s
        words = len(self.text[:characters].split())
        if words and len(self.word_ends) == len(self.text.split()):
            return self.word_ends[words - 1] / self.sample_rate_hz
        return self.duration_s * characters / len(self.text)
