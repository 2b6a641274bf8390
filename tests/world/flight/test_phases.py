"""Phases of procedures by themselves: what they set, and which phase follows."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import pytest

from airhilt.geodesy.wgs84 import Place
from airhilt.units import DEGREE, KNOT
from airhilt.world.flight import load_aircraft_type
from airhilt.world.flight.guidance import GuidanceModes
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.procedures.en_route import DriftDown, EmergencyDescent, EnRoute
from airhilt.world.flight.procedures.final import Final
from airhilt.world.flight.procedures.landing import Flare, Glide, Rollout
from airhilt.world.flight.procedures.preparation import Preparation
from airhilt.world.flight.procedures.takeoff import (
    ClimbOut,
    GoAround,
    RejectedTakeoff,
    Rotate,
    TakeoffRoll,
    require_lined_up,
)
from airhilt.world.flight.procedures.taxi import Stand, Standing, Taxi
from airhilt.world.flight.state import AircraftState
from airhilt.world.flight.taxi_path import TaxiPath
from flights import COURSE, along_runway, make_runway, on_the_ground
from stand_ins import StandIn, state_at

B737 = load_aircraft_type("737")
FINAL = Final(make_runway("01"), B737)
TICK_S = 0.05
FPM = 0.3048 / 60.0
"""A foot per minute in m/s."""
V2_KT = B737.speeds.climb_safety_kt


class Systems:
    """Stand-ins for all that the phases of a 737 set."""

    def __init__(self) -> None:
        self.airframe, self.autopilot, self.ground = StandIn(), StandIn(), StandIn()

    @property
    def all(self) -> AircraftSystems:
        airframe: Any = self.airframe
        autopilot: Any = self.autopilot
        ground: Any = self.ground
        return AircraftSystems(B737, airframe, autopilot, ground, TICK_S)

    def en_route(self) -> EnRoute:
        """Return the climb to 1,500 m on the runway's course."""
        modes = GuidanceModes(B737)
        return EnRoute(self.all, FINAL, modes.steepest_climb(1_500.0), modes.clean_climb_speed())


def along(distance_m: float, **state: float) -> AircraftState:
    return state_at(along_runway(distance_m), track_rad=COURSE * DEGREE, **state)


# --- takeoff --------------------------------------------------------------------------------


def test_takeoff_thrust_is_set_within_seconds_and_not_at_once() -> None:
    systems = Systems()
    phase: FlightPhase = TakeoffRoll(systems.all, FINAL, systems.en_route())
    levers: list[float] = []
    for _ in range(round(10.0 / TICK_S)):
        phase = phase.fly(along(60.0, speed_m_s=20.0))
        levers += systems.airframe.got["set_throttle"]
    assert max(levers[: round(1.0 / TICK_S)]) < 0.4
    assert levers[round(6.0 / TICK_S)] == B737.takeoff.lever
    assert levers == sorted(levers)


def climbed_out(airspeed_kt: float, altitude_m: float, rate_m_s: float = 8.0) -> Systems:
    """Return what a tick of the climb-out sets."""
    systems = Systems()
    state = along(3_000.0, speed_m_s=airspeed_kt * KNOT, altitude_m=altitude_m, rate_m_s=rate_m_s)
    phase = ClimbOut(systems.all, FINAL, systems.en_route()).fly(state)
    assert phase.name == "climb_out"
    return systems


def test_climbing_it_takes_the_gear_up() -> None:
    assert climbed_out(V2_KT, 50.0).airframe.got["set_gear"] == (0.0,)
    assert "set_gear" not in climbed_out(V2_KT, 50.0, rate_m_s=0.5).airframe.got


@pytest.mark.parametrize(
    ("above_v2_kt", "altitude_m", "retracts"),
    [(19.0, 310.0, False), (21.0, 310.0, True), (21.0, 300.0, False)],
)
def test_flaps_come_in_20_kt_above_v2_and_1000_ft_above_the_ground(
    above_v2_kt: float, altitude_m: float, retracts: bool
) -> None:
    got = climbed_out(V2_KT + above_v2_kt, altitude_m).airframe.got
    assert got.get("set_flaps") == ((0.0,) if retracts else None)


