"""Scripted calls: one at a time on each frequency."""

import itertools

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.radio.script import GAP_S, RadioScript
from airhilt.scenario.models import RadioLine
from airhilt.sim import Director, Virtual
from airhilt.units import SECOND_NS, seconds_to_ns


def line(name, at_s, words=8, frequency_khz=134325):
    text = " ".join(["word"] * words)
    return RadioLine(id=name, at_s=at_s, speaker="Centre", frequency_khz=frequency_khz, text=text)


def played(*lines, words_per_minute=160.0):
    """Return the calls that were made, in the order in which they ended."""
    director, spoken = Director(Virtual()), []

    def ended(call):
        assert director.now_ns == call.t_end_ns
        spoken.append(call)

    RadioScript(director, lines, words_per_minute, ended)
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
    assert sorted(call.line.id for call in calls) == sorted(one.id for one in lines)
    for call in calls:
        assert call.t_tx_ns >= seconds_to_ns(call.line.at_s)
    for khz in (118_000, 121_500):
        on_air = sorted((c.t_tx_ns, c.t_end_ns) for c in calls if c.line.frequency_khz == khz)
        assert all(a[1] <= b[0] for a, b in itertools.pairwise(on_air))


@pytest.mark.parametrize(("words_per_minute", "seconds"), [(160.0, 3.0), (80.0, 6.0)])
def test_the_planned_end_is_the_real_end_where_the_frequency_is_free(words_per_minute, seconds):
    script = RadioScript(Director(Virtual()), [], words_per_minute, lambda _: None)
    assert script.planned_end_ns(line("a", 20.0)) == seconds_to_ns(20.0 + seconds)
