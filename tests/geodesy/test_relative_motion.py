"""Relative motion over the ellipsoid, against geographiclib and against brute force."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pytest
from geographiclib.geodesic import Geodesic
from hypothesis import assume, given
from hypothesis import strategies as st

from airhilt.geodesy.relative_motion import (
    Minima,
    Relative,
    VerticalProfile,
    relative,
    time_to_loss_s,
)
from airhilt.units import DEGREE
from breadth import examples

thoroughly = examples(300)

angles = st.floats(0.0, 360.0)
speeds = st.floats(0.0, 300.0)


@dataclass(frozen=True)
class Mover:
    """Something that moves along a geodesic."""

    lat_deg: float
    lon_deg: float
    track_deg: float
    speed_m_s: float
    altitude_m: float = 0.0

    @property
    def latitude_rad(self) -> float:
        return self.lat_deg * DEGREE

    @property
    def longitude_rad(self) -> float:
        return self.lon_deg * DEGREE

    @property
    def velocity_north_m_s(self) -> float:
        return self.speed_m_s * math.cos(self.track_deg * DEGREE)

    @property
    def velocity_east_m_s(self) -> float:
        return self.speed_m_s * math.sin(self.track_deg * DEGREE)

    def after(self, time_s: float) -> Mover:
        end = Geodesic.WGS84.Direct(
            self.lat_deg, self.lon_deg, self.track_deg, self.speed_m_s * time_s
        )
        return Mover(end["lat2"], end["lon2"], end["azi2"], self.speed_m_s, self.altitude_m)


def geodesic_m(one: Mover, other: Mover) -> float:
    inverse = Geodesic.WGS84.Inverse(one.lat_deg, one.lon_deg, other.lat_deg, other.lon_deg)
    return float(inverse["s12"])


@st.composite
def pairs(
    draw: Callable[..., Any], least_m: float = 100.0, most_m: float = 200_000.0
) -> tuple[Mover, Mover, float, float]:
    """Two movers and the azimuth, at the point midway, of the geodesic between them."""
    distance = draw(st.floats(least_m, most_m))
    line = Geodesic.WGS84.Line(
        draw(st.floats(-65.0, 65.0)), draw(st.floats(-180.0, 180.0)), draw(angles)
    )
    start, middle, end = (line.Position(distance * share) for share in (0.0, 0.5, 1.0))
    assume(abs(end["lat2"]) <= 65.0)
    movers = [
        Mover(place["lat2"], place["lon2"], draw(angles), draw(speeds)) for place in (start, end)
    ]
    return (*movers, distance, middle["azi2"] * DEGREE)


@thoroughly
@given(pairs())
def test_the_position_agrees_with_the_geodesic(pair: tuple[Mover, Mover, float, float]) -> None:
    own, other, distance, azimuth = pair
    seen = relative(own, other)
    assert seen.distance_m == pytest.approx(distance, rel=5e-4)
    off_m = math.hypot(
        seen.north_m - distance * math.cos(azimuth), seen.east_m - distance * math.sin(azimuth)
    )
    assert off_m <= 1e-3 * distance


@thoroughly
@given(pairs(least_m=1_000.0))
def test_the_range_rate_is_that_of_two_that_fly_along_geodesics(
    pair: tuple[Mover, Mover, float, float],
) -> None:
    own, other, _, _ = pair
    step_s = 0.05
    before, after = (geodesic_m(own.after(t), other.after(t)) for t in (-step_s, step_s))
    seen = relative(own, other)
    closing = (
        seen.north_m * seen.velocity_north_m_s + seen.east_m * seen.velocity_east_m_s
    ) / seen.distance_m
    assert closing == pytest.approx((after - before) / (2.0 * step_s), abs=0.3)


@thoroughly
@given(pairs(), st.floats(0.0, 120.0))
def test_flying_straight_on_leads_where_the_geodesics_lead(
    pair: tuple[Mover, Mover, float, float], time_s: float
) -> None:
    own, other, distance, _ = pair
    ahead_m = geodesic_m(own.after(time_s), other.after(time_s))
    foreseen_m = relative(own, other).at(time_s).distance_m
    assert abs(foreseen_m - ahead_m) <= 5e-4 * max(distance, ahead_m) + 1.0


@thoroughly
@given(pairs())
def test_the_two_see_each_other_at_the_same_distance_and_in_opposite_directions(
    pair: tuple[Mover, Mover, float, float],
) -> None:
    own, other, _, _ = pair
    assert relative(other, own) == pytest.approx([-x for x in relative(own, other)], abs=1e-6)


def test_across_the_antimeridian_it_is_not_far() -> None:
    own, other = Mover(10.0, 179.99, 90.0, 100.0), Mover(10.0, -179.99, 270.0, 100.0)
    seen = relative(own, other)
    assert seen.distance_m == pytest.approx(geodesic_m(own, other), rel=1e-4)
    assert seen.east_m > 0.0
    assert seen.velocity_east_m_s == pytest.approx(-200.0, abs=0.1)


def test_the_distance_grows_with_height() -> None:
    low = relative(Mover(40.0, 0.0, 0.0, 0.0), Mover(40.0, 1.0, 0.0, 0.0)).distance_m
    high = relative(
        Mover(40.0, 0.0, 0.0, 0.0, 12_000.0), Mover(40.0, 1.0, 0.0, 0.0, 12_000.0)
    ).distance_m
    assert high / low == pytest.approx(1.0 + 12_000.0 / 6.387e6, rel=1e-5)


# --- closest point of approach --------------------------------------------------------------

motions = st.builds(
    Relative,
    st.floats(-50_000.0, 50_000.0),
    st.floats(-50_000.0, 50_000.0),
    st.floats(-500.0, 500.0),
    st.floats(-500.0, 500.0),
)


@thoroughly
@given(motions, st.floats(-600.0, 600.0))
def test_at_the_closest_approach_no_other_time_is_closer(motion: Relative, time_s: float) -> None:
    closest_s = motion.time_to_closest_approach_s()
    assume(abs(closest_s) < 1e6)
    assert motion.at(closest_s).distance_m <= motion.at(closest_s + time_s).distance_m + 1e-3


def test_two_that_do_not_move_against_each_other_are_at_their_closest_now() -> None:
    assert Relative(100.0, 0.0, 0.0, 0.0).time_to_closest_approach_s() == 0.0


@thoroughly
@given(motions, st.floats(10.0, 30_000.0))
def test_the_interval_within_a_distance_agrees_with_sampling(
    motion: Relative, distance_m: float
) -> None:
    interval = motion.interval_within(distance_m)
    for step in range(-200, 201):
        time_s = 3.0 * step
        margin_m = motion.at(time_s).distance_m - distance_m
        if abs(margin_m) < 0.01:
            continue
        inside = interval is not None and interval[0] < time_s < interval[1]
        assert inside == (margin_m < 0.0), time_s


@pytest.mark.parametrize(("distance_m", "always"), [(99.0, False), (101.0, True)])
def test_two_that_keep_their_distance_are_within_it_always_or_never(
    distance_m: float, always: bool
) -> None:
    interval = Relative(100.0, 0.0, 0.0, 0.0).interval_within(distance_m)
    assert interval == ((-math.inf, math.inf) if always else None)


# --- losing separation ----------------------------------------------------------------------


@st.composite
def profiles(draw: Callable[..., Any]) -> VerticalProfile:
    altitude = draw(st.floats(0.0, 3_000.0))
    rate = draw(st.sampled_from([0.0, 0.0, 1.0, -1.0])) * draw(st.floats(1.0, 20.0))
    target = draw(st.none() | st.floats(-1_000.0, 4_000.0))
    return VerticalProfile(altitude, rate, target)


minima = st.builds(Minima, st.floats(500.0, 15_000.0), st.floats(50.0, 400.0))


@examples(500)
@given(motions, profiles(), profiles(), minima)
def test_the_time_to_loss_agrees_with_sampling(
    motion: Relative, own: VerticalProfile, other: VerticalProfile, limits: Minima
) -> None:
    loss_s = time_to_loss_s(motion, own, other, limits)

    def margin(time_s: float) -> float:
        """Negative while separation is lost, in units of the minima."""
        horizontal = motion.at(time_s).distance_m / limits.horizontal_m
        return max(horizontal, abs(own.at(time_s) - other.at(time_s)) / limits.vertical_m) - 1.0

    lost = [t for t in (0.5 * step for step in range(1200)) if margin(t) < -1e-6]
    if loss_s is None:
        assert not lost
        return
    assert not lost or lost[0] >= loss_s - 1e-6
    assert margin(loss_s) <= 1e-6
    if loss_s > 0.0:
        assert margin(loss_s * (1.0 - 1e-6) - 1e-6) >= -1e-4
    if lost:
        assert lost[0] - loss_s <= 0.5 or all(margin(t) < 1e-6 for t in (loss_s, loss_s + 1e-3))


LIMITS = Minima(9_260.0, 300.0)
CLOSING = Relative(30_000.0, 0.0, -250.0, 0.0)


def test_separation_that_is_lost_already_is_lost_now() -> None:
    near = Relative(1_000.0, 0.0, 250.0, 0.0)
    level = VerticalProfile(10_000.0, 0.0)
    assert time_to_loss_s(near, level, level, LIMITS) == 0.0


def test_a_climb_that_levels_off_below_is_no_loss_and_without_the_level_off_it_is_one() -> None:
    above = VerticalProfile(10_000.0, 0.0)
    climbing = VerticalProfile(9_000.0, 8.0, 9_690.0)
    assert time_to_loss_s(CLOSING, climbing, above, LIMITS) is None
    assert time_to_loss_s(CLOSING, climbing._replace(target_m=None), above, LIMITS) is not None


def test_a_target_behind_the_aircraft_does_not_level_it_off() -> None:
    climbing = VerticalProfile(9_000.0, 8.0, 8_000.0)
    assert climbing.level_off_s() == math.inf
    assert climbing.at(10.0) == 9_080.0


def test_two_that_stay_abreast_lose_separation_when_one_comes_to_the_other_level() -> None:
    abreast = Relative(0.0, 1_000.0, 0.0, 0.0)
    above, climbing = VerticalProfile(10_000.0, 0.0), VerticalProfile(9_000.0, 10.0)
    assert time_to_loss_s(abreast, climbing, above, LIMITS) == pytest.approx(70.0)