@pytest.mark.parametrize(("height_m", "name"), [(10.6, "rotate"), (10.7, "climb_out")])
def test_the_climb_out_begins_35_ft_above_the_runway(height_m: float, name: str) -> None:
    """The screen height of 14 CFR 25.113: 10.67 m."""
    systems = Systems()
    systems.airframe.answers |= {"main_wheel_height_m": height_m}
    state = along(1_500.0, speed_m_s=80.0)
    assert Rotate(systems.all, FINAL, systems.en_route(), state).fly(state).name == name


def test_the_rotation_pulls_to_the_pitch_and_at_the_thrust_of_the_type() -> None:
    systems, takeoff = Systems(), B737.takeoff
    state = along(1_500.0, speed_m_s=80.0)
    rotating = Rotate(systems.all, FINAL, systems.en_route(), state)
    assert systems.autopilot.got["take_over"] == (state, -takeoff.pull)
    rotating.fly(state)
    _, pitch, pitch_rate, turn_rate, lever = systems.autopilot.got["rotate"]
    assert (pitch, pitch_rate) == pytest.approx(
        (math.radians(takeoff.pitch_deg), math.radians(takeoff.pitch_rate_deg_s))
    )
    assert lever == takeoff.lever
    assert turn_rate == pytest.approx(FINAL.turn_rate(state))
    assert "follow_line" not in systems.ground.got


def test_while_its_wheels_roll_they_steer() -> None:
    systems = Systems()
    systems.airframe.answers["on_ground"] = True
    state = along(1_500.0, speed_m_s=80.0)
    Rotate(systems.all, FINAL, systems.en_route(), state).fly(state)
    assert systems.autopilot.got["rotate"][3] is None
    assert systems.ground.got["follow_line"][0] is state


@pytest.mark.parametrize(("below_kt", "name"), [(0.1, "takeoff_roll"), (0.0, "rotate")])
def test_it_rotates_at_the_speed_of_the_type(below_kt: float, name: str) -> None:
    systems = Systems()
    systems.airframe.answers["on_ground"] = True
    roll = TakeoffRoll(systems.all, FINAL, systems.en_route())
    assert systems.airframe.got["set_brakes"] == (0.0,)
    assert systems.airframe.got["set_flaps"] == (B737.takeoff.flaps,)
    speed_m_s = (B737.speeds.rotate_kt - below_kt) * KNOT
    assert roll.fly(along(900.0, speed_m_s=speed_m_s)).name == name


@pytest.mark.parametrize("over_kt", [0.0, 5.0, -5.0])
def test_below_1000_ft_it_climbs_at_v2_and_10_kt_with_takeoff_thrust(over_kt: float) -> None:
    """With a pitch of 15 degrees at most, and never down."""
    systems = Systems()
    systems.autopilot.level_angle_of_attack = 6.0 * DEGREE
    climbing = ClimbOut(systems.all, FINAL, systems.en_route())
    speed_m_s = (V2_KT + 10.0 + over_kt) * KNOT
    climbing.fly(along(3_000.0, speed_m_s=speed_m_s, altitude_m=304.0, rate_m_s=8.0))
    _, _, airspeed, lever = systems.autopilot.got["fly_on_pitch"]
    assert airspeed == pytest.approx((V2_KT + 10.0) * KNOT)
    assert lever == B737.takeoff.lever
    limits = systems.autopilot.named["fly_on_pitch"]
    assert limits == pytest.approx({"steepest_climb": 9.0 * DEGREE, "steepest_descent": 0.0})


def test_above_1000_ft_it_accelerates_to_the_clean_speed_with_climb_thrust() -> None:
    """The airspeed that it asks for is 5 m/s ahead of its own."""
    systems = Systems()
    climbing = ClimbOut(systems.all, FINAL, systems.en_route())
    clean_m_s = B737.speeds.minimum_clean_kt * KNOT
    for speed_m_s, asked_m_s in ((85.0, 90.0), (100.0, clean_m_s)):
        climbing.fly(along(3_000.0, speed_m_s=speed_m_s, altitude_m=306.0, rate_m_s=8.0))
        _, _, airspeed, lever = systems.autopilot.got["fly_on_pitch"]
        assert airspeed == pytest.approx(asked_m_s)
        assert lever == B737.takeoff.climb_lever


