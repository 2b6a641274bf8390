"""What becomes true of two aircraft, and when."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any, cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.geodesy.relative_motion import Minima, VerticalProfile
from airhilt.units import FOOT, FOOT_PER_MINUTE, NAUTICAL_MILE, SECOND_NS, wrap_angle
from airhilt.world.site import FixedSite
from airhilt.world.truth.conflicts import profile_of
from breadth import examples
from straight import MINIMA, Rolling, Straight, Watch


def head_on(
    seconds: float = 60.0, speed: float = 250.0, **second: Any
) -> tuple[Straight, Straight]:
    """Two that meet after some seconds."""
    away = speed * seconds
    return (
        Straight(east_m=-away, east_m_s=speed),
        Straight(**({"east_m": away, "east_m_s": -speed} | second)),
    )


def test_head_on_separation_is_lost_then_it_is_a_near_miss_and_a_collision() -> None:
    watch = Watch(*head_on(60.0)).fly(70.0)
    assert watch.told["loss_of_separation"] == pytest.approx(
        60.0 - MINIMA.horizontal_m / 500, abs=0.1
    )
    assert watch.told["nmac"] == pytest.approx(60.0 - 500 * FOOT / 500, abs=0.1)
    assert watch.told["collision"] == pytest.approx(60.0, abs=0.15)


@pytest.mark.parametrize("mover", ["A", "B"])
def test_the_motion_of_a_pair_is_that_of_now_though_one_of_them_stands(mover: str) -> None:
    watch = Watch(Straight(east_m_s=10.0), Straight(1_000.0, east_m_s=10.0))
    before = watch.monitor.motion(("A", "B")).distance_m
    watch.aircraft[mover].advance(5.0)
    changed = watch.monitor.motion(("A", "B")).distance_m - before
    assert changed == pytest.approx(50.0 if mover == "B" else -50.0, abs=1.0)


def test_the_motion_of_a_pair_is_worked_out_once_for_all_who_ask_in_a_tick() -> None:
    monitor = Watch(Straight(east_m_s=10.0), Straight(1_000.0, east_m_s=10.0)).monitor
    assert monitor.motion(("A", "B")) is monitor.motion(("A", "B"))


@pytest.mark.parametrize("above_ft", [0.0, 500.0, 990.0])
def test_a_pair_that_no_scenario_names_is_watched_at_every_tick_when_it_is_near(
    above_ft: float,
) -> None:
    watch = Watch(*head_on(60.0, altitude_ft=35_000.0 + above_ft), always=False).fly(70.0)
    lost_s = 60.0 - MINIMA.horizontal_m / 500
    assert watch.told["loss_of_separation"] == pytest.approx(lost_s, abs=0.1)
    assert watch.truth.closest.vertical_m == pytest.approx(above_ft * FOOT, abs=1.0)
    assert watch.truth.closest.horizontal_m < 15.0


@pytest.mark.parametrize(
    ("grounded", "aside_m", "is_near"),
    [
        ((True, True), 60.0, False),
        ((True, False), 60.0, True),
        ((False, True), 60.0, True),
        ((True, False), 70.0, False),
        ((False, False), 70.0, True),
    ],
)
def test_who_flies_within_100_ft_of_one_on_the_ground_nearly_collides(
    grounded: tuple[bool, bool], aside_m: float, is_near: bool
) -> None:
    """The outlines of two that pass 60 m apart are 26 m apart; in flight, 500 ft are too near."""
    first, second = head_on(10.0, north_m=aside_m)
    first.on_ground, second.on_ground = grounded
    assert ("nmac" in Watch(first, second).fly(20.0).told) is is_near


def test_tcas_speaks_at_its_thresholds() -> None:
    watch = Watch(*head_on(80.0)).fly(50.0)
    assert watch.told["tcas_ta"] == pytest.approx(80.0 - 48.0, abs=1.5)
    assert watch.told["tcas_ra"] == pytest.approx(80.0 - 35.0, abs=1.5)


@pytest.mark.parametrize("levels_ft", [(20_200.0, 19_800.0), (19_800.0, 20_200.0)])
def test_of_two_tcas_with_different_thresholds_the_first_to_speak_counts(
    levels_ft: tuple[float, float],
) -> None:
    """Above 20,000 ft the thresholds are 48 s and 35 s, below 45 s and 30 s."""
    first, second = levels_ft
    far = 250.0 * 80.0
    watch = Watch(
        Straight(-far, east_m_s=250.0, altitude_ft=first),
        Straight(far, east_m_s=-250.0, altitude_ft=second),
    ).fly(60.0)
    assert watch.told["tcas_ta"] == pytest.approx(80.0 - 48.0, abs=1.5)
    assert watch.told["tcas_ra"] == pytest.approx(80.0 - 35.0, abs=1.5)


def test_tcas_says_nothing_of_who_carries_no_transponder() -> None:
    watch = Watch(*head_on(80.0), transponders=frozenset({"A"})).fly(81.0)
    assert not {"tcas_ta", "tcas_ra"} & set(watch.told)
    assert "collision" in watch.told


def test_near_the_ground_tcas_says_nothing() -> None:
    low: dict[str, Any] = {"altitude_ft": 400.0}
    watch = Watch(Straight(-5_000, east_m_s=50.0, **low), Straight(5_000, east_m_s=-50.0, **low))
    watch.fly(60.0)
    assert "tcas_ta" not in watch.told
    assert "loss_of_separation" in watch.told


@examples(40)
@given(st.floats(0.0, 1.0), st.floats(0.0, 25.0), st.floats(1_000.0, 7_000.0))
def test_a_pass_between_two_ticks_is_not_stepped_over(
    phase: float, aside_m: float, closing: float
) -> None:
    """At 7 km/s, with a tick of a second, the two are only seen kilometres from each other."""
    away = closing * (2.0 + phase)
    first = Straight()
    second = Straight(east_m=away, north_m=aside_m, east_m_s=-closing)
    watch = Watch(first, second, tick_s=1.0).fly(6.0)
    assert {"loss_of_separation", "nmac", "collision"} <= set(watch.told)
    assert watch.truth.closest.horizontal_m == pytest.approx(aside_m, abs=1.0)
    assert watch.truth.closest.t_ns == pytest.approx(
        (2.0 + phase) * SECOND_NS, abs=0.02 * SECOND_NS
    )


def test_a_steep_crossing_between_two_ticks_is_seen_at_the_height_of_the_passage() -> None:
    first = Straight()
    second = Straight(1_000, east_m_s=-1_000.0, altitude_ft=35_000 + 100, rate_fpm=-6_000)
    watch = Watch(first, second, tick_s=2.0).fly(4.0)
    assert watch.truth.closest.vertical_m == pytest.approx(0.0, abs=1.0)
    assert "collision" in watch.told


def test_how_near_is_what(subtests: pytest.Subtests) -> None:
    for aside_m, above_ft, told in [
        (0.0, 0.0, {"loss_of_separation", "nmac", "collision"}),
        (100.0, 0.0, {"loss_of_separation", "nmac"}),
        (0.0, 60.0, {"loss_of_separation", "nmac"}),
        (151.0, 99.0, {"loss_of_separation", "nmac"}),
        (499.5 * FOOT, 99.0, {"loss_of_separation", "nmac"}),
        (500.5 * FOOT, 99.0, {"loss_of_separation"}),
        (155.0, 0.0, {"loss_of_separation"}),
        (0.0, 140.0, {"loss_of_separation", "nmac"}),  # 99 ft between the outlines.
        (0.0, 142.0, {"loss_of_separation"}),
        (9_250.0, 999.0, {"loss_of_separation"}),
        (9_270.0, 0.0, set()),
        (0.0, 1_001.0, set()),
    ]:
        with subtests.test(str((aside_m, above_ft, told))):
            other = {"north_m": aside_m, "altitude_ft": 35_000 + above_ft}
            watch = Watch(*head_on(20.0, **other)).fly(40.0)
            assert {phase for phase in watch.told if not phase.startswith("tcas")} == told


def test_two_of_another_pair_are_watched_too() -> None:
    watch = Watch(Straight(north_m=90_000.0), *head_on(30.0)).fly(40.0)
    assert {"loss_of_separation", "collision"} <= set(watch.monitor.pairs[("B", "C")].first_ns)
    assert watch.monitor.pairs[("A", "B")].first_ns == {}


def test_two_that_meet_where_longitudes_turn_over_are_watched() -> None:
    watch = Watch(*head_on(30.0), always=False)
    for craft in watch.aircraft.values():
        longitude_rad = craft.state.longitude_rad + math.pi
        craft.state = craft.state._replace(longitude_rad=wrap_angle(longitude_rad))
    assert {"loss_of_separation", "collision"} <= watch.fly(40.0).told.keys()


def test_an_aircraft_that_has_ended_is_in_nobodys_way() -> None:
    watch = Watch(*head_on(60.0))
    watch.fly(10.0)
    watch.aircraft["B"].ended = "ground_contact"
    watch.fly(60.0)
    assert "loss_of_separation" not in watch.told
    assert not watch.monitor.flying(("A", "B"))


def test_what_is_lost_from_the_start_is_told_in_the_first_second() -> None:
    watch = Watch(Straight(), Straight(east_m=1_000.0)).fly(0.5)
    assert "loss_of_separation" in watch.told


def test_two_that_draw_apart_from_the_start_were_never_closer_than_at_the_start() -> None:
    for away in (1_000.0, 20_000.0):
        pair = Straight(-away, east_m_s=-250.0), Straight(away, east_m_s=250.0)
        closest = Watch(*pair).fly(3.0).truth.closest
        assert 0 <= closest.t_ns <= 0.1 * SECOND_NS
        assert closest.horizontal_m == pytest.approx(2 * away, abs=30.0)


# --- least separation -----------------------------------------------------------------------


def test_the_least_separations_are_each_taken_while_the_other_is_infringed() -> None:
    """800 ft apart when they pass 2 NM abeam; on the same level only long after."""
    second = {"north_m": 2 * NAUTICAL_MILE, "altitude_ft": 35_800.0}
    watch = Watch(*head_on(30.0, **second)).fly(60.0)
    assert watch.truth.least_horizontal_m == pytest.approx(2 * NAUTICAL_MILE, rel=1e-3)
    assert watch.truth.least_vertical_m == pytest.approx(800 * FOOT, rel=1e-6)


def test_a_minimum_that_never_applied_is_none() -> None:
    above = Watch(*head_on(20.0, altitude_ft=37_000.0)).fly(40.0).truth
    assert above.least_horizontal_m is None
    assert above.least_vertical_m == pytest.approx(2_000 * FOOT)
    beside = Watch(*head_on(20.0, north_m=20_000.0)).fly(40.0).truth
    assert beside.least_horizontal_m == pytest.approx(20_000.0, rel=1e-3)
    assert beside.least_vertical_m is None


def test_vertical_separation_far_away_does_not_count() -> None:
    """It descends through the other's level, but 40 km from it."""
    second = Straight(40_000.0, altitude_ft=36_000.0, rate_fpm=-3_000.0)
    truth = Watch(Straight(), second).fly(30.0).truth
    assert truth.least_vertical_m is None
    assert truth.first_ns.keys() <= {"tcas_ta", "tcas_ra"}


