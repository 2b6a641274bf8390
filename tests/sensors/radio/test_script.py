"""When a scripted call is due."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, cast

import pytest

from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import RadioLine, TimeReached
from airhilt.sensors.radio.backends import TextRadio
from airhilt.sensors.radio.frequency_arbiter import FrequencyArbiter
from airhilt.sensors.radio.script import RadioScript, planned_ends_ns
from airhilt.sim import Director, Priority, Virtual
from airhilt.units import SECOND_NS, seconds_to_ns
from conversations import radio_context


def line(
    name: str,
    at_s: float,
    words: int = 8,
    frequency_khz: int = 134325,
    late_s: float = 0.0,
    dropped: bool = False,
    when: TimeReached | None = None,
) -> EffectiveLine:
    text = " ".join(["word"] * words)
    declared = RadioLine(
        id=name, at_s=at_s, speaker="Center", frequency_khz=frequency_khz, text=text, when=when
    )
    failures = ("it fails",) if late_s or dropped else ()
    return EffectiveLine(declared, None if dropped else declared, late_s, failures, frozenset())


def played(*lines: EffectiveLine, failed: list[Any] | None = None) -> list[tuple[str, float]]:
    """Return which calls were due, and when.

    What waits for a condition waits for a time.
    """
    director = Director(Virtual())
    due: list[tuple[str, float]] = []

    def once(condition: Any, action: Callable[..., Any]) -> None:
        due_ns = max(seconds_to_ns(condition.at_s), director.now_ns)
        director.at(due_ns, action, Priority.SCRIPT)

    def fail(effective: Any) -> None:
        if failed is not None:
            failed.append((effective.declared.id, director.now_ns / SECOND_NS))

    def say(said: RadioLine) -> None:
        due.append((said.id, director.now_ns / SECOND_NS))

    context = radio_context(
        director=director,
        scenario=SimpleNamespace(failures=()),
        lines=lines,
        world=SimpleNamespace(once=once),
        failures=SimpleNamespace(line_failed=fail),
    )
    RadioScript(context, cast(FrequencyArbiter, None), say).start()
    director.run()
    return due


@pytest.mark.parametrize(("words_per_minute", "seconds"), [(160.0, 3.0), (80.0, 6.0)])
def test_a_call_is_planned_to_take_as_long_as_its_words(
    words_per_minute: float, seconds: float
) -> None:
    planned = planned_ends_ns([line("a", 20.0, late_s=5.0)], TextRadio(words_per_minute))
    assert planned == {"a": seconds_to_ns(25.0 + seconds)}


def test_a_line_waits_for_its_condition_too() -> None:
    waits = line("a", 5.0, when=TimeReached(type="time", at_s=12.0))
    late = line("b", 20.0, when=TimeReached(type="time", at_s=12.0))
    assert played(waits, late) == [("a", 12.0), ("b", 20.0)]


def test_a_line_that_is_late_comes_late_and_one_that_is_dropped_never() -> None:
    failed: list[Any] = []
    due = played(
        line("a", 5.0), line("b", 10.0, late_s=7.0), line("c", 11.0, dropped=True), failed=failed
    )
    assert due == [("a", 5.0), ("b", 17.0)]
    assert failed == [("b", 10.0), ("c", 11.0)]
