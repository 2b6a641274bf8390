"""Simulation time passes as fast as it is told to."""

from __future__ import annotations

from threading import Event

import pytest

from airhilt.errors import AirhiltError
from airhilt.sim import Paused, RealTime, Virtual, parse_pace

HOUR_NS = 3_600_000_000_000


def test_in_virtual_time_everything_is_due_at_once_and_time_stands_still_between_events() -> None:
    pace = Virtual()
    pace.start(0)
    assert pace.wait_until(HOUR_NS, Event())
    assert pace.elapsed_ns(7) == 7


def test_real_time_waits_until_the_clock_has_come_so_far() -> None:
    pace, due_ns = RealTime(), 20_000_000
    pace.start(0)
    assert pace.wait_until(due_ns, Event())
    assert pace.elapsed_ns(0) >= 0.9 * due_ns


def test_real_time_says_that_nothing_is_due_when_it_is_woken() -> None:
    pace, wake = RealTime(), Event()
    pace.start(0)
    wake.set()
    assert not pace.wait_until(HOUR_NS, wake)


def test_in_a_pause_nothing_is_due_and_time_stands_still() -> None:
    pace, wake = Paused(), Event()
    pace.start(0)
    wake.set()
    assert not pace.wait_until(1, wake)
    assert pace.elapsed_ns(7) == 7


def test_what_is_already_due_needs_no_waking() -> None:
    pace = RealTime()
    pace.start(HOUR_NS)
    assert pace.wait_until(HOUR_NS - 1, Event())


def test_a_faster_pace_brings_simulation_time_on_faster() -> None:
    pace, due_ns = RealTime(1e5), HOUR_NS // 1000
    pace.start(0)
    assert pace.wait_until(due_ns, Event())
    assert pace.elapsed_ns(0) >= 0.9 * due_ns


def test_time_never_lies_before_the_last_event() -> None:
    pace = RealTime()
    pace.start(0)
    assert pace.elapsed_ns(HOUR_NS) == HOUR_NS


def test_a_pace_is_known_by_its_name(subtests: pytest.Subtests) -> None:
    table = [("virtual", "virtual"), ("realtime", "realtime"), ("1x", "realtime"), ("4x", "4x"),
     ("0.5x", "0.5x"), ("1e3x", "1000x")]  # fmt: skip
    for text, name in table:
        with subtests.test(text):
            assert parse_pace(text).name == name


def test_any_other_pace_is_refused_and_the_message_says_what_is_expected(
    subtests: pytest.Subtests,
) -> None:
    for text in ["", "fast", "4", "x", "0x", "-1x", "nanx", "infx", "1e7x", "four x", "realtime "]:
        with subtests.test(text):
            with pytest.raises(AirhiltError) as caught:
                parse_pace(text)
            message = str(caught.value)
            assert repr(text) in message
            assert all(word in message for word in ("virtual", "realtime", "4x"))