@examples(25)
@given(
    st.floats(-3_000.0, 3_000.0),
    st.floats(-1_500.0, 1_500.0),
    st.floats(-100.0, 100.0),
    st.floats(-2_000.0, 2_000.0),
)
def test_the_closest_approach_is_no_farther_than_the_pair_was_at_any_tick(
    aside_m: float, above_ft: float, north_m_s: float, rate_fpm: float
) -> None:
    watch = Watch(
        *head_on(
            10.0, north_m=aside_m, altitude_ft=35_000 + above_ft, north_m_s=north_m_s,
            rate_fpm=rate_fpm,
        ),
        tick_s=0.25,
    )  # fmt: skip
    nearest = math.inf
    for _ in watch.ticks(20.0):
        horizontal_m = watch.monitor.motion(("A", "B")).distance_m
        nearest = min(nearest, math.hypot(horizontal_m, watch.monitor.vertical_m(("A", "B"))))
    closest = watch.truth.closest
    vertically_m = abs(rate_fpm) * FOOT_PER_MINUTE * watch.tick_s
    assert closest.slant_m <= nearest + vertically_m + 1e-6
    assert closest.slant_m == pytest.approx(nearest, abs=70.0)


def test_a_pair_that_is_always_followed_has_a_closest_approach_however_far() -> None:
    near, far = (
        Watch(*head_on(20.0, north_m=60_000.0), always=always).fly(30.0) for always in (True, False)
    )
    assert near.truth.closest.horizontal_m == pytest.approx(60_000.0, rel=1e-3)
    assert ("A", "B") not in far.monitor.pairs


