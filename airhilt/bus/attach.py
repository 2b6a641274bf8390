"""Waits for workers of other processes to attach."""

from __future__ import annotations

import queue
import re
import time
from collections.abc import Callable, Sequence
from typing import Literal, get_args

from airhilt.bus.remote_workers import RemoteWorker
from airhilt.bus.session import Bus
from airhilt.errors import BusError, WorkerError
from airhilt.messages import RUN, UNREGISTERED, WORKER_NAME, WorkerDescription

ReferenceKind = Literal["enhancement", "asr", "tts", "vision", "decision"]
"""Kinds of worker that ``airhilt worker`` serves; each has its kind for a name."""


def attach(
    bus: Bus,
    names: Sequence[str],
    timeout_s: float,
    step_timeout_s: float,
    waiting: Callable[[str], None],
) -> list[tuple[RemoteWorker, WorkerDescription | None]]:
    """Return the named workers once all are there, with what they say of themselves.

    One that describes itself as nothing takes no grants: it only publishes and subscribes.

    Parameters
    ----------
    waiting
        Called with a line for the user while there is something to wait for.

    Raises
    ------
    BusError
        A name cannot be that of a worker, or a worker did not come in time.
    WorkerError
        The names do not tell the workers apart.
    """
    for name in names:
        if not re.fullmatch(WORKER_NAME, name):
            raise BusError(
                f"worker name {name!r}: expected lower-case letters, digits, - and _, such as "
                "'decision'"
            )
    require_different_names(names)
    arrived: queue.SimpleQueue[str] = queue.SimpleQueue()
    bus.watch_workers(lambda name, alive: arrived.put(name) if alive else None)
    missing = set(names)
    deadline = time.monotonic() + timeout_s
    if missing:
        waiting(f"waiting at {bus.endpoint} for {', '.join(sorted(missing))}")
    while missing:
        try:
            missing.discard(arrived.get(timeout=max(deadline - time.monotonic(), 0.0)))
        except queue.Empty:
            raise BusError(
                f"{', '.join(sorted(missing))} did not attach at {bus.endpoint} within "
                f"{timeout_s:g} s; {_how_to_start(sorted(missing)[0], bus)}, or wait "
                "longer with --attach-timeout"
            ) from None
    workers = [RemoteWorker(bus, name, step_timeout_s) for name in names]
    return [(worker, worker.describe()) for worker in workers]


def require_different_names(names: Sequence[str]) -> None:
    """Check that the names of the workers and programs of a run tell them apart.

    Raises
    ------
    WorkerError
        One is reserved, is given twice, or begins another.
    """
    for name in names:
        if name in (RUN, UNREGISTERED):
            raise WorkerError(
                f"a worker is named {name!r}, as the log calls others; expected another name"
            )
        if names.count(name) > 1:
            raise WorkerError(f"two workers are named {name!r}; expected a name for each")
        for other in names:
            if other.startswith(f"{name}-"):
                raise WorkerError(
                    f"two workers are named {name!r} and {other!r}: an id that begins with "
                    f"'{other}-' would be of both; expected a name that does not begin the other"
                )


def _how_to_start(name: str, bus: Bus) -> str:
    """Return how a worker of that name is started: one of AIRHILT's, or a program of the user."""
    keys = "" if bus.tls is None else f" --tls {bus.tls}"
    if name in get_args(ReferenceKind):
        return f"start it with: airhilt worker {name} --connect {bus.endpoint}{keys}"
    return (
        f"start your program so that it connects to {bus.endpoint}{' with keys' if keys else ''} "
        f"and declares the liveliness token worker/{name} (docs/workers.md)"
    )
