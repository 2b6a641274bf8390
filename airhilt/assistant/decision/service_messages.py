"""Request and answer of an assistant at an address, as ``airhilt schema --services`` prints them.

Times are whole milliseconds since the start of the run (``ts_ms``), as in the AIRHILT paper.
"""

from __future__ import annotations

from typing import Annotated, Any, Self

from pydantic import Base64Bytes, Field, StringConstraints, model_validator

from airhilt.assistant.decision.alerts import Alert
from airhilt.messages import (
    AdvisoryKind,
    AirportBriefing,
    CameraView,
    Confidence,
    Detection,
    EmitterCategory,
    Evidence,
    ModelExchange,
    Nanoseconds,
    Part,
    Recommendation,
    RosterEntry,
    Severity,
    Word,
)

MOST_ADVISORIES = 100
"""Largest number of advisories in one answer."""
Milliseconds = Annotated[int, Field(ge=0, description="milliseconds since the start of the run")]
Recipient = Annotated[
    str,
    StringConstraints(pattern=r"^[A-Za-z0-9_-]{1,20}$"),
    Field(description="ATC, a callsign, or an icao24 while there is no callsign"),
]
Text = Annotated[str, StringConstraints(pattern=r"^[^\x00-\x1f\x7f]{1,500}$")]
"""Words without control characters, which a terminal would obey."""
Name = Annotated[str, StringConstraints(pattern=r"^[^\x00-\x1f\x7f]{1,60}$")]


class RadioTurn(Part):
    """One transmission, as it was recognised."""

    turn_id: str
    ts_ms: Milliseconds = Field(description="start of the transmission")
    end_ms: Milliseconds
    frequency_khz: int
    text: str
    words: tuple[Word, ...] = Field(
        default=(), description="the words of `text` one by one; empty if the engine has none"
    )
    confidence: Confidence
    addressed_callsign: str | None = Field(
        description="callsign that the words name first; null if they do not begin with one"
    )
    speaker: str | None = Field(
        description="who spoke, as far as the radio knows; otherwise the callsign that the words "
        "end with, as that of a crew does; null if they do not"
    )
    overheard: bool | None = Field(
        default=None, description="neither by nor for the controller; null if that is not known"
    )


class CameraSlice(Part):
    """Objects found in one picture."""

    camera_id: str
    ts_ms: Milliseconds = Field(description="end of the exposure")
    view: CameraView
    detections: tuple[Detection, ...]


class TrackSlice(Part):
    """Last ADS-B report of one aircraft or vehicle."""

    icao24: str
    callsign: str | None
    ts_ms: Milliseconds = Field(description="the squitter reached the receiver")
    latitude_deg: float
    longitude_deg: float
    altitude_ft: float | None = Field(description="pressure altitude; null on the ground")
    on_ground: bool
    emitter_category: EmitterCategory | None
    ground_speed_kt: float
    track_deg: float
    vertical_rate_fpm: float
    nacp: int
    nacv: int


class FlightContext(Part):
    """Facts that all participants know before the run begins; see `airhilt.messages.Briefing`."""

    controller: str
    horizontal_separation_nm: float
    vertical_separation_ft: float
    roster: tuple[RosterEntry, ...]
    airport: AirportBriefing | None
    animals: tuple[str, ...]


class DeliveredMessage(Part):
    """One message of the run, as it reached the assistant."""

    key: str = Field(description="key below that of the run", examples=["adsb/a1b2c3"])
    t_in_ns: Nanoseconds = Field(description="arrival at the assistant")
    t_ns: Nanoseconds = Field(description="when it was taken: later if the assistant was busy")
    message: dict[str, Any] = Field(description="the message of that key, see `airhilt schema`")
    payload: Base64Bytes = Field(
        default=b"", description="raw bytes that the message is the header of; otherwise empty"
    )


class Delivery(Part):
    """The messages since the last answer, at the instant at which an engine decides."""

    t_ns: Nanoseconds
    messages: tuple[DeliveredMessage, ...]


class EngineDecision(Part):
    """Decision of an engine after a delivery."""

    alerts: tuple[Alert, ...] = Field(description="what is new, has changed, or is over")
    again_ns: Nanoseconds | None = Field(
        description="when to ask again even if nothing more arrives; null: not before"
    )
    exchanges: tuple[ModelExchange, ...] = ()


class AssistantRequest(Part):
    """Evidence that the assistant may know at ``ts_ms``: the last minutes of each modality."""

    ts_ms: Milliseconds
    context: FlightContext | None = Field(description="null before the briefing")
    radio: tuple[RadioTurn, ...] = Field(description="the calls of the last two minutes")
    cameras: tuple[CameraSlice, ...] = Field(description="the pictures of the last second")
    tracks: tuple[TrackSlice, ...] = Field(description="those heard in the last 15 s")
    delivery: Delivery | None = Field(
        default=None,
        description="messages instead of the above, for a service whose first answer has `inputs`",
    )


class ProposedAdvisory(Part):
    """One conflict, as the assistant judges it now, for all its recipients."""

    id: str = Field(
        pattern=r"^[A-Za-z0-9_.-]{1,60}$",
        description="name of the conflict, the same in all answers",
    )
    kind: AdvisoryKind
    severity: Severity
    recipients: tuple[Recipient, ...] = Field(min_length=1)
    traffic: tuple[Name, ...] = Field(
        min_length=1, description="callsigns (or icao24) of those in conflict"
    )
    messages: dict[str, Text] = Field(
        default_factory=dict,
        description="text for each recipient that has its own; the wording words the others",
    )
    recommendations: dict[str, Recommendation] = Field(
        default_factory=dict, description="recommended action of each recipient that should act"
    )
    evidence: Evidence = Evidence(sources=())

    @model_validator(mode="after")
    def _tells_recipients_only(self) -> Self:
        for what in ("messages", "recommendations"):
            others = sorted(set(getattr(self, what)) - set(self.recipients))
            if others:
                raise ValueError(f"{what} for {', '.join(others)}; expected recipients only")
        return self


class AssistantAnswer(Part):
    """All conflicts that hold now. One that is not listed any more is over."""

    advisories: tuple[ProposedAdvisory, ...] = Field(max_length=MOST_ADVISORIES)
    inputs: tuple[str, ...] = Field(
        default=(),
        description="keys of the messages that the service wants as they arrive, each time that "
        "some do; empty: it is asked with slices",
        examples=[["briefing", "adsb/*"]],
    )
    decision: EngineDecision | None = Field(default=None, description="answer to a delivery")

    @model_validator(mode="after")
    def _names_each_once(self) -> Self:
        names = [each.id for each in self.advisories]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ValueError(f"two advisories with the id {twice[0]!r}; expected one a conflict")
        return self