# --- where an aircraft is really going ------------------------------------------------------


def test_the_time_to_loss_knows_where_a_climb_ends() -> None:
    """Below, at 1500 ft/min, 1500 m from the other's level: it levels off 1000 ft short, or not."""
    for target_ft, loss in ((34_000.0, False), (35_000.0, True)):
        climbing = Straight(-25_000, altitude_ft=33_000, east_m_s=250.0, rate_fpm=1_500,
                            target_ft=target_ft)  # fmt: skip
        other = Straight(25_000, east_m_s=-250.0)
        limits = Minima(5 * NAUTICAL_MILE, 900 * FOOT)
        found = Watch(climbing, other, minima=limits).monitor.time_to_loss_s(("A", "B"))
        assert (found is not None) == loss


# --- at an airport --------------------------------------------------------------------------

ZONE = FixedSite(0.0, 0.0)


def low(aside_m: float = 0.0, altitude_ft: float = 1_000.0) -> list[Straight]:
    """Two at 140 kt that meet over the airport, or beside it, after half a minute."""
    return [
        Straight(-way * 30.0 * 72.0, aside_m, altitude_ft, east_m_s=way * 72.0) for way in (1, -1)
    ]


def test_in_the_zone_of_a_tower_there_are_no_minima_but_near_misses_and_collisions() -> None:
    watch = Watch(*low(), zone=ZONE).fly(40.0)
    assert {"nmac", "collision"} <= set(watch.told)
    assert "loss_of_separation" not in watch.told


