"""Evidence that comes late, or has to wait for a busy engine, is judged by its own times."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from airfield import NORTH, Airfield, Mover, drives, lands
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.sim import Input
from airhilt.units import SECOND_NS
from airhilt.workers.protocol import Step
from decisions import reference
from encounters import Encounter, Flight


@dataclass
class Busy:
    """A worker that takes what has come every ten seconds only."""

    worker: DecisionWorker = field(default_factory=reference)
    waiting: list[Input] = field(default_factory=list)

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        self.waiting += inputs
        if t_ns % (10 * SECOND_NS):
            return Step(())
        waiting, self.waiting = self.waiting, []
        return self.worker.step(t_ns, waiting)


@dataclass
class Late:
    """A worker whose inputs take five seconds to reach it."""

    worker: DecisionWorker = field(default_factory=reference)
    coming: list[Input] = field(default_factory=list)

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        before_ns = t_ns - 5 * SECOND_NS
        self.coming += inputs
        here = [replace(item, t_in_ns=t_ns) for item in self.coming if item.t_in_ns <= before_ns]
        self.coming = [item for item in self.coming if item.t_in_ns > before_ns]
        return self.worker.step(t_ns, here)


def entry(worker: Any = None, starts_at_s: float = 50.0) -> Airfield:
    """A vehicle drives on to the runway of an arrival."""
    movers = [
        Mover("AAL123", NORTH, lands(110)),
        Mover("OPS1", NORTH, drives(starts_at_s, to_m=0.0), category="C2"),
    ]
    airfield = Airfield(movers) if worker is None else Airfield(movers, worker=worker)
    return airfield.run(110)


def test_a_busy_engine_tells_at_its_next_step_what_has_lasted() -> None:
    at_once = entry().first("CAUTION")[0]
    busy = entry(Busy())
    assert busy.told[0][0] == 10.0 * math.ceil(at_once / 10.0)


def test_a_busy_engine_tells_of_a_loss_of_separation_at_its_next_step() -> None:
    def told_s(worker: Any) -> float:
        flights = [
            Flight("AAL123", "a1b2c3", 90.0, 23.0, 33_000),
            Flight("DAL456", "a4d5e6", 270.0, 23.0, 33_000),
        ]
        encounter = Encounter(flights, 130.0)
        encounter.worker = worker
        return next(t_s for t_s, each in encounter.fly().told if each.severity == "CAUTION")

    at_once_s = told_s(reference())
    assert told_s(Busy()) == 10.0 * math.ceil(at_once_s / 10.0)


def test_who_drives_on_is_where_it_must_be_by_now() -> None:
    at_once = entry().first("CAUTION")[0]
    late = entry(Late()).first("CAUTION")[0]
    assert late - at_once <= 1.0


def test_who_brakes_is_not_taken_to_drive_on() -> None:
    movers = [
        Mover("AAL123", NORTH, lands(110)),
        Mover("OPS1", NORTH, drives(50.0, to_m=-100.0, braking=1.0), category="C2"),
    ]
    assert Airfield(movers).run(100).told == []
