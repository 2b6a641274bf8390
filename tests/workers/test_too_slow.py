"""Measured times from a machine that was too slow are named, and no others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, cast

import pytest

from airhilt.messages import Clock, DeclaredLatency, InputSpec, WorkerDescription
from airhilt.sim import Director, Priority, Reply, Virtual, parse_latency
from airhilt.units import SECOND_NS
from airhilt.workers.pool import Participant, WorkerPool


@dataclass
class Takes:
    """A worker each step of which takes a time."""

    compute_s: float

    def dispatch(self, *_: Any) -> Any:
        return self

    def result(self) -> Reply:
        return Reply(outputs=(), compute_s=self.compute_s, wake_ns=None)


@pytest.mark.parametrize(
    ("latency", "compute_s", "declared_s", "is_named"),
    [
        (None, 2.5, 0.1, True),
        (None, 2.5, 1.0, False),
        (None, 0.9, 0.1, False),
        ("fixed", 2.5, 0.1, False),
    ],
)
def test_a_measured_worker_is_named_that_drops_inputs_and_takes_longer_than_it_declares(
    latency: str | None, compute_s: float, declared_s: float, is_named: bool
) -> None:
    description = WorkerDescription(
        name="seer",
        modality="vision",
        inputs=(InputSpec(key="clock", policy="latest"),),
        latency=DeclaredLatency(median_s=declared_s),
    )
    director = Director(Virtual())
    worker = Participant(description, cast(Any, Takes(compute_s)), "attached", is_of_user=True)
    pool = WorkerPool(
        director, [worker], parse_latency(latency), 0,
        publish=lambda *_: None, done=lambda _: None, lost=lambda *_: None,
    )  # fmt: skip
    clock = Clock(t_ns=0, run="r", phase="running", pace="virtual", behind_s=0.0)
    director.every(SECOND_NS, lambda: pool.offer("clock", clock, b"{}"), Priority.SENSOR)
    director.at(20 * SECOND_NS, director.stop, Priority.OBSERVE)
    director.run()
    assert [sentence.split(":")[0] for sentence in pool.too_slow()] == (
        ["The machine was too slow for the times of 'seer'"] if is_named else []
    )