@pytest.mark.parametrize(
    ("aside_m", "altitude_ft", "lost"),
    [(0.0, 2_400.0, False), (0.0, 2_700.0, True), (10_000.0, 1_000.0, True)],
)
def test_the_zone_ends_above_and_around(aside_m: float, altitude_ft: float, lost: bool) -> None:
    watch = Watch(*low(aside_m, altitude_ft), zone=ZONE).fly(40.0)
    assert ("loss_of_separation" in watch.told) == lost


def test_who_is_in_the_zone_must_be_separated_from_who_is_not() -> None:
    inside = Straight(0.0, 8_500.0, 2_000.0)
    outside = Straight(0.0, 10_000.0, 2_000.0)
    assert "loss_of_separation" in Watch(inside, outside, zone=ZONE).fly(1.0).told


def test_a_vehicle_and_an_aircraft_have_no_separation_to_lose_but_can_collide() -> None:
    plane = Straight(-300.0, altitude_ft=0.0, east_m_s=60.0, on_ground=True, phase="rollout")
    watch = Watch(plane, Rolling()).fly(8.0)
    assert set(watch.told) == {"collision"}
    assert watch.told["collision"] == pytest.approx((300.0 - 16.8 - 1.0) / 60.0, abs=0.1)
    assert watch.truth.least_horizontal_m is None


def test_two_on_the_ground_are_never_too_near_until_they_touch() -> None:
    first = Straight(-40.0, altitude_ft=0.0, east_m_s=5.0, on_ground=True, phase="taxi")
    second = Straight(altitude_ft=0.0, on_ground=True, phase="standing")
    watch = Watch(first, second).fly(1.0)
    assert watch.told == {}
    assert set(watch.fly(3.0).told) == {"collision"}


@pytest.mark.parametrize("speed_m_s", [75.0, 400.0])
def test_a_fast_aircraft_does_not_pass_a_vehicle_between_two_looks(speed_m_s: float) -> None:
    """Pairs on the ground are sorted out once a second."""
    plane = Straight(
        -speed_m_s * 25.5, altitude_ft=0.0, east_m_s=speed_m_s, on_ground=True, phase="takeoff_roll"
    )
    assert "collision" in Watch(plane, Rolling(), always=False).fly(40.0).told


def test_an_aircraft_flies_to_its_target_at_its_rate_once_that_leads_there(
    subtests: pytest.Subtests,
) -> None:
    for target_ft, rate_fpm, expected_fpm, has_target in [
        (36_000.0, 500.0, 500.0, True),
        (34_000.0, -500.0, -500.0, True),
        (36_000.0, -500.0, 1_500.0, True),  # It still descends, and is to climb.
        (34_000.0, 500.0, 1_500.0, True),
        (34_000.0, 0.0, 1_500.0, True),
        (35_090.0, 500.0, 0.0, False),  # As good as there.
        (35_110.0, 500.0, 500.0, True),
    ]:
        with subtests.test(str((target_ft, rate_fpm, expected_fpm, has_target))):
            state = Straight(rate_fpm=rate_fpm).state
            aircraft = SimpleNamespace(
                state=state, target_altitude_m=target_ft * FOOT, on_ground=False,
                target_vertical_rate_m_s=1_500.0 * FOOT_PER_MINUTE,
            )  # fmt: skip
            profile = profile_of(cast(Any, aircraft))
            assert profile.altitude_m == state.altitude_m
            assert profile.rate_m_s == pytest.approx(expected_fpm * FOOT_PER_MINUTE)
            assert profile.target_m == (pytest.approx(target_ft * FOOT) if has_target else None)
            aircraft.on_ground = True
            assert profile_of(cast(Any, aircraft)) == VerticalProfile(state.altitude_m, 0.0)
