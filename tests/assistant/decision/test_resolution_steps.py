"""Single steps of a coordinated recommendation: who goes where, and what is tried first."""

from __future__ import annotations

import math
from typing import Any

import pytest

from airhilt.assistant.decision.manoeuvres import NONE
from airhilt.assistant.decision.resolution import (
    Candidate,
    _candidates,
    _Pair,
    resolve,
)
from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.relative_motion import Minima
from airhilt.messages import Climb
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, NAUTICAL_MILE

STANDARD = Minima(5.0 * NAUTICAL_MILE, 1000.0 * FOOT)
INFRINGED = Minima(5.0 * NAUTICAL_MILE, 850.0 * FOOT)
NORMAL_M_S, STRONG_M_S = 1500.0 * FOOT_PER_MINUTE, 2500.0 * FOOT_PER_MINUTE


def track(
    icao24: str, north_m: float, altitude_ft: float, north_m_s: float = 0.0, *,
    rate_fpm: float = 0.0, cleared_ft: float | None = None, in_distress: bool = False,
) -> Track:  # fmt: skip
    return Track(
        icao24, icao24.upper(), 0, north_m / 6.37e6, 0.0, altitude_ft * FOOT, north_m_s, 0.0,
        rate_fpm * FOOT_PER_MINUTE, None if cleared_ft is None else cleared_ft * FOOT,
        in_distress=in_distress,
    )  # fmt: skip


def head_on(first_ft: float, second_ft: float, *, first: Any = (), second: Any = (),
            apart_m: float = 70_000.0) -> tuple[Track, Track]:  # fmt: skip
    """Return two that meet with 240 m/s each; the second one has the higher address."""
    return (
        track("a00001", 0.0, first_ft, 240.0, **dict(first)),
        track("a00002", apart_m, second_ft, -240.0, **dict(second)),
    )


def told(
    first: Track, second: Track, *, strong: bool = False, others: tuple[Track, ...] = ()
) -> tuple[Any, Any]:
    found = resolve(first, second, others, STANDARD, INFRINGED, strong)
    return found.first, found.second


def climb(altitude_ft: float, rate_fpm: float = 1500.0, turn_deg: float = 0.0) -> Climb:
    return Climb(
        sense="climb", altitude_ft=altitude_ft, vertical_rate_fpm=rate_fpm, turn_deg=turn_deg
    )


def descend(altitude_ft: float, rate_fpm: float = 1500.0) -> Climb:
    return Climb(sense="descend", altitude_ft=altitude_ft, vertical_rate_fpm=rate_fpm)


# --- who goes up, and how far -----------------------------------------------------------------


@pytest.mark.parametrize(
    ("first_ft", "second_ft", "first_goes", "second_goes"),
    [
        (35_000, 35_000, descend(34_400), climb(35_600)),  # The higher address goes up.
        (35_400, 35_000, descend(34_600), climb(35_800)),
        (35_600, 35_000, climb(35_900), descend(34_700)),  # From half of the minimum: the higher.
        (34_600, 35_000, descend(34_200), climb(35_400)),
        (34_400, 35_000, descend(34_100), climb(35_300)),
    ],
)
def test_two_share_what_is_missing_to_the_minimum_and_200_ft(
    first_ft: float, second_ft: float, first_goes: Climb, second_goes: Climb
) -> None:
    first, second = head_on(first_ft, second_ft)
    assert told(first, second) == (first_goes, second_goes)
    assert told(second, first) == (second_goes, first_goes)


def pair(upper: Track, lower: Track) -> _Pair:
    return _Pair(upper, lower, STANDARD)


def test_who_goes_alone_goes_clear_of_where_the_other_gets_to_while_the_two_are_near() -> None:
    """5 NM are 9,260 m: of 48 km at 480 m/s the two are near from 80.7 s to 119.3 s from now."""
    upper = track("a1", 0.0, 35_000, 240.0, rate_fpm=-600.0)
    lower = track("a2", 48_000.0, 34_000, -240.0, rate_fpm=1200.0)
    both = pair(upper, lower)
    last_s = (48_000.0 + 5.0 * NAUTICAL_MILE) / 480.0
    highest_ft, lowest_ft = 34_000.0 + 20.0 * last_s, 35_000.0 - 10.0 * last_s
    assert both.above_m / FOOT == pytest.approx(100.0 * math.ceil((highest_ft + 1200) / 100))
    assert both.below_m / FOOT == pytest.approx(100.0 * math.floor((lowest_ft - 1200) / 100))


# --- what is tried first ----------------------------------------------------------------------


def groups(upper: Track, lower: Track, *, strong: bool = False) -> list[list[Candidate]]:
    return list(_candidates(pair(upper, lower), strong))


def turns(group: list[Candidate]) -> list[tuple[float, float]]:
    return [(round(up.turn_rad / DEGREE), round(down.turn_rad / DEGREE)) for up, down in group]


def rates(group: list[Candidate]) -> set[float]:
    return {round(each.rate_m_s, 6) for both in group for each in both if each.target_m is not None}


