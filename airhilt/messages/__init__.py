"""All messages on the bus: one module for each family of keys.

The JSON Schemas that ``airhilt schema`` prints come from here only.

Times are integer nanoseconds of simulation time. ``t_ns`` is the time of publication. A worker
leaves it out and the run sets it on delivery, because only the run knows how late the worker is.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any, NamedTuple

from pydantic import BaseModel, TypeAdapter
from pydantic_core import from_json

from airhilt.messages.advisories import (
    CONTROLLER,
    Advisory,
    AdvisoryAudio,
    AdvisoryKind,
    CancelTakeoff,
    Climb,
    Confirm,
    Evidence,
    GoAround,
    HoldPosition,
    MaintainLevel,
    ModelExchange,
    Recommendation,
    Rejection,
    Told,
    Turn,
)
from airhilt.messages.base import (
    LAST_NS,
    SPEAK_MIN_LEVEL,
    Confidence,
    Header,
    Limit,
    Message,
    Nanoseconds,
    Part,
    Severity,
    VisibleClass,
    key_chunk,
)
from airhilt.messages.cameras import (
    CONFIRMED_HITS,
    EXPOSURE_LEFT_OUT,
    Box,
    CameraFrame,
    CameraInfo,
    CameraView,
    Detection,
    Detections,
)
from airhilt.messages.cockpit import CockpitInstruments, EquipmentAlert, VehiclePosition
from airhilt.messages.radio import (
    ADVISORY_CALL,
    ASSISTANT,
    EnhancedTransmission,
    Transmission,
    TransmissionAudio,
    TransmissionChunk,
    TransmissionClosed,
    TransmissionOpened,
)
from airhilt.messages.run import (
    AirportBriefing,
    Briefing,
    Clock,
    GeodeticPoint,
    Modality,
    ModalityState,
    Phase,
    RosterEntry,
    RunwayBriefing,
    Status,
)
from airhilt.messages.seats import (
    FROM_MICROPHONE,
    SEAT_AUDIO,
    SHORTEST_SECRET,
    ActorCommand,
    AgreeToUses,
    AnswerQuestion,
    CommandOffer,
    FlyCommand,
    FrequencyKhz,
    HearCall,
    LeaveSeat,
    NasaTlx,
    PageRefusal,
    PerceiveAdvisory,
    PressToTalk,
    ReleaseToTalk,
    SayText,
    SayVoice,
    SeatAct,
    SeatAction,
    SeatAnswer,
    SeatAudio,
    SeatAudioChunk,
    SeatAudioClosed,
    SeatAudioOpened,
    SeatNotice,
    SeatState,
    SetPace,
    TakeSeat,
    TaskCard,
    TuneFrequencies,
    Use,
    WorkloadQuestion,
)
from airhilt.messages.surveillance import (
    EMERGENCY_STATES,
    AdsbReport,
    EmergencyState,
    EmitterCategory,
    LiveReport,
    PlotKind,
    RadarInfo,
    RadarKind,
    RadarPlot,
    SurfaceTrack,
    TcasReply,
    TransponderMode,
)
from airhilt.messages.transcripts import PartialTranscript, Transcript, Word
from airhilt.messages.truth import (
    AFTER_STALL_S,
    STALLED,
    ActorTruth,
    Arrival,
    CameraTruth,
    ConflictPhase,
    ConflictTruth,
    DropCause,
    DroppedMessages,
    Event,
    EventKind,
    HearingTruth,
    RunwayTruth,
    SightingTruth,
    SpokenTruth,
)
from airhilt.messages.worker_protocol import (
    RUN,
    UNREGISTERED,
    WORKER_NAME,
    DeclaredLatency,
    Grant,
    GrantInput,
    InputSpec,
    StepOutput,
    StepReply,
    WorkerDescription,
    is_match,
    parts_of,
)

BUS_MESSAGES: dict[str, type[Message]] = {
    "clock": Clock,
    "briefing": Briefing,
    "status/{modality}": Status,
    "radio/{frequency_khz}/tx": Transmission,
    "radio/{frequency_khz}/audio (opened)": TransmissionOpened,
    "radio/{frequency_khz}/audio (chunk)": TransmissionChunk,
    "radio/{frequency_khz}/audio (closed)": TransmissionClosed,
    "enhanced/{frequency_khz}": EnhancedTransmission,
    "adsb/{icao24}": AdsbReport,
    "live/{icao24}": LiveReport,
    "radar/{site}/info": RadarInfo,
    "radar/{site}": RadarPlot,
    "surface/{airport}": SurfaceTrack,
    "tcas/{callsign}": TcasReply,
    "cockpit/{callsign}": CockpitInstruments,
    "cockpit/{callsign}/position": VehiclePosition,
    "equipment/{equipment}/{recipient}": EquipmentAlert,
    "camera/{camera}/info": CameraInfo,
    "camera/{camera}/frame": CameraFrame,
    "vision/{camera}": Detections,
    "asr/{frequency_khz}": Transcript,
    "asr/{frequency_khz}/partial": PartialTranscript,
    "advisory/{recipient}": Advisory,
    "tts/{id}": AdvisoryAudio,
    "llm/{worker}": ModelExchange,
    "command/{actor}": ActorCommand,
    "page": PageRefusal,
    "seat/{seat}": SeatState,
    "seat/{seat}/do": SeatAction,
    "seat/{seat}/audio (opened)": SeatAudioOpened,
    "seat/{seat}/audio (chunk)": SeatAudioChunk,
    "seat/{seat}/audio (closed)": SeatAudioClosed,
    "truth/state/{actor}": ActorTruth,
    "truth/radio/{id}": SpokenTruth,
    "truth/hearing/{actor}": HearingTruth,
    "truth/camera/{camera}": CameraTruth,
    "truth/conflict": ConflictTruth,
    "truth/runway/{runway}": RunwayTruth,
    "truth/event": Event,
    "truth/dropped": DroppedMessages,
}
"""The message of each key below ``airhilt/<run>/``."""
WORKER_MESSAGES: dict[str, type[BaseModel]] = {
    "worker/{name}/describe (reply)": WorkerDescription,
    "worker/{name}/step (attachment)": Grant,
    "worker/{name}/step (attachment of the reply)": StepReply,
}
"""The messages of the worker protocol."""
WORKER_OUTPUTS: dict[str, type[Message]] = {
    "enhanced": EnhancedTransmission,
    "asr": Transcript,
    "vision": Detections,
    "advisory": Advisory,
    "tts": AdvisoryAudio,
    "llm": ModelExchange,
    "equipment": EquipmentAlert,
}
"""Messages that a worker may publish, by the first part of the key; never sensors or truth. Only
equipment of the world publishes on ``equipment``."""


class Pieces(NamedTuple):
    """The pieces of a transmission, which share a key: the name of their type, and the type."""

    name: str
    type: TypeAdapter[Any]


PIECES = {
    "radio": Pieces("TransmissionAudio", TypeAdapter(TransmissionAudio)),
    "seat": Pieces("SeatAudio", TypeAdapter(SeatAudio)),
}
"""Pieces by the first part of their key, which ends on ``audio``."""


def pieces_of(key: str) -> Pieces | None:
    """Return what the pieces with a key below ``airhilt/<run>/`` are, None if it has no pieces."""
    first, *others = key.split("/")
    return PIECES.get(first) if others[-1:] == ["audio"] else None


@lru_cache(maxsize=4096)
def bus_message(key: str) -> type[Message] | None:
    """Return the class of the messages with a key below ``airhilt/<run>/``, None if it has none.

    Pieces of a transmission have none: their key has three.
    """
    parts = key.split("/")
    for template, model in BUS_MESSAGES.items():
        wanted = template.split("/")
        if len(wanted) == len(parts) and all(
            one.startswith("{") or one == part for one, part in zip(wanted, parts, strict=True)
        ):
            return model
    return None


def decode(key: str, data: bytes) -> Message | dict[str, Any]:
    """Return the message in the JSON of a key below ``airhilt/<run>/``.

    One whose class is not known, such as that of another package, is a dictionary. It raises
    ValueError if the JSON is no such message.
    """
    if (model := bus_message(key)) is not None:
        return model.model_validate_json(data)
    if (pieces := pieces_of(key)) is not None:
        piece: Message = pieces.type.validate_json(data)
        return piece
    content: dict[str, Any] = from_json(data)
    return content


def worker_output(key: str) -> type[Message] | None:
    """Return the class of the messages that a worker may publish on a key, None if there is none.

    The first part of a key tells it, except for partial transcripts.
    """
    first, _, rest = key.partition("/")
    if first == "asr" and rest.endswith("/partial"):
        return PartialTranscript
    return WORKER_OUTPUTS.get(first)


def json_schemas(more: Mapping[str, type[BaseModel]] | None = None) -> dict[str, Any]:
    """Return all schemas in one JSON object, by key, as ``airhilt schema`` prints them.

    Parameters
    ----------
    more
        Messages of other packages, by key.
    """
    return {
        key: {"title": model.__name__, **TypeAdapter(model).json_schema(), **_limit(model)}
        for key, model in {**BUS_MESSAGES, **WORKER_MESSAGES, **(more or {})}.items()
    }


def _limit(model: type[BaseModel]) -> dict[str, Any]:
    """Return the limit of a class of messages, as its schema has it."""
    limit = model.limit if issubclass(model, Message) else None
    return {} if limit is None else {"x-airhilt-limit": limit._asdict()}
