"""Truth, for the recorder, metrics and viewers only."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from airhilt.messages.base import Confidence, Message, Nanoseconds, Part, VisibleClass
from airhilt.messages.cameras import Box


class ActorTruth(Message):
    """``truth/state/<actor>``: true state of an actor; null where a value does not apply."""

    actor: str
    category: Literal["aircraft", "vehicle", "wildlife"]
    icao24: str | None = None
    phase: str = Field(description="phase of flight or of driving, or behaviour of an animal")
    on_ground: bool
    latitude_deg: float
    longitude_deg: float
    altitude_m: float
    height_agl_m: float
    velocity_north_m_s: float
    velocity_east_m_s: float
    velocity_down_m_s: float
    roll_deg: float = 0.0
    pitch_deg: float = 0.0
    heading_deg: float
    true_airspeed_m_s: float | None = None
    calibrated_airspeed_m_s: float | None = None
    target_altitude_m: float | None = None


class SpokenTruth(Message):
    """``truth/radio/<id>``: true speaker, addressee and text of a call."""

    id: str
    speaker: str
    addressed: str | None
    frequency_khz: int
    text: str
    t_tx_ns: Nanoseconds
    t_end_ns: Nanoseconds
    in_reply_to: str | None = Field(
        default=None, description="id of the transmission that it answers"
    )
    blocked_by: tuple[str, ...] = Field(
        default=(), description="ids of the transmissions that it was mixed with"
    )
    snr_db: float | None = None
    is_from_microphone: bool = Field(
        default=False, description="true: a person spoke it, so that its words are not known"
    )


class HearingTruth(Message):
    """``truth/hearing/<actor>``: understanding of a call by one of its addressees.

    Nobody knows what a person at a seat understands by ear: ``understood`` means then that the call
    has reached the seat.
    """

    id: str = Field(description="id of the transmission")
    actor: str
    outcome: Literal["understood", "misheard", "unsure", "missed"]
    text: str = Field(description="words that reached the actor; empty if none did")
    source: Literal["ear", "transcript"]


ConflictPhase = Literal[
    "begun",
    "opened",
    "closed",
    "loss_of_separation",
    "nmac",
    "tcas_ta",
    "tcas_ra",
    "runway_incursion",
    "collision",
]


class SightingTruth(Part):
    """Truth about one actor in a picture."""

    actor: str
    label: VisibleClass
    box: Box = Field(description="around the part of the actor within the picture, hidden or not")
    pixels: float = Field(ge=0.0, description="visible area, in pixels")
    visible_fraction: Confidence = Field(description="visible part of its area within the picture")
    truncation: Confidence = Field(description="part of its whole box that is outside the picture")
    range_m: float = Field(ge=0.0)
    transmission: Confidence = Field(description="part of its contrast that the air leaves")


class CameraTruth(Message):
    """``truth/camera/<camera>``: actors that are really in a picture."""

    camera: str
    seq: int = Field(ge=0)
    t_frame_ns: Nanoseconds
    sightings: tuple[SightingTruth, ...]


class ConflictTruth(Message):
    """``truth/conflict``: beginning of a phase of a conflict between two actors.

    In the air the distances are between the actors' centres, on a runway between their outlines.
    """

    phase: ConflictPhase
    actors: tuple[str, ...]
    horizontal_m: float | None = None
    vertical_m: float | None = None
    runway: str | None = None


class Arrival(Part):
    """Aircraft on final approach."""

    actor: str
    runway: str = Field(description="direction of landing")
    time_to_threshold_s: float


class RunwayTruth(Message):
    """``truth/runway/<runway>``: occupants and arrivals of a runway, published on each change."""

    runway: str = Field(examples=["01-19"])
    occupants: tuple[str, ...]
    arrivals: tuple[Arrival, ...]


EventKind = Literal[
    "actor_ended",
    "command",
    "unable",
    "failure",
    "pilot_reacts",
    "no_response",
    "controller_reacts",
    "controller_silent",
    "step_missed",
    "worker_lost",
    "radio_lost",
    "cameras_lost",
    "unregistered",
    "refused",
    "pace",
    "seat",
    "finished",
    "stopped",
]
DropCause = Literal["size", "rate", "queue", "transport"]
"""Reason why a message of another program did not count: it was too large, there were too many in a
second or too many that waited, or it was lost before it came."""


class DroppedMessages(Message):
    """``truth/dropped``: how many messages of programs did not count, at the end of the run.

    There is one for each kind of key and cause, if there were any.
    """

    keys: str = Field(examples=["advisory/*"])
    cause: DropCause = Field(
        description="size: larger than the limit; rate: more in a second than the limit; queue: "
        "more than could wait; transport: numbers are missing among those that the sender gave"
    )
    messages: int = Field(ge=1)


STALLED = "stalled"
"""Text of the event ``pace`` when a run with seats was late and has taken the clock anew."""
AFTER_STALL_S = 5.0
"""Time of the run after a stall that is not real time yet, in s, because what people did in the
stall comes then: an assumption."""


class Event(Message):
    """``truth/event``: event in the world or in the run."""

    kind: EventKind
    subject: str
    text: str