def test_above_400_ft_it_turns_as_it_is_told() -> None:
    systems = Systems()
    modes = GuidanceModes(B737)
    then = EnRoute(
        systems.all, modes.track(1.0), modes.steepest_climb(1_500.0), modes.clean_climb_speed()
    )
    for altitude_m, is_told in ((121.0, False), (123.0, True)):
        state = along(3_000.0, speed_m_s=80.0, altitude_m=altitude_m, rate_m_s=8.0)
        assert ClimbOut(systems.all, FINAL, then).fly(state).name == "climb_out"
        turn_rate = systems.autopilot.got["fly_on_pitch"][1]
        assert turn_rate == (then.lateral if is_told else FINAL).turn_rate(state)


def test_the_climb_out_cleans_up_and_levels_off_into_what_follows() -> None:
    systems = Systems()
    then = systems.en_route()
    state = along(6_000.0, speed_m_s=100.0, altitude_m=1_490.0, rate_m_s=8.0)
    assert ClimbOut(systems.all, FINAL, then).fly(state) is then
    assert "clean_up" in systems.airframe.got
    assert systems.autopilot.got["fly"][0] is state


# --- takeoff that is not ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("along_m", "right_m", "turned_deg", "refusal"),
    [
        (0.5, 0.0, 0.0, None),
        (-0.5, 0.0, 0.0, "-[01] m beyond the beginning of runway 01"),
        (2_199.0, 0.0, 0.0, None),
        (2_201.0, 0.0, 0.0, "2201 m beyond the beginning of runway 01"),
        (60.0, 22.4, 0.0, None),
        (60.0, -22.4, 0.0, None),
        (60.0, 22.6, 0.0, "23 m beside the centre line"),
        (60.0, -22.6, 0.0, "23 m beside the centre line"),
        (60.0, 0.0, 14.9, None),
        (60.0, 0.0, -15.1, "15 degrees off its course"),
        (60.0, 0.0, 15.1, "15 degrees off its course"),
        (60.0, 0.0, 180.0, "180 degrees off its course"),
    ],
)
def test_lined_up_is_who_is_on_the_runway_within_15_degrees_of_its_course(
    along_m: float, right_m: float, turned_deg: float, refusal: str | None
) -> None:
    """It is 45 m wide and 2,200 m long."""
    heading = (COURSE + turned_deg) * DEGREE
    state = state_at(along_runway(along_m, right_m), altitude_m=4.0, speed_m_s=0.0,
                     heading_rad=heading % math.tau)  # fmt: skip
    if refusal is None:
        require_lined_up(state, FINAL)
    else:
        with pytest.raises(ValueError, match=refusal):
            require_lined_up(state, FINAL)


def test_before_a_displaced_threshold_a_takeoff_may_begin() -> None:
    runway = make_runway("01")
    displaced = Final(replace(runway, displaced_m=300.0, start=along_runway(-300.0)), B737)
    state = state_at(along_runway(-290.0), altitude_m=4.0, track_rad=COURSE * DEGREE)
    require_lined_up(state, displaced)
    with pytest.raises(ValueError, match="take_off -290 m beyond"):
        require_lined_up(state, FINAL)


def test_a_rejected_takeoff_brakes_by_the_deceleration_of_the_type_and_spoils_the_lift() -> None:
    systems = Systems()
    rejected = RejectedTakeoff(systems.all, FINAL)
    assert systems.airframe.got["set_throttle"] == (0.0,)
    fast = along(800.0, speed_m_s=50.0)
    assert rejected.fly(fast) is rejected
    assert systems.ground.got["slow_down"] == (fast, B737.takeoff.rejected_deceleration_m_s2)
    brakes = ("set_speed_brakes", "set_ground_spoilers")
    assert [systems.airframe.got[each] for each in brakes] == [(1.0,), (1.0,)]
    assert rejected.fly(along(1_200.0, speed_m_s=0.06)) is rejected
    assert rejected.fly(along(1_200.0, speed_m_s=0.04)).name == "standing"
    assert [systems.airframe.got[each] for each in brakes] == [(0.0,), (0.0,)]


