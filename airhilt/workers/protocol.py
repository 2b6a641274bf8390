"""The protocol of workers, in this process or another."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from airhilt.errors import WorkerError, first_line, is_of_machine, keeping_passing, shown
from airhilt.messages import WorkerDescription
from airhilt.sim.worker import Input, Output, Reply, StepDone, WorkerLost

OUTPUT = "airhilt.workers.Output"
TIME = "an int, in ns, or None"


@dataclass(frozen=True, slots=True)
class Step:
    """The result of a step: messages to publish, and when to call again without inputs.

    Leave ``t_ns`` out of the messages: the run stamps it when the worker's latency has passed.
    """

    outputs: tuple[Output, ...] = ()
    wake_ns: int | None = None
    missed: str = ""
    """Why an input has no result; empty if all have one. The run goes on, and tells it."""


class Worker(Protocol):
    """A part of the assistant, which sees what arrives on its keys and nothing else."""

    @property
    def description(self) -> WorkerDescription:
        """Name, modality, inputs and declared latency."""
        ...

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        """Return what follows from the inputs that have arrived at simulation time ``t_ns``."""
        ...


def described(worker: Worker) -> WorkerDescription:
    """Return what a worker says of itself.

    Raises
    ------
    WorkerError
        It has no description, or no method `step`.
    """
    kind = type(worker).__name__
    if isinstance(worker, type):
        raise WorkerError(
            f"{worker.__name__} is a class; expected a worker made of it: {worker.__name__}()"
        )
    try:
        description = worker.description
    except (Exception, SystemExit) as error:
        raise WorkerError(
            f"{kind}.description cannot be read: {first_line(error)}; expected an "
            "airhilt.messages.WorkerDescription"
        ) from None
    if not isinstance(description, WorkerDescription):
        raise WorkerError(
            f"{kind}.description is {shown(description)}; expected an "
            "airhilt.messages.WorkerDescription"
        )
    if not callable(getattr(worker, "step", None)):
        raise WorkerError(f"worker {description.name!r} has no method step(t_ns, inputs)")
    return description


def timed_step(worker: Worker, t_ns: int, inputs: Sequence[Input]) -> tuple[Step, float]:
    """Run one step; return its result, as yet unchecked, and the wall time in s.

    An error that is passing costs the result of the step, and not the worker.
    """
    begun = time.perf_counter()
    missed: list[str] = []
    with keeping_passing(missed):
        return worker.step(t_ns, inputs), time.perf_counter() - begun
    return Step(missed=missed[0]), time.perf_counter() - begun


def checked(name: str, step: Any) -> Step:
    """Return the result of a step if its parts have the right types.

    Parameters
    ----------
    name
        Name of the worker.

    Raises
    ------
    WorkerError
        A part has another type.
    """
    if problem := _problem_of(step):
        raise WorkerError(f"worker {name!r} {problem}")
    return Step(tuple(step.outputs), step.wake_ns, step.missed)


def _problem_of(step: Any) -> str:
    """Return what is wrong with the types of a step; empty if nothing is."""
    if not isinstance(step, Step):
        return f"returned {shown(step)} from step; expected an airhilt.workers.Step"
    if not isinstance(step.outputs, tuple | list):
        outputs = shown(step.outputs)
        return f"returned a Step whose outputs are {outputs}; expected a tuple of {OUTPUT}"
    if not _is_time(step.wake_ns):
        return f"returned a Step with wake_ns {shown(step.wake_ns)}; expected {TIME}"
    if not isinstance(step.missed, str):
        return f"returned a Step with missed {shown(step.missed)}; expected a str"
    for output in step.outputs:
        if not isinstance(output, Output):
            return f"returned {shown(output)} among its outputs; expected {OUTPUT}"
        if not isinstance(output.key, str):
            key = shown(output.key)
            return f"returned an Output with the key {key}; expected a str such as 'advisory/ATC'"
        where = f"published on {output.key!r}"
        if not isinstance(output.payload, bytes):
            return f"{where} the payload {shown(output.payload)}; expected bytes"
        if not _is_time(output.t_out_ns):
            return f"{where} with t_out_ns {shown(output.t_out_ns)}; expected {TIME}"
    return ""


def _is_time(value: object) -> bool:
    return value is None or (isinstance(value, int) and not isinstance(value, bool))


class LocalWorker:
    """Calls a worker in this process.

    Attributes
    ----------
    description
        Description of the worker, read once.

    Raises
    ------
    WorkerError
        The worker has no description, or no method `step`.
    """

    def __init__(self, worker: Worker) -> None:
        self.description = described(worker)
        self._worker = worker

    def dispatch(self, seq: int, t_ns: int, inputs: Sequence[Input]) -> StepDone:  # noqa: ARG002
        """Compute the step at once.

        An exception of the worker counts as its loss, so that it cannot end the run.
        """
        name = self.description.name
        try:
            result, compute_s = timed_step(self._worker, t_ns, inputs)
        except (Exception, SystemExit) as error:
            failure = f"worker {name!r} failed: {type(error).__name__}: {error}"
            return StepDone(failure=WorkerLost(failure, is_of_machine(error)))
        try:
            step = checked(name, result)
        except WorkerError as error:
            return StepDone(failure=error)
        return StepDone(Reply(step.outputs, compute_s, step.wake_ns, step.missed))
