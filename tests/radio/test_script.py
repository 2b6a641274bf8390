"""Scripted calls: one at a time on each frequency."""

import itertools

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.radio.script import GAP_S, RadioScript
from airhilt.scenario.failures import HappeningLine
from airhilt.scenario.models import RadioLine, TimeReached
from airhilt.sim import Director, Priority, Virtual
from airhilt.units import SECOND_NS, seconds_to_ns


def line(name, at_s, words=8, frequency_khz=134325, late_s=0.0, dropped=False, when=None):
    text = " ".join(["word"] * words)
    declared = RadioLine(
        id=name, at_s=at_s, speaker="Centre", frequency_khz=frequency_khz, text=text, when=when
    )
    failures = ("it fails",) if late_s or dropped else ()
    return HappeningLine(declared, None if dropped else declared, late_s, failures, frozenset())


def played(*lines, words_per_minute=160.0, failed=None):
    """Return the calls that were made, in the order in which they ended.

    What waits for a condition waits for a time.
    """
    director, spoken = Director(Virtual()), []

    def once(condition, action):
        due_ns = max(seconds_to_ns(condition.at_s), director.now_ns)
        director.at(due_ns, action, Priority.SCRIPT)

    def fail(happening):
        if failed is not None:
            failed.append((happening.declared.id, director.now_ns / SECOND_NS))

    def ended(call):
        assert director.now_ns == call.t_end_ns
        spoken.append(call)

    RadioScript(director, lines, words_per_minute, once, fail, ended)
    director.run()
    return spoken


def test_a_call_takes_as_long_as_its_words():
    (call,) = played(line("a", 20.0, words=8))
    assert (call.t_tx_ns, call.t_end_ns) == (20 * SECOND_NS, 23 * SECOND_NS)


def test_a_call_waits_until_the_frequency_is_free_and_then_a_little():
    first, second = played(line("a", 20.0), line("b", 21.0))
    assert (first.line.id, second.line.id) == ("a", "b")
    assert second.t_tx_ns == first.t_end_ns + seconds_to_ns(GAP_S)
    assert second.t_end_ns - second.t_tx_ns == 3 * SECOND_NS


def test_another_frequency_does_not_wait():
    calls = played(line("a", 20.0), line("b", 21.0, frequency_khz=118_000))
    assert [call.t_tx_ns / SECOND_NS for call in calls] == [20.0, 21.0]


def test_those_who_wait_come_on_in_the_order_of_the_script():
    calls = played(line("a", 20.0), line("b", 21.0), line("c", 21.0), line("d", 22.0))
    assert [call.line.id for call in calls] == ["a", "b", "c", "d"]


@settings(deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(0.0, 60.0), st.integers(1, 30), st.sampled_from([118_000, 121_500])),
        max_size=12,
    )
)
def test_no_two_calls_overlap_on_a_frequency_and_none_comes_early_or_is_lost(plan):
    lines = [line(f"line{n}", at_s, words, khz) for n, (at_s, words, khz) in enumerate(plan)]
    calls = played(*lines)
    assert sorted(call.line.id for call in calls) == sorted(one.declared.id for one in lines)
    for call in calls:
        assert call.t_tx_ns >= seconds_to_ns(call.line.at_s)
    for khz in (118_000, 121_500):
        on_air = sorted((c.t_tx_ns, c.t_end_ns) for c in calls if c.line.frequency_khz == khz)
        assert all(a[1] <= b[0] for a, b in itertools.pairwise(on_air))


@pytest.mark.parametrize(("words_per_minute", "seconds"), [(160.0, 3.0), (80.0, 6.0)])
def test_the_planned_end_is_the_real_end_where_the_frequency_is_free(words_per_minute, seconds):
    nothing = lambda *_: None  # noqa: E731
    script = RadioScript(Director(Virtual()), [], words_per_minute, nothing, nothing, nothing)
    assert script.planned_end_ns(line("a", 20.0)) == seconds_to_ns(20.0 + seconds)


def test_a_line_waits_for_its_condition_too():
    waits = line("a", 5.0, when=TimeReached(type="time", at_s=12.0))
    late = line("b", 20.0, when=TimeReached(type="time", at_s=12.0))
    assert [call.t_tx_ns / SECOND_NS for call in played(waits, late)] == [12.0, 20.0]


def test_a_line_that_is_late_comes_late_and_one_that_is_dropped_never():
    failed = []
    calls = played(
        line("a", 5.0), line("b", 10.0, late_s=7.0), line("c", 11.0, dropped=True), failed=failed
    )
    assert [(call.line.id, call.t_tx_ns / SECOND_NS) for call in calls] == [("a", 5.0), ("b", 17.0)]
    assert failed == [("b", 10.0), ("c", 11.0)]