# --- go-around ----------------------------------------------------------------------------------


def go_around_after(seconds: float, systems: Systems, rate_m_s: float) -> GoAround:
    """Return a go-around some time after its beginning."""
    modes = GuidanceModes(B737)
    climb = modes.altitude_at_usual_rate(1_500.0)
    going = GoAround(systems.all, EnRoute(systems.all, FINAL, climb, modes.clean_climb_speed()))
    for _ in range(round(seconds / TICK_S)):
        going.fly(along(-900.0, altitude_m=50.0, rate_m_s=rate_m_s))
    return going


def test_a_go_around_begins_with_the_levers() -> None:
    systems = Systems()
    go_around_after(0.9, systems, rate_m_s=-3.0)
    _, _, *asked = systems.autopilot.got["flare"]
    assert asked == [-3.0, 0.0, B737.takeoff.lever, None]


def test_a_second_later_it_stops_the_descent_and_takes_gear_and_flaps_up_at_300_ft_min() -> None:
    systems = Systems()
    going = go_around_after(1.1, systems, rate_m_s=-3.0)
    sinking = along(-900.0, altitude_m=50.0, rate_m_s=1.52)
    assert going.fly(sinking) is going
    state, turn_rate, *asked = systems.autopilot.got["flare"]
    assert (state, turn_rate) == (sinking, FINAL.turn_rate(sinking))
    assert asked == [pytest.approx(300.0 * FPM), 1.5, B737.takeoff.lever, None]
    assert "set_gear" not in systems.airframe.got
    going.fly(along(-900.0, altitude_m=50.0, rate_m_s=1.53))
    assert systems.airframe.got["set_gear"] == (0.0,)
    assert systems.airframe.got["set_flaps"] == (B737.takeoff.flaps,)


def gone_around(altitude_m: float, speed_m_s: float) -> Systems:
    """Return what a tick of a go-around sets, in the climb at an altitude."""
    systems = Systems()
    going = go_around_after(1.1, systems, rate_m_s=8.0)
    going.fly(along(900.0, altitude_m=altitude_m, speed_m_s=speed_m_s, rate_m_s=8.0))
    return systems


def test_below_1000_ft_it_goes_around_at_v2_and_10_kt_and_at_the_usual_rate() -> None:
    _, _, rate, airspeed = gone_around(304.0, 85.0).autopilot.got["fly"]
    assert rate == pytest.approx(B737.speeds.climb_rate_fpm * FPM)
    assert airspeed == pytest.approx((V2_KT + 10.0) * KNOT)


def test_above_1000_ft_it_goes_on_as_after_a_takeoff() -> None:
    systems = gone_around(306.0, (V2_KT + 21.0) * KNOT)
    assert systems.airframe.got["set_flaps"] == (0.0,)
    assert systems.autopilot.got["fly_on_pitch"][3] == B737.takeoff.climb_lever


def test_a_go_around_to_a_low_altitude_levels_off_clean() -> None:
    systems = Systems()
    modes = GuidanceModes(B737)
    then = EnRoute(systems.all, FINAL, modes.steepest_climb(110.0), modes.clean_climb_speed())
    going = GoAround(systems.all, then)
    going.fly(along(-900.0, altitude_m=50.0, rate_m_s=8.0))
    assert going.fly(along(0.0, altitude_m=105.0, rate_m_s=8.0)) is then
    assert "clean_up" in systems.airframe.got
    assert systems.autopilot.got["fly"][3] == pytest.approx(B737.speeds.minimum_clean_kt * KNOT)


# --- emergencies --------------------------------------------------------------------------------


def downward(systems: Systems, altitude_m: float) -> EnRoute:
    modes = GuidanceModes(B737)
    speed = modes.airspeed(B737.speeds.drift_down_kt * KNOT)
    return EnRoute(systems.all, modes.track(1.0), modes.steepest_descent(altitude_m), speed)


