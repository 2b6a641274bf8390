"""The protocol of workers, in this process or another."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from airhilt.messages import WorkerDescription
from airhilt.sim.worker import Input, Output, Reply, WorkerLost


@dataclass(frozen=True, slots=True)
class Step:
    """The result of a step: messages to publish, and when to call again without inputs.

    Leave ``t_ns`` out of the messages: the run stamps it when the worker's latency has passed.
    """

    outputs: tuple[Output, ...] = ()
    wake_ns: int | None = None


class Worker(Protocol):
    """A part of the assistant, which sees what arrives on its keys and nothing else."""

    @property
    def description(self) -> WorkerDescription:
        """Name, modality, inputs and declared latency."""
        ...

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        """Return what follows from the inputs that have arrived at simulation time ``t_ns``."""
        ...


def timed_step(worker: Worker, t_ns: int, inputs: Sequence[Input]) -> Reply:
    """Run one step and measure the wall time that it takes."""
    begun = time.perf_counter()
    step = worker.step(t_ns, inputs)
    return Reply(step.outputs, time.perf_counter() - begun, step.wake_ns)


class LocalWorker:
    """Calls a worker in this process."""

    def __init__(self, worker: Worker) -> None:
        self._worker = worker

    def dispatch(self, seq: int, t_ns: int, inputs: Sequence[Input]) -> LocalStep:  # noqa: ARG002
        """Compute the step at once.

        An exception of the worker counts as its loss, so that it cannot end the run.
        """
        try:
            return LocalStep(timed_step(self._worker, t_ns, inputs), None)
        except Exception as error:
            name = self._worker.description.name
            return LocalStep(None, f"worker {name!r} failed: {type(error).__name__}: {error}")


@dataclass(frozen=True, slots=True)
class LocalStep:
    """A step that has been computed, or has failed."""

    reply: Reply | None
    failure: str | None

    def result(self) -> Reply:
        """Return the reply.

        Raises
        ------
        WorkerLost
            The worker raised.
        """
        if self.reply is None:
            raise WorkerLost(self.failure or "worker failed")
        return self.reply
