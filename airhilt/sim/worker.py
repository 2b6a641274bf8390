"""A worker as the event loop knows it: inputs, outputs, and how it is called."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, Protocol

Policy = Literal["fifo", "latest", "batch"]


class WorkerLost(Exception):
    """The worker died, hung or raised; the text says which and when."""


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


class Pending(Protocol):
    """A step under way."""

    def result(self) -> Reply:
        """Wait for the reply.

        Raises
        ------
        WorkerLost
            None came.
        airhilt.errors.WorkerError
            It broke the contract.
        """
        ...


class Endpoint(Protocol):
    """A worker that can be called, in this process or another."""

    def dispatch(self, seq: int, t_ns: int, inputs: Sequence[Input]) -> Pending:
        """Start a step and return without waiting for it, where that is possible."""
        ...