def test_an_emergency_descent_is_flown_at_idle_10_kt_below_the_greatest_speed() -> None:
    """By 9 degrees at most, with speed brakes."""
    systems = Systems()
    descending = EmergencyDescent(systems.all, downward(systems, 3_000.0))
    assert systems.airframe.got["set_speed_brakes"] == (1.0,)
    low = along(0.0, altitude_m=5_000.0, speed_m_s=150.0, rate_m_s=-20.0, mach=0.5)
    assert descending.fly(low) is descending
    _, _, airspeed, lever = systems.autopilot.got["fly_on_pitch"]
    assert airspeed == pytest.approx((B737.speeds.maximum_kt - 10.0) * KNOT)
    assert lever == 0.0
    assert systems.autopilot.named["fly_on_pitch"] == {"steepest_descent": 9.0 * DEGREE}
    high = along(0.0, altitude_m=10_000.0, speed_m_s=150.0, rate_m_s=-20.0, mach=0.82)
    descending.fly(high)
    airspeed = systems.autopilot.got["fly_on_pitch"][2]
    assert airspeed == pytest.approx(150.0 * (B737.speeds.maximum_mach - 0.02) / 0.82)


def test_an_emergency_descent_takes_the_speed_brakes_in_and_levels_off() -> None:
    systems = Systems()
    then = downward(systems, 3_000.0)
    descending = EmergencyDescent(systems.all, then)
    assert descending.fly(along(0.0, altitude_m=3_100.0, rate_m_s=-20.0)) is then
    assert systems.airframe.got["set_speed_brakes"] == (0.0,)


def test_a_drift_down_is_flown_at_full_thrust_and_never_climbs() -> None:
    systems = Systems()
    then = downward(systems, 3_000.0)
    drifting = DriftDown(systems.all, then)
    state = along(0.0, altitude_m=8_000.0, rate_m_s=-2.0, speed_m_s=120.0)
    assert drifting.fly(state) is drifting
    flown, turn_rate, airspeed, lever = systems.autopilot.got["fly_on_pitch"]
    assert (flown, turn_rate, lever) == (state, then.lateral.turn_rate(state), 1.0)
    assert airspeed == pytest.approx(B737.speeds.drift_down_kt * KNOT)
    assert systems.autopilot.named["fly_on_pitch"] == {"steepest_climb": 0.0}


def test_it_levels_where_it_is_once_the_failed_engine_has_spooled_down_for_20_s() -> None:
    systems = Systems()
    then = downward(systems, 3_000.0)
    keeping: Any = SimpleNamespace(lever=1.0, potential_climb=0.0, fly=lambda *_: None,
                                   fly_on_pitch=lambda *_, **__: None)  # fmt: skip
    drifting = DriftDown(systems.all._replace(autopilot=keeping), then)
    state = along(0.0, altitude_m=8_000.0, rate_m_s=-0.3, speed_m_s=120.0)
    ticks = [drifting.fly(state) for _ in range(round(20.1 / TICK_S))]
    levelled = ticks.index(then) * TICK_S
    assert levelled == pytest.approx(20.0, abs=0.11)
    assert then.vertical.clearance == pytest.approx((8_000.0, 100.0 * FPM))


def test_a_drift_down_levels_off_at_an_altitude_that_was_commanded() -> None:
    systems = Systems()
    then = downward(systems, 7_990.0)
    state = along(0.0, altitude_m=8_000.0, rate_m_s=-2.0, speed_m_s=120.0)
    assert DriftDown(systems.all, then).fly(state) is then


# --- approach -------------------------------------------------------------------------------


def glide_from(systems: Systems, altitude_m: float) -> Glide:
    return Glide(systems.all, FINAL, (), altitude_m, Preparation(systems.all))


@pytest.mark.parametrize(("before_m", "is_configured"), [(11_020.0, False), (10_980.0, True)])
def test_gear_and_flaps_come_out_where_the_type_has_it(
    before_m: float, is_configured: bool
) -> None:
    systems = Systems()
    systems.airframe.answers["main_wheel_height_m"] = 500.0
    glide_from(systems, 500.0).fly(along(-before_m, altitude_m=500.0))
    got, speeds = systems.airframe.got, B737.speeds
    assert got.get("set_gear") == ((1.0,) if is_configured else None)
    assert got.get("set_flaps") == ((B737.landing.flaps,) if is_configured else None)
    airspeed_kt = speeds.approach_kt if is_configured else speeds.minimum_clean_kt
    assert systems.autopilot.got["fly"][3] == pytest.approx(airspeed_kt * KNOT)


