"""A frequency: one at a time, unless two begin together or somebody does not listen."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from functools import partial
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.sensors.radio.frequency_arbiter import GAP_S, REACTION_S, FrequencyArbiter
from airhilt.sensors.radio.on_air import OnAir, Utterance
from airhilt.sim import Director, Priority, Virtual
from airhilt.units import SECOND_NS, seconds_to_ns


def call(
    name: str,
    at_s: float,
    speaker: str = "Center",
    frequency_khz: int = 134_325,
    listens_first: bool = True,
    words: int = 8,
) -> tuple[float, Utterance]:
    text = " ".join(["word"] * words)
    return at_s, Utterance(name, frequency_khz, speaker, None, text, listens_first=listens_first)


def everybody(speaker: str, listener: str) -> bool:
    return True


def played(
    *calls: tuple[float, Utterance],
    stuck: list[tuple[float, str, float]] | tuple[Any, ...] = (),
    audible: Callable[..., Any] = everybody,
    until_s: float | None = None,
) -> dict[Any, Any]:
    """Return the transmissions by their ids, in the order in which they ended or were cut off."""
    director, ended = Director(Virtual()), {}

    def speak(speaker: str, text: str) -> tuple[None, float]:
        return None, len(text.split()) * 0.375

    def end(on_air: OnAir) -> None:
        assert director.now_ns == on_air.t_end_ns
        ended[on_air.utterance.id] = on_air

    arbiter = FrequencyArbiter(director, speak, audible, began=lambda on_air: None, ended=end)
    for at_s, said in calls:
        director.at(seconds_to_ns(at_s), partial(arbiter.say, said), Priority.SCRIPT)
    for at_s, speaker, for_s in stuck:
        carrier = Utterance(f"stuck-{speaker}", 134_325, speaker, None, "")
        director.at(
            seconds_to_ns(at_s), partial(arbiter.transmit_carrier, carrier, for_s), Priority.SCRIPT
        )
    if until_s is not None:
        director.at(seconds_to_ns(until_s), director.stop, Priority.OBSERVE)
    director.run()
    return ended | {on_air.utterance.id: on_air for on_air in arbiter.close()}


def begins_s(on_air: OnAir) -> float:
    return on_air.t_tx_ns / SECOND_NS


def blockers(on_air: OnAir) -> list[str]:
    return sorted(other.utterance.id for other in on_air.overlapping)


def test_a_call_takes_as_long_as_it_is_spoken() -> None:
    (only,) = played(call("a", 20.0)).values()
    assert (only.t_tx_ns, only.t_end_ns) == (20 * SECOND_NS, 23 * SECOND_NS)
    assert not only.overlapping


def test_a_call_waits_until_the_frequency_is_free_and_then_a_little() -> None:
    calls = played(call("a", 20.0), call("b", 21.0, "AAL1"))
    assert list(calls) == ["a", "b"]
    assert calls["b"].t_tx_ns == calls["a"].t_end_ns + seconds_to_ns(GAP_S)
    assert not calls["b"].overlapping


def test_another_frequency_does_not_wait() -> None:
    calls = played(call("a", 20.0), call("b", 21.0, frequency_khz=118_000))
    assert [begins_s(one) for one in calls.values()] == [20.0, 21.0]


def test_those_who_wait_come_on_in_the_order_in_which_they_began_to() -> None:
    calls = played(call("a", 20.0), call("b", 21.0, "B"), call("c", 21.0, "C"), call("d", 22.0))
    assert list(calls) == ["a", "b", "c", "d"]
    assert not any(one.overlapping for one in calls.values())


@pytest.mark.parametrize("later_s", [0.0, REACTION_S - 0.01])
def test_two_that_begin_before_they_can_hear_each_other_block_each_other(later_s: float) -> None:
    calls = played(call("a", 20.0, "A"), call("b", 20.0 + later_s, "B"))
    assert (blockers(calls["a"]), blockers(calls["b"])) == (["b"], ["a"])


def test_nobody_talks_over_himself_even_if_he_does_not_listen_first() -> None:
    calls = played(
        call("a", 20.0, "A"),
        call("b", 21.0, "A", listens_first=False),
        call("c", 25.0, "B", listens_first=False),
    )
    assert begins_s(calls["b"]) == 23.4
    assert blockers(calls["b"]) == ["c"]


def test_one_that_does_not_listen_first_blocks_what_is_on_the_air() -> None:
    calls = played(call("a", 20.0, "A"), call("b", 21.5, "B", listens_first=False))
    assert (blockers(calls["a"]), blockers(calls["b"])) == (["b"], ["a"])
    assert begins_s(calls["b"]) == 21.5


def test_who_does_not_hear_a_call_does_not_wait_for_it() -> None:
    calls = played(
        call("a", 20.0, "A"), call("b", 21.0, "B"), audible=lambda one, other: one == other
    )
    assert blockers(calls["a"]) == ["b"]


def test_a_stuck_microphone_blocks_all_that_is_said_for_ten_minutes() -> None:
    calls = played(
        *(call(f"c{n}", 30.0 + 20.0 * n, "A") for n in range(28)),
        call("after", 640.0, "A"),
        stuck=[(10.0, "B", 600.0)],
    )
    carrier = calls["stuck-B"]
    assert carrier.is_carrier
    assert (carrier.t_end_ns - carrier.t_tx_ns) / SECOND_NS == 600.0
    assert blockers(carrier) == sorted(f"c{n}" for n in range(28))
    assert all(blockers(calls[f"c{n}"]) == ["stuck-B"] for n in range(28))
    assert not calls["after"].overlapping


def test_a_stuck_microphone_does_not_block_its_own_actor() -> None:
    calls = played(call("own", 20.0, "B"), call("other", 30.0, "A"), stuck=[(10.0, "B", 60.0)])
    assert not calls["own"].overlapping
    assert blockers(calls["stuck-B"]) == ["other"]


def test_what_is_on_the_air_at_the_end_is_cut_off() -> None:
    calls = played(
        call("a", 20.0, "A"), call("b", 22.0, frequency_khz=118_000), stuck=[(10.0, "B", 600.0)],
        until_s=22.0,
    )  # fmt: skip
    assert set(calls) == {"stuck-B", "a"}
    assert {one.t_end_ns for one in calls.values()} == {22 * SECOND_NS}
    assert blockers(calls["a"]) == ["stuck-B"]


@settings(deadline=None)
@given(
    st.lists(
        st.tuples(
            st.floats(0.0, 60.0),
            st.integers(1, 30),
            st.sampled_from([118_000, 121_500]),
            st.sampled_from(["A", "B"]),
        ),
        max_size=12,
    )
)
def test_no_call_is_lost_none_comes_early_and_what_overlaps_began_together(plan: list[Any]) -> None:
    planned = [
        call(f"call{n}", at_s, who, khz, words=words)
        for n, (at_s, words, khz, who) in enumerate(plan)
    ]
    calls = played(*planned)
    assert set(calls) == {said.id for _, said in planned}
    for at_s, said in planned:
        assert calls[said.id].t_tx_ns >= seconds_to_ns(at_s)
    for one, other in itertools.combinations(calls.values(), 2):
        same = one.utterance.frequency_khz == other.utterance.frequency_khz
        apart = one.t_end_ns <= other.t_tx_ns or other.t_end_ns <= one.t_tx_ns
        assert (other in one.overlapping) == (same and not apart)
        if other in one.overlapping:
            assert one.utterance.speaker != other.utterance.speaker
            assert abs(one.t_tx_ns - other.t_tx_ns) < seconds_to_ns(REACTION_S)
