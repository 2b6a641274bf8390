"""A worker that has no result of one input goes on, and says why."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

from airhilt.errors import SpeechError
from airhilt.messages import InputSpec, WorkerDescription
from airhilt.sim import WorkerLost
from airhilt.workers import Input, LocalWorker, Step
from airhilt.workers.protocol import checked


class Failing:
    """Raises an error in each step."""

    description = WorkerDescription(name="ears", modality="asr", inputs=(InputSpec(key="clock"),))

    def __init__(self, *, is_passing: bool) -> None:
        self._is_passing = is_passing

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        error = SpeechError("the service is busy")
        error.is_passing = self._is_passing
        raise error


def test_an_error_that_is_passing_costs_the_result_of_the_step() -> None:
    reply = LocalWorker(Failing(is_passing=True)).dispatch(0, 0, []).result()
    assert (reply.outputs, reply.missed) == ((), "the service is busy")


def test_another_error_costs_the_worker() -> None:
    with pytest.raises(WorkerLost, match="'ears' failed: SpeechError: the service is busy"):
        LocalWorker(Failing(is_passing=False)).dispatch(0, 0, []).result()


def test_why_it_has_none_is_a_text() -> None:
    step: Any = Step(missed=None)  # type: ignore[arg-type]
    with pytest.raises(Exception, match="missed None; expected a str"):
        checked("ears", step)