def test_levels_come_before_a_turn_and_more_of_either_after_that() -> None:
    lower, upper = head_on(35_000, 35_000)
    levels, turned, stronger, wide, combined = groups(upper, lower)
    assert rates(levels) == rates([levels[0]]) == {round(NORMAL_M_S, 6)}
    assert [(up != NONE, down != NONE) for up, down in levels] == [
        (True, True), (True, False), (False, True), (True, True),
    ]  # fmt: skip
    assert turns(turned) == [(30, 30), (0, 30), (30, 0)]
    assert rates(turned) == rates(wide) == set()
    assert rates(stronger) == rates(combined) == {round(STRONG_M_S, 6)}
    assert turns(wide) == [
        (0, -30), (-30, 0), (0, 60), (60, 0), (0, -60), (-60, 0), (0, 90), (90, 0), (0, -90),
        (-90, 0),
    ]  # fmt: skip
    each_turn = (30, -30, 60, -60, 90, -90)
    assert turns(combined) == [
        both for turn in each_turn for both in ((turn, turn), (turn, 0), (0, turn), (turn, turn))
    ]


@pytest.mark.parametrize(
    ("upper_rate", "lower_rate", "stops_ft"),
    [
        (0.0, 0.0, []),
        (0.0, 1500.0, [(None, 36_000)]),
        (0.0, -1500.0, []),
        (-1500.0, 0.0, [(36_000, None)]),
        (1500.0, 0.0, []),
        (-1500.0, 1500.0, [(None, 36_000), (36_000, None)]),
        (-150.0, 150.0, []),  # That is level.
    ],
)
def test_whoever_moves_towards_the_other_may_stop_short(
    upper_rate: float, lower_rate: float, stops_ft: list[tuple[float | None, float | None]]
) -> None:
    upper = track("a1", 0.0, 37_000, 240.0, rate_fpm=upper_rate)
    lower = track("a2", 60_000.0, 35_000, -240.0, rate_fpm=lower_rate)
    first = groups(upper, lower)[0]
    stops = [
        tuple(None if each.target_m is None else round(each.target_m / FOOT) for each in both)
        for both in first
        if NONE in both
    ]
    assert stops[: len(stops_ft)] == stops_ft
    assert all(
        each.rate_m_s == pytest.approx(1500.0 * FOOT_PER_MINUTE)
        for both in first[: len(stops_ft)]
        for each in both
        if each != NONE
    )


@pytest.mark.parametrize(("lower_ft", "is_down"), [(3_220.0, True), (3_140.0, False)])
def test_nobody_goes_down_below_600_m(lower_ft: float, is_down: bool) -> None:
    """The lower one, by 200 ft, goes down by 500 ft, or by 1,000 ft alone; 600 m are 1,969 ft."""
    alone = groups(track("a1", 0.0, lower_ft, 240.0), track("a2", 60_000.0, lower_ft, -240.0))[0]
    assert any(up == NONE for up, _ in alone) is is_down
    both_ft = lower_ft - 600.0
    both = groups(track("a1", 0.0, both_ft, 240.0), track("a2", 60_000.0, both_ft, -240.0))[0]
    assert any(NONE not in each for each in both) is is_down
    assert not any(up == NONE for up, _ in both)


# --- what is chosen ---------------------------------------------------------------------------


def test_who_is_in_distress_is_told_nothing_and_the_other_gives_way() -> None:
    for first, second in ((True, False), (False, True)):
        pair = head_on(35_000, 35_000, first={"in_distress": first}, second={"in_distress": second})
        one, other = told(*pair)
        assert (one is None) is first
        assert (other is None) is second
    both = head_on(35_000, 35_000, first={"in_distress": True}, second={"in_distress": True})
    assert told(*both) == (None, None)
    assert told(*both, strong=True) == (None, None)


@pytest.mark.parametrize(
    ("apart_m", "rate_fpm", "is_kept"),
    [(70_000.0, 1500.0, True), (19_000.0, 2500.0, True), (15_000.0, 2500.0, False)],
)
def test_more_is_tried_until_separation_is_kept(
    apart_m: float, rate_fpm: float, is_kept: bool
) -> None:
    """20 s before the loss, of which 10 s are for the response, 1500 ft/min are not enough."""
    found = resolve(*head_on(35_000, 35_000, apart_m=apart_m), [], STANDARD, INFRINGED, False)
    assert isinstance(found.first, Climb)
    assert found.first.vertical_rate_fpm == rate_fpm
    assert (found.margin >= 1.0) is is_kept


def test_what_would_meet_others_is_the_last_resort() -> None:
    """One above each of the two leaves only the descent, or a turn."""
    above = tuple(track(f"b{n}", n * 70_000.0, 35_900, 240.0 - 480.0 * n) for n in (0, 1))
    first, second = told(*head_on(35_000, 35_000), others=above)
    assert second is None or getattr(second, "sense", "") != "climb"
    assert first is not None


# --- what is told of it -----------------------------------------------------------------------