def test_below_the_glide_path_it_keeps_its_altitude_until_the_path_is_met() -> None:
    systems = Systems()
    systems.airframe.answers["main_wheel_height_m"] = 300.0
    glide = glide_from(systems, 400.0)
    glide.fly(along(-9_000.0, altitude_m=400.0))
    assert systems.autopilot.got["fly"][2] == pytest.approx(0.0)
    glide.fly(along(-9_000.0, altitude_m=395.0))
    assert systems.autopilot.got["fly"][2] == pytest.approx(
        5.0 * B737.gains.guidance.altitude_per_s
    )


@pytest.mark.parametrize(("height_m", "closely"), [(60.5, False), (59.5, True)])
def test_below_200_ft_the_glide_path_is_followed_closely(height_m: float, closely: bool) -> None:
    systems = Systems()
    systems.airframe.answers["main_wheel_height_m"] = height_m
    glide_from(systems, 60.0).fly(along(-1_000.0, altitude_m=65.0))
    assert systems.autopilot.named["fly"] == {"closely": closely}


@pytest.mark.parametrize(("above_m", "name"), [(0.05, "glide"), (-0.05, "flare")])
def test_the_flare_begins_where_its_sink_rate_is_that_of_the_glide_path(
    above_m: float, name: str
) -> None:
    flare = B737.landing.flare
    sink_m_s = 70.0 * math.tan(3.0 * DEGREE)
    height_m = (sink_m_s - flare.touchdown_rate_fpm * FPM) * flare.time_constant_s
    systems = Systems()
    systems.airframe.answers["main_wheel_height_m"] = height_m + above_m
    state = along(-100.0, altitude_m=20.0, speed_m_s=70.0)
    assert glide_from(systems, 60.0).fly(state).name == name


def flared(height_m: float, throttle: float = 0.6) -> tuple[Any, ...]:
    """Return what the autopilot gets in a flare that began at 12 m, the nose 2 degrees right."""
    systems = Systems()
    systems.airframe.answers |= {"main_wheel_height_m": height_m, "throttle": throttle}
    state = along(100.0, heading_rad=(COURSE + 2.0) * DEGREE)
    phase = Flare(systems.all, FINAL, (), 12.0)
    assert phase.fly(state) is phase
    given, turn_rate, *asked = systems.autopilot.got["flare"]
    assert given is state
    assert turn_rate == FINAL.turn_rate(state)
    return tuple(asked)


@pytest.mark.parametrize("height_m", [12.0, 6.0, 1.6, 0.0, -0.3])
def test_in_the_flare_the_sink_rate_dies_away_with_the_height_and_the_thrust_too(
    height_m: float,
) -> None:
    flare = B737.landing.flare
    above_m = max(height_m, 0.0)
    sink_m_s = above_m / flare.time_constant_s + flare.touchdown_rate_fpm * FPM
    rate, acceleration, lever, _ = flared(height_m)
    assert rate == pytest.approx(-sink_m_s)
    assert acceleration == pytest.approx(sink_m_s / flare.time_constant_s)
    assert lever == pytest.approx(0.6 * above_m / 12.0)


def test_who_comes_higher_in_the_flare_gets_no_more_thrust() -> None:
    assert flared(15.0)[2] == pytest.approx(0.6)


def test_the_levers_are_idle_at_the_part_of_the_height_that_the_type_has() -> None:
    flare = B737.landing.flare.model_copy(update={"idle_height_part": 0.5})
    landing = B737.landing.model_copy(update={"flare": flare})
    kind = B737.model_copy(update={"landing": landing})
    levers: list[float] = []
    for height_m in (12.0, 9.0, 6.0, 3.0):
        systems = Systems()
        systems.airframe.answers |= {"main_wheel_height_m": height_m, "throttle": 0.6}
        Flare(systems.all._replace(kind=kind), FINAL, (), 12.0).fly(along(100.0))
        levers.append(systems.autopilot.got["flare"][4])
    assert levers == pytest.approx([0.6, 0.3, 0.0, 0.0])


