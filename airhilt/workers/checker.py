"""Checks a worker without a run, and says in words what is wrong with it."""

from __future__ import annotations

import re
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from difflib import get_close_matches
from typing import Any

from pydantic import ValidationError

from airhilt.engine_families import ASSISTANTS
from airhilt.errors import WorkerError
from airhilt.messages import (
    BUS_MESSAGES,
    CONTROLLER,
    SPEAK_MIN_LEVEL,
    Advisory,
    Modality,
    Recommendation,
    WorkerDescription,
    is_match,
)
from airhilt.sim.worker import Input, Output
from airhilt.units import SECOND_NS
from airhilt.workers.pool import parse_output, require_open_key
from airhilt.workers.protocol import Step, Worker, checked, described
from airhilt.workers.samples import NAMES, sample_inputs

PUBLISHED = sorted(
    {
        re.sub(r"{\w+}", "*", key.split(" ")[0])
        for key in BUS_MESSAGES
        if not key.startswith("truth/")
    }
)
"""Keys on which AIRHILT publishes something that a worker may want."""
OUTPUTS: dict[Modality, tuple[str, ...]] = {
    "enhancement": ("enhanced",),
    "asr": ("asr",),
    "tts": ("tts",),
    "vision": ("vision",),
    "decision": ("advisory", "llm"),
    "equipment": ("equipment",),
}
"""First parts of the keys on which a worker of each modality publishes."""
PATIENCE_S = 5.0
"""Longest wall time of one step, in s: after it, a run gives an attached worker up."""
STEPS_AT_S = (1, 2, 30)
"""Simulation times of the steps that are tried."""
PAGE = "docs/workers.md#what-makes-somebody-act"


def check_worker(
    worker: Worker, inputs: Sequence[Input] | None = None, patience_s: float = PATIENCE_S
) -> None:
    """Try a worker on inputs and complain about all that a run would not take.

    A warning (`UserWarning`) names the first advisory on which nobody would act in a run.

    Parameters
    ----------
    inputs
        Inputs to try, such as those of an earlier run; None: samples of each key that it wants.
    patience_s
        Longest wall time of one step.

    Raises
    ------
    WorkerError
        Something is wrong; the message has a line for each problem.
    """
    description = described(worker)
    problems = [
        problem
        for wanted in description.inputs
        for problem in _wrong_input(description.name, wanted.key)
    ]
    hints: list[str] = []
    for t_ns, given in _steps(description, inputs):
        answer = _Answer(worker, t_ns, given)
        answer.start()
        answer.join(patience_s)
        if answer.is_alive():
            problems.append(
                f"worker {description.name!r} has not answered for {patience_s:g} s to "
                f"{_named(given)}; an attached worker that takes longer is lost"
            )
            break
        try:
            step = answer.result(description.name)
        except WorkerError as error:
            problems.append(str(error))
            continue
        problems += _wrong_step(description, t_ns, step)
        if description.engine != ASSISTANTS.default:  # Its advisories need no hint.
            hints += _hints(description.name, step, None if inputs is not None else NAMES)
    else:
        problems += _changed_description(worker, description)
    for hint in hints[:1]:
        warnings.warn(hint, stacklevel=2)
    if problems:
        raise WorkerError("\n".join(dict.fromkeys(problems)))


def _changed_description(worker: Worker, description: WorkerDescription) -> Iterator[str]:
    try:
        is_same = described(worker) == description
    except WorkerError:
        is_same = False
    if not is_same:
        yield f"worker {description.name!r} has another description after its steps; expected one"


def _wrong_input(name: str, key: str) -> Iterator[str]:
    try:
        require_open_key(name, key)
    except WorkerError as error:
        yield str(error)
        return
    first = key.split("/")[0]
    if any(is_match(key, known) or is_match(known, key) for known in PUBLISHED):
        return
    # A sensor of another package may publish on any other key.
    alike = get_close_matches(first, {known.split("/")[0] for known in PUBLISHED}, cutoff=0.7)
    meant = [known for known in PUBLISHED if known.split("/")[0] in alike]
    if meant:
        yield (
            f"worker {name!r} asks for {key!r}, where nothing is published; expected "
            f"{' or '.join(meant)}"
        )


def _steps(
    description: WorkerDescription, inputs: Sequence[Input] | None
) -> Iterator[tuple[int, list[Input]]]:
    """Yield what each step gets: alone what comes alone, together what comes in a batch."""
    if inputs is not None:
        for item in inputs:
            yield item.t_in_ns, [item]
        return
    for t_s in STEPS_AT_S:
        batch = []
        for item in sample_inputs(t_s * SECOND_NS):
            policies = [each.policy for each in description.inputs if is_match(item.key, each.key)]
            if policies[:1] == ["batch"]:
                batch.append(item)
            elif policies:
                yield item.t_in_ns, [item]
        if batch:
            yield t_s * SECOND_NS, batch


