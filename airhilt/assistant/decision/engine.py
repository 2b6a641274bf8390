"""The protocol of decision engines: messages in, alerts out.

It knows no keys and no bus, and nothing of queues: that is its worker's part (see
`airhilt.assistant.decision.worker`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Protocol, runtime_checkable

from pydantic import BaseModel

from airhilt.assistant.decision.alerts import Alert
from airhilt.errors import WorkerError
from airhilt.messages import (
    AdsbReport,
    Briefing,
    CockpitInstruments,
    Detections,
    Message,
    ModelExchange,
    RadarInfo,
    RadarPlot,
    Status,
    SurfaceTrack,
    TcasReply,
    Transcript,
    Transmission,
)

KEYS: Mapping[type[Message], str] = {
    Briefing: "briefing",
    AdsbReport: "adsb/*",
    Transcript: "asr/*",
    Detections: "vision/*",
    RadarInfo: "radar/*/info",
    RadarPlot: "radar/*",
    SurfaceTrack: "surface/*",
    CockpitInstruments: "cockpit/*",
    TcasReply: "tcas/*",
    Transmission: "radio/*/tx",
    Status: "status/*",
}
"""The key of each message that an engine may read by its class alone."""


class ReceivedMessage(NamedTuple):
    """One message as it reaches a decision engine."""

    message: Message
    t_in_ns: int
    """Time of arrival at the assistant."""
    t_ns: int
    """Time now: later than that if the worker was busy."""
    payload: bytes = b""
    """The raw bytes that the message is the header of; empty for other messages."""
    key: str = ""
    """Key below that of the run."""


class Decision(NamedTuple):
    """The alerts of an engine after all that it has received."""

    alerts: Sequence[Alert] = ()
    again_ns: int | None = None
    """Time to ask it again even if nothing more arrives; None: not before something does."""
    exchanges: Sequence[ModelExchange] = ()
    """Questions to a language model, with their answers, that the alerts rest on."""


@runtime_checkable
class DecisionEngine(Protocol):
    """Decides who is to be told what. The same messages at the same times give the same alerts."""

    @property
    def name(self) -> str:
        """Short name, such as ``reference``."""
        ...

    @property
    def reads(self) -> tuple[type[Message], ...]:
        """Classes of the messages that it wants."""
        ...

    def receive(self, received: ReceivedMessage) -> None:
        """Update what is known with one message."""
        ...

    def decide(self, t_ns: int) -> Decision:
        """Return what is new or has changed at simulation time ``t_ns``."""
        ...


@runtime_checkable
class HasConfiguration(Protocol):
    """Part that a decision engine may have besides: rules and thresholds that can be set."""

    @property
    def configuration(self) -> BaseModel:
        """The configuration that it decides by, whole; ``run.json`` has it."""
        ...


@runtime_checkable
class NamesInputs(Protocol):
    """Part that a decision engine may have besides: messages that it wants, by their keys."""

    @property
    def inputs(self) -> Mapping[str, object]:
        """Message, or union of messages, of each key, such as ``loop/*``."""
        ...


def inputs_of(engine: DecisionEngine) -> dict[str, Any]:
    """Return the message, or union of messages, of each key that an engine reads.

    Raises
    ------
    WorkerError
        The engine wants messages without saying on which key they are.
    """
    unknown = [model.__name__ for model in engine.reads if model not in KEYS]
    if unknown:
        raise WorkerError(
            f"assistant {engine.name!r} reads {', '.join(unknown)}; expected some of "
            f"{', '.join(model.__name__ for model in KEYS)}, and others in `inputs` by key"
        )
    read: dict[str, Any] = {key: model for model, key in KEYS.items() if model in engine.reads}
    return read | dict(engine.inputs) if isinstance(engine, NamesInputs) else read