def test_below_the_height_of_the_type_the_nose_is_turned_along_the_runway() -> None:
    height_m = B737.landing.flare.decrab_height_m
    assert flared(height_m + 0.01)[3] is None
    assert flared(height_m - 0.01)[3] == pytest.approx(2.0 * DEGREE, abs=1e-4)


def test_at_touchdown_the_rollout_begins_with_speed_brakes_and_spoilers() -> None:
    systems = Systems()
    systems.airframe.answers |= {"on_ground": True, "nose_on_ground": False}
    systems.autopilot.answers["steady_elevator"] = -0.15
    assert Flare(systems.all, FINAL, (), 12.0).fly(along(300.0)).name == "rollout"
    got = systems.airframe.got
    assert (got["set_speed_brakes"], got["set_ground_spoilers"]) == ((1.0,), (1.0,))
    assert systems.ground.got["reset"] == (-0.15,)
    assert systems.ground.named["follow_line"] == {"slipping": False}
    assert "lower_nose" in systems.ground.got


def test_once_on_the_glide_path_who_sinks_below_it_is_led_back_up_to_it() -> None:
    """It is not kept at the altitude from which it came onto the path."""
    systems = Systems()
    systems.airframe.answers["main_wheel_height_m"] = 300.0
    path_m = -FINAL.above_glide_path_m(along(-6_000.0, altitude_m=0.0))
    glide = glide_from(systems, path_m)

    def rate_m_s(altitude_m: float) -> float:
        assert glide.fly(along(-6_000.0, altitude_m=altitude_m)) is glide
        return float(systems.autopilot.got["fly"][2])

    assert rate_m_s(path_m + 5.0) < -70.0 * math.tan(3.0 * DEGREE)
    # Three kilometres farther out, the same altitude is 157 m below the path.
    low = along(-9_000.0, altitude_m=path_m)
    glide.fly(low)
    assert systems.autopilot.got["fly"][2] == pytest.approx(FINAL.vertical_rate(low))
    assert FINAL.vertical_rate(low) > 0.0


# --- rollout --------------------------------------------------------------------------------


EXIT: list[Place] = [along_runway(900.0), along_runway(930.0, 30.0), along_runway(930.0, 150.0)]
ALONG_AT_FIRST: list[Place] = [along_runway(900.0), along_runway(920.0), *EXIT[1:]]
"""An exit that begins on the centre line."""
EXIT_M_S = TaxiPath(ALONG_AT_FIRST, B737.ground.taxi_speed_kt * KNOT, 14.0).speed_m_s(0.0)


@pytest.mark.parametrize(
    ("at_m", "speed_m_s", "name"),
    [(500.0, 3.0, "rollout"), (898.0, 3.0, "vacate"), (898.0, 20.0, "rollout")],
    ids=["early", "there", "too fast"],
)
def test_it_turns_into_the_exit_where_that_begins_and_if_slow_enough(
    at_m: float, speed_m_s: float, name: str
) -> None:
    rollout = Rollout(Systems().all, FINAL, EXIT)
    assert rollout.fly(along(at_m, speed_m_s=speed_m_s)).name == name


def rolled_out(
    at_m: float, speed_m_s: float, exit_path: Sequence[Place] = ALONG_AT_FIRST
) -> Systems:
    systems = Systems()
    systems.airframe.answers["nose_on_ground"] = True
    Rollout(systems.all, FINAL, exit_path).fly(along(at_m, speed_m_s=speed_m_s))
    return systems


def test_without_an_exit_it_brakes_by_the_deceleration_of_the_type() -> None:
    systems = rolled_out(500.0, 60.0, ())
    assert systems.ground.got["slow_down"][1] == B737.ground.deceleration_m_s2
    lifted = Systems()
    Rollout(lifted.all, FINAL, ()).fly(along(500.0, speed_m_s=60.0))
    assert "slow_down" not in lifted.ground.got  # Not before the nose wheel is down.


@pytest.mark.parametrize(("speed_m_s", "name"), [(0.21, "rollout"), (0.19, "standing")])
def test_without_an_exit_it_stands_on_the_centre_line(speed_m_s: float, name: str) -> None:
    assert Rollout(Systems().all, FINAL, ()).fly(along(900.0, speed_m_s=speed_m_s)).name == name