class _Answer(threading.Thread):
    """One step, in a thread that can be left alone if it does not end."""

    def __init__(self, worker: Worker, t_ns: int, inputs: Sequence[Input]) -> None:
        super().__init__(daemon=True)
        self._call = (worker, t_ns, inputs)
        self.step: Any = None
        self.failure: BaseException | None = None

    def run(self) -> None:
        """Compute the step."""
        worker, t_ns, inputs = self._call
        try:
            self.step = worker.step(t_ns, inputs)
        except (Exception, SystemExit) as error:
            self.failure = error

    def result(self, name: str) -> Step:
        """Return the step, checked; see `checked` for its error."""
        if self.failure is not None:
            raise WorkerError(
                f"worker {name!r} raised {type(self.failure).__name__} on {_named(self._call[2])}: "
                f"{self.failure}"
            )
        return checked(name, self.step)


def _wrong_step(description: WorkerDescription, t_ns: int, step: Step) -> Iterator[str]:
    if step.wake_ns is not None and step.wake_ns <= t_ns:
        yield (
            f"worker {description.name!r} asks at {t_ns} ns to be called again at {step.wake_ns} "
            "ns; expected a later time"
        )
    if step.missed:
        yield f"worker {description.name!r} has no result of an input: {step.missed}"
    for output in step.outputs:
        yield from _wrong_output(description, t_ns, output)


def _wrong_output(description: WorkerDescription, t_ns: int, output: Output) -> Iterator[str]:
    name = description.name
    try:
        message = parse_output(name, output.key, output.payload, t_ns, output.attachment)
    except WorkerError as error:
        yield str(error)
        return
    limit = message.limit
    if limit is not None and len(output.payload) > limit.size_bytes:
        yield (
            f"worker {name!r} published on {output.key!r} {len(output.payload):,} bytes; expected "
            f"at most {limit.size_bytes:,}"
        )
    expected = OUTPUTS.get(description.modality)
    if expected is not None and output.key.split("/")[0] not in expected:
        yield (
            f"worker {name!r} of modality {description.modality} published on {output.key!r}; "
            f"expected {expected[0]}/..., or another modality in its description"
        )
    if message.t_ns:
        yield (
            f"worker {name!r} set t_ns of what it published on {output.key!r}; leave it out: the "
            "run stamps a message when the worker's latency has passed"
        )
    if output.t_out_ns is not None and output.t_out_ns < t_ns:
        yield (
            f"worker {name!r} wants {output.key!r} published at {output.t_out_ns} ns, before its "
            f"step at {t_ns} ns; expected a later time, or None"
        )


def _hints(name: str, step: Step, names: Sequence[str] | None) -> Iterator[str]:
    """Yield a hint for each advisory on which nobody acts.

    Parameters
    ----------
    names
        Names of all who may be told; None if anybody may be.
    """
    for output in step.outputs:
        try:
            advisory = Advisory.model_validate_json(output.payload)
        except ValidationError:
            continue  # It is no advisory; `_wrong_output` tells if it had to be one.
        is_known = names is None or advisory.recipient in names
        # Everybody in the samples is an aircraft, and its crew follows every recommendation.
        text = no_action(advisory, (lambda _: True) if is_known else None)
        if text is not None:
            yield f"worker {name!r}: {text}"


def no_action(advisory: Advisory, follows: Callable[[Recommendation], bool] | None) -> str | None:
    """Return why nobody acts on a warning; None if somebody may act, or if it is for ATC.

    Parameters
    ----------
    follows
        Tells whether the recipient follows recommendations of a kind; None if there is no such
        recipient.
    """
    if (
        not advisory.active
        or advisory.severity.rank < SPEAK_MIN_LEVEL.rank
        or advisory.recipient == CONTROLLER
    ):
        return None
    recipient, recommendation = advisory.recipient, advisory.recommendation
    told = f"its {advisory.severity.value} to {recipient}"
    if follows is None:
        return (
            f"{told}: nobody has that name, so nobody acts on it; expected a callsign or "
            f"{CONTROLLER}; see {PAGE}"
        )
    if recommendation is None:
        return f"{told} has no recommendation: nobody acts on it; see {PAGE}"
    if not follows(recommendation):
        return (
            f"{told} recommends {recommendation.action}, which {recipient} does not follow: "
            f"nobody acts on it; see {PAGE}"
        )
    return None


def _named(given: Sequence[Input]) -> str:
    return ", ".join(item.key for item in given)
