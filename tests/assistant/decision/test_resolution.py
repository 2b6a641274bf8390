"""Recommendations are coordinated, and keep separation where that can be done."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from airhilt.assistant.decision.manoeuvres import NONE, Manoeuvre, Paths, paths, separations
from airhilt.assistant.decision.resolution import resolve
from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.relative_motion import Minima, Relative, relative, time_to_loss_s
from airhilt.messages import Climb, MaintainLevel, Turn
from airhilt.surveillance.tcas_resolution import Sense
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE
from breadth import examples

STANDARD = Minima(5 * NAUTICAL_MILE, 1000 * FOOT)
INFRINGED = Minima(5 * NAUTICAL_MILE, 850 * FOOT)


def track(
    icao24: str,
    north_m: float,
    east_m: float,
    altitude_ft: float,
    velocity: tuple[float, float] = (0.0, 0.0),
    rate_fpm: float = 0.0,
) -> Track:
    return Track(
        icao24, icao24.upper(), 0, 0.8 + north_m / 6.37e6, east_m / 4.44e6, altitude_ft * FOOT,
        *velocity, rate_fpm * FOOT / 60.0,
    )  # fmt: skip


speeds = st.floats(-250.0, 250.0)
anywhere = st.floats(-1_000.0, 1_000.0)
clearly_apart = st.floats(525.0, 800.0) | st.floats(-800.0, -525.0)


@st.composite
def pairs_in_conflict(
    draw: Callable[..., Any], gaps_ft: Any = anywhere
) -> tuple[Track, Track] | None:
    first = track(
        "a00001", 0.0, 0.0, 35_000, (draw(speeds), draw(speeds)),
        draw(st.sampled_from([0.0, 0.0, 1500.0, -1500.0])),
    )  # fmt: skip
    # Where the second has to be now to come near the first some time from now.
    velocity, meets_s = (draw(speeds), draw(speeds)), draw(st.floats(0.0, 200.0))
    north, east = (
        draw(st.floats(-5_000.0, 5_000.0)) + (own - other) * meets_s
        for own, other in zip(
            (first.velocity_north_m_s, first.velocity_east_m_s), velocity, strict=True
        )
    )
    second = track(
        "a00002", north, east, 35_000 + draw(gaps_ft), velocity,
        draw(st.sampled_from([0.0, 0.0, 1500.0, -1500.0])),
    )  # fmt: skip
    loss = time_to_loss_s(relative(first, second), first.profile(), second.profile(), INFRINGED)
    assume(loss is not None and loss < 200.0)
    return (first, second) if draw(st.booleans()) else (second, first)


def sense(recommendation: object) -> str | None:
    return recommendation.sense if isinstance(recommendation, Climb) else None


@examples(150)
@given(pairs_in_conflict(), st.booleans())
def test_two_are_never_told_the_same_sense(pair: tuple[Track, Track], strong: bool) -> None:
    resolution = resolve(*pair, [], STANDARD, INFRINGED, strong)
    senses = [sense(resolution.first), sense(resolution.second)]
    assert senses not in (["climb", "climb"], ["descend", "descend"])
    assert resolution.first is not None or resolution.second is not None


@examples(100)
@given(pairs_in_conflict(clearly_apart), st.booleans())
def test_whoever_is_clearly_higher_is_never_sent_down_through_the_other(
    pair: tuple[Track, Track], strong: bool
) -> None:
    first, second = pair
    resolution = resolve(first, second, [], STANDARD, INFRINGED, strong)
    first_is_higher = first.altitude_m > second.altitude_m
    higher = resolution.first if first_is_higher else resolution.second
    lower = resolution.second if first_is_higher else resolution.first
    assert sense(higher) != "descend"
    assert sense(lower) != "climb"


@examples(100)
@given(pairs_in_conflict())
def test_it_does_not_matter_who_is_named_first(pair: tuple[Track, Track]) -> None:
    one = resolve(*pair, [], STANDARD, INFRINGED, strong=False)
    other = resolve(*pair[::-1], [], STANDARD, INFRINGED, strong=False)
    assert (one.first, one.second) == (other.second, other.first)


def flown_by(own: Track, recommendation: object, origin: Track) -> Paths:
    """Return the path of an aircraft that does what it is told."""
    manoeuvre = NONE
    match recommendation:
        case Climb(altitude_ft=level, vertical_rate_fpm=rate, turn_deg=turn):
            manoeuvre = Manoeuvre(level * FOOT, rate * FOOT / 60.0, turn * DEGREE)
        case MaintainLevel(altitude_ft=level):
            manoeuvre = Manoeuvre(level * FOOT, abs(own.vertical_rate_m_s))
        case Turn(degrees=turn):
            manoeuvre = Manoeuvre(turn_rad=turn * DEGREE)
    there = relative(origin, own)
    motion = Relative(
        there.north_m, there.east_m,
        there.velocity_north_m_s + origin.velocity_north_m_s,
        there.velocity_east_m_s + origin.velocity_east_m_s,
    )  # fmt: skip
    return paths(motion, own.profile(), [manoeuvre])


@examples(100)
@given(pairs_in_conflict(), st.booleans())
def test_what_is_told_is_what_was_computed(pair: tuple[Track, Track], strong: bool) -> None:
    first, second = pair
    resolution = resolve(first, second, [], STANDARD, INFRINGED, strong)
    apart = separations(
        flown_by(first, resolution.first, first),
        flown_by(second, resolution.second, first),
        INFRINGED,
    )
    assert apart[0] == pytest.approx(resolution.margin, rel=0.01)


def diver_and_crosser() -> tuple[Track, Track]:
    """Return one without cabin pressure, and one 4,000 ft below it that flies across."""
    diver = track("a00001", 0.0, 0.0, 37_000, (0.0, 228.0), -5_000)
    diver.in_distress = True
    return diver, track("a00002", -11_000.0, 11_000.0, 33_000, (234.0, 0.0))


def test_where_neither_a_turn_nor_a_descent_is_enough_both_are_told() -> None:
    diver, crosser = diver_and_crosser()
    resolution = resolve(diver, crosser, [], STANDARD, INFRINGED, strong=False)
    assert resolution.first is None
    assert isinstance(resolution.second, Climb)
    assert resolution.second.sense == "descend"
    assert resolution.second.turn_deg != 0.0


def test_who_gives_way_to_a_diver_goes_below_the_level_where_the_two_are_past() -> None:
    diver, crosser = diver_and_crosser()
    told = resolve(diver, crosser, [], STANDARD, INFRINGED, strong=False).second
    near_s = relative(diver, crosser).interval_within(STANDARD.horizontal_m)
    assert isinstance(told, Climb)
    assert near_s is not None
    assert told.altitude_ft * FOOT < diver.profile().at(near_s[1]) - STANDARD.vertical_m


def head_on_pair(gap_ft: float = 0.0, rate_fpm: float = 0.0) -> tuple[Track, Track]:
    first = track("a00001", 0.0, 0.0, 35_000, (240.0, 0.0), rate_fpm)
    return first, track("a00002", 70_000.0, 0.0, 35_000 + gap_ft, (-240.0, 0.0))


def test_head_on_both_share_what_is_missing_and_it_is_enough() -> None:
    resolution = resolve(*head_on_pair(), [], STANDARD, INFRINGED, strong=False)
    assert {sense(resolution.first), sense(resolution.second)} == {"climb", "descend"}
    levels = [resolution.first.altitude_ft, resolution.second.altitude_ft]
    assert abs(levels[0] - levels[1]) >= 1_000
    assert all(level % 100 == 0 for level in levels)
    assert resolution.margin >= 1.0


@examples(60)
@given(pairs_in_conflict(), st.lists(st.tuples(*[st.floats(-30_000.0, 30_000.0)] * 2,
                                               st.sampled_from([34_000.0, 35_000.0, 36_000.0])),
                                     max_size=6))  # fmt: skip
def test_nothing_that_could_have_been_told_would_have_kept_more_separation(
    pair: tuple[Track, Track], crowd: list[tuple[float, float, float]]
) -> None:
    """A turn by 30 degrees of either, or of both, is always among what is weighed.

    What brings somebody into conflict with others within 3 minutes counts 1 less.
    """
    first, second = pair
    others = [
        track(f"b0000{number}", north_m, east_m, altitude_ft, (100.0, -50.0))
        for number, (north_m, east_m, altitude_ft) in enumerate(crowd)
    ]
    best = resolve(first, second, others, STANDARD, INFRINGED, strong=False).margin

    def worth(up: object, down: object) -> float:
        flown = flown_by(first, up, first), flown_by(second, down, first)
        margin = float(separations(*flown, INFRINGED)[0])
        meets = any(
            separations(path.soon(0), flown_by(other, None, first).soon(0), INFRINGED)[0] < 0.999
            for path, told in zip(flown, (up, down), strict=True) if told is not None
            for other in others
        )  # fmt: skip
        return margin - 1.0 if meets else margin

    turn = Turn(degrees=30)
    weighed = [worth(turn, turn), worth(turn, None), worth(None, turn)]
    assert best >= min(max(weighed), 1.0) - 0.01


SENSES = st.sampled_from([None, "climb", "descend"])


@examples(60)
@given(pairs_in_conflict(), SENSES, SENSES, st.booleans())
def test_nobody_is_told_to_leave_a_sense_that_is_to_stay(
    pair: tuple[Track, Track], first: Sense | None, second: Sense | None, strong: bool
) -> None:
    resolution = resolve(*pair, [], STANDARD, INFRINGED, strong, senses=(first, second))
    for told, kept in ((resolution.first, first), (resolution.second, second)):
        assert not isinstance(told, Climb) or kept in (None, told.sense)


def test_between_two_others_above_and_below_nobody_climbs_or_descends() -> None:
    first, second = head_on_pair()
    others = [
        track("a00003", 2_000.0, 0.0, 36_000, (240.0, 0.0)),
        track("a00004", 2_000.0, 0.0, 34_000, (240.0, 0.0)),
        track("a00005", 68_000.0, 0.0, 36_000, (-240.0, 0.0)),
        track("a00006", 68_000.0, 0.0, 34_000, (-240.0, 0.0)),
    ]
    resolution = resolve(first, second, others, STANDARD, INFRINGED, strong=False)
    recommended = [r for r in (resolution.first, resolution.second) if r is not None]
    assert recommended
    assert all(isinstance(r, Turn) for r in recommended)
    assert all(r.degrees > 0 for r in recommended)
