"""Inputs, outputs and call interface of a worker in the event loop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, Protocol, cast

from airhilt.sim.payload import DeferredBytes, Payload

Policy = Literal["fifo", "latest", "batch"]


class WorkerLost(Exception):
    """The worker died, hung or raised; the text says which and when.

    ``is_of_machine`` is true if the cause lies in the machine, not in the worker.
    """

    def __init__(self, text: str, is_of_machine: bool = False) -> None:
        super().__init__(text)
        self.is_of_machine = is_of_machine


@dataclass(frozen=True, slots=True)
class Input:
    """One message that reached a worker at ``t_in_ns``.

    ``begun_ns`` is when what it tells of began, such as a call that has ended; None if that was of
    one instant.
    """

    key: str
    t_in_ns: int
    payload: bytes
    attachment: Any = None
    begun_ns: int | None = None

    @property
    def size(self) -> int:
        """Number of bytes of the payload."""
        return len(self.payload)

    @classmethod
    def of(
        cls,
        key: str,
        t_in_ns: int,
        payload: Payload,
        attachment: Any = None,
        begun_ns: int | None = None,
    ) -> Input:
        """Return an input whose payload is made, if that is deferred, when somebody reads it."""
        if isinstance(payload, bytes):
            return cls(key, t_in_ns, payload, attachment, begun_ns)
        return DeferredInput(key, t_in_ns, payload, attachment, begun_ns)


class DeferredInput(Input):
    """An input whose payload is made when it is read: the field itself is never set."""

    __slots__ = ("_deferred",)

    def __init__(
        self, key: str, t_in_ns: int, payload: DeferredBytes, attachment: Any, begun_ns: int | None
    ) -> None:
        given = {"key": key, "t_in_ns": t_in_ns, "attachment": attachment, "begun_ns": begun_ns}
        for name, value in {**given, "_deferred": payload}.items():
            object.__setattr__(self, name, value)

    @property
    def size(self) -> int:
        """Number of bytes that the payload has, or will have."""
        return len(self._deferred)

    def __reduce__(self) -> tuple[type[Input], tuple[Any, ...]]:
        """Return what a copy in another process is made of: an input that has its payload."""
        return Input, (self.key, self.t_in_ns, self.payload, self.attachment, self.begun_ns)

    def __getattr__(self, name: str) -> bytes:
        if name != "payload":
            raise AttributeError(name)
        return bytes(self._deferred)


@dataclass(frozen=True, slots=True)
class Output:
    """One message that a worker wants published.

    ``t_out_ns`` of None means as soon as the latency has passed.
    """

    key: str
    payload: bytes
    t_out_ns: int | None = None
    attachment: Any = None


@dataclass(frozen=True, slots=True)
class Reply:
    """The outputs of a step, and the wall time that it took."""

    outputs: tuple[Output, ...]
    compute_s: float
    wake_ns: int | None = None
    missed: str = ""
    """Why an input has no result; empty if all have one."""


class Pending(Protocol):
    """A step under way."""

    def result(self) -> Reply:
        """Wait for the reply.

        WorkerLost says that none came, WorkerError that it broke the contract.
        """
        ...


@dataclass(frozen=True, slots=True)
class StepDone:
    """A step that has ended: its reply, or what it raises instead."""

    reply: Reply | None = None
    failure: Exception | None = None

    def result(self) -> Reply:
        """Return the reply, or raise the failure; see `Pending`."""
        if self.failure is not None:
            raise self.failure
        return cast("Reply", self.reply)


class Endpoint(Protocol):
    """A worker that can be called, in this process or another."""

    def dispatch(self, seq: int, t_ns: int, inputs: Sequence[Input]) -> Pending:
        """Start a step and return without waiting for it, where that is possible."""
        ...