@pytest.mark.parametrize(("at_m", "speed_m_s"), [(100.0, 60.0), (500.0, 30.0), (840.0, 12.0)])
def test_it_brakes_so_that_it_is_slow_a_second_before_its_exit(
    at_m: float, speed_m_s: float
) -> None:
    needed = (speed_m_s**2 - EXIT_M_S**2) / 2.0 / (900.0 - at_m - speed_m_s)
    assert needed < 3.0
    got = rolled_out(at_m, speed_m_s).ground.got
    assert got["slow_down"][1] == pytest.approx(needed, rel=2e-3)


def test_no_exit_makes_it_brake_harder_than_3_m_s2() -> None:
    assert rolled_out(800.0, 60.0).ground.got["slow_down"][1] == 3.0


def test_beyond_its_exit_it_brakes_as_without_one() -> None:
    got = rolled_out(910.0, 40.0).ground.got
    assert got["slow_down"][1] == B737.ground.deceleration_m_s2


def test_slow_already_it_rolls_on_to_its_exit() -> None:
    state = along(500.0, speed_m_s=EXIT_M_S - 0.01)
    systems = Systems()
    assert Rollout(systems.all, FINAL, ALONG_AT_FIRST).fly(state).name == "rollout"
    assert systems.ground.got["hold_speed"] == (state, EXIT_M_S)


@pytest.mark.parametrize(("over_m_s", "name"), [(1.9, "vacate"), (2.1, "rollout")])
def test_an_exit_is_taken_up_to_2_m_s_too_fast(over_m_s: float, name: str) -> None:
    state = along(899.0, speed_m_s=EXIT_M_S + over_m_s)
    assert Rollout(Systems().all, FINAL, ALONG_AT_FIRST).fly(state).name == name


# --- taxi ---------------------------------------------------------------------------------------


def taxiing(then: Stand = "standing") -> tuple[Systems, Taxi]:
    systems = Systems()
    path = TaxiPath([along_runway(0.0), along_runway(100.0)], 7.0, 14.0)
    return systems, Taxi(systems.all, path, "taxi", then)


@pytest.mark.parametrize(
    ("to_go_m", "speed_m_s", "name"),
    [(1.9, 0.04, "lined_up"), (2.1, 0.04, "taxi"), (1.9, 0.06, "taxi")],
)
def test_who_stands_within_2_m_of_the_end_has_arrived(
    to_go_m: float, speed_m_s: float, name: str
) -> None:
    _, phase = taxiing("lined_up")
    for at_m in range(0, 100, 10):
        phase.fly(along(float(at_m), speed_m_s=5.0))
    assert phase.fly(along(100.0 - to_go_m, speed_m_s=speed_m_s)).name == name


def test_who_holds_on_the_way_stands_there_and_has_not_arrived() -> None:
    systems, phase = taxiing()
    for at_m in range(0, 99, 7):
        phase.fly(along(float(at_m), speed_m_s=5.0))
    assert systems.ground.got["hold_speed"][1] > 0.0
    phase.hold()
    moving, stopped = along(98.5, speed_m_s=1.0), along(98.5, speed_m_s=0.0)
    assert phase.fly(moving).name == "taxi"
    assert systems.ground.got["hold_speed"] == (moving, 0.0)
    assert phase.fly(stopped) is phase
    assert phase.name == "standing"
    phase.resume()
    assert phase.name == "taxi"
    assert phase.fly(stopped) is not phase


@pytest.mark.parametrize(("speed_m_s", "at_rest"), [(0.051, False), (0.049, True)])
def test_who_stands_is_at_rest_once_nothing_moves(speed_m_s: float, at_rest: bool) -> None:
    systems = Systems()
    standing = Standing(systems.all)
    standing.fly(along(0.0, speed_m_s=speed_m_s))
    assert standing.at_rest is at_rest
    assert systems.ground.got["hold_speed"][1] == 0.0


def test_rolling_out_it_takes_no_en_route_command() -> None:
    aircraft = on_the_ground("737")
    control = aircraft.en_route
    control.phase = Rollout(control.systems, cast(Any, FINAL), ())
    with pytest.raises(ValueError, match="in phase rollout on the ground; expected in the air"):
        aircraft.en_route.hold_track(1.0)
