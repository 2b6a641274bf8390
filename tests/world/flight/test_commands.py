"""Commands to an aircraft by themselves: what each changes, and what is refused."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast

import pytest

from airhilt.geodesy.wgs84 import Place
from airhilt.units import DEGREE, KNOT
from airhilt.world.flight import load_aircraft_type, standard_atmosphere
from airhilt.world.flight.control import FlightControl
from airhilt.world.flight.guard import FlightGuard
from airhilt.world.flight.phases import AircraftSystems
from airhilt.world.flight.procedure_commands import ProcedureCommands
from airhilt.world.flight.procedures.final import Final
from airhilt.world.flight.procedures.landing import Glide, Rollout
from airhilt.world.flight.procedures.preparation import Preparation
from airhilt.world.flight.procedures.taxi import Taxi
from airhilt.world.flight.route import Arc, Leg, legs_through, turn_between
from airhilt.world.flight.starting import Start
from airhilt.world.flight.state import AircraftState, Atmosphere, InitialCondition, OnGround
from flights import COURSE, RUNWAY_ELEVATION_M, along_runway, make_runway
from stand_ins import StandIn, state_at

B737 = load_aircraft_type("737")
FPM = 0.3048 / 60.0
FLYING = InitialCondition(0.7, -1.3, 3_000.0, 1.0, 130.0)


class Flight:
    """A 737 of which nothing moves: what it is told is all that changes."""

    def __init__(self, initial: InitialCondition | OnGround = FLYING, **state: float) -> None:
        self.airframe, self.autopilot, self.ground = StandIn(), StandIn(), StandIn()
        self.airframe.answers["on_ground"] = isinstance(initial, OnGround)
        at = state_at((initial.latitude_rad, initial.longitude_rad), altitude_m=3_000.0,
                      track_rad=1.0, speed_m_s=130.0)._replace(**state)  # fmt: skip
        self.airframe.state = lambda: at  # type: ignore[attr-defined]
        airframe, autopilot = cast(Any, self.airframe), cast(Any, self.autopilot)
        systems = AircraftSystems(B737, airframe, autopilot, cast(Any, self.ground), 0.05)
        self.control = self.en_route = FlightControl(systems, initial, 30.0)
        self.procedures = ProcedureCommands(self.control)

    @property
    def phase(self) -> str:
        return self.control.phase.name

    def turn_rate(self) -> float:
        """Return the turn rate that is commanded, without the convergence of meridians."""
        state = self.control.state._replace(latitude_rad=0.0)
        return self.control.guidance.lateral.turn_rate(state)


# --- en route -----------------------------------------------------------------------------------


def test_a_flight_begins_on_its_track_at_its_altitude_and_airspeed() -> None:
    control = Flight().control
    assert control.phase is control.guidance
    assert control.guidance.vertical.clearance.altitude_m == 3_000.0
    assert control.guidance.speed.target_m_s == 130.0
    assert Flight().turn_rate() == pytest.approx(0.0)


def test_on_the_ground_it_stands_and_would_climb_on_its_heading() -> None:
    here = OnGround(0.7, -1.3, 1.0)
    assert Flight(here).phase == "standing"
    assert Flight(replace(here, lined_up=True)).phase == "lined_up"
    assert Flight(here).turn_rate() == pytest.approx(0.0)


@pytest.mark.parametrize("turn_deg", [30.0, -30.0, 270.0, -360.0, 360.0])
def test_it_turns_by_an_angle_from_its_track(turn_deg: float) -> None:
    flight = Flight()
    flight.en_route.turn_by(turn_deg * DEGREE)
    gain = B737.gains.guidance.course_per_s
    assert flight.turn_rate() == pytest.approx(gain * turn_deg * DEGREE)


def test_a_track_is_turned_to_by_the_shorter_side() -> None:
    flight = Flight()
    flight.en_route.hold_track(1.0 - 170.0 * DEGREE)
    assert flight.turn_rate() == pytest.approx(-0.12 * 170.0 * DEGREE)


@pytest.mark.parametrize(
    ("altitude_m", "rate_m_s", "expected"),
    [
        (5_000.0, 5.0, (5_000.0, 5.0)),
        (5_000.0, None, (5_000.0, 1_500.0 * FPM)),
        (1_000.0, 50.0, (1_000.0, 4_000.0 * FPM)),
        (20_000.0, 50.0, (41_000.0 * 0.3048, 4_000.0 * FPM)),
    ],
)
def test_an_altitude_is_accepted_as_far_as_the_type_can(
    altitude_m: float, rate_m_s: float | None, expected: tuple[float, float]
) -> None:
    flight = Flight()
    flight.en_route.hold_altitude(altitude_m, rate_m_s)
    assert flight.control.guidance.vertical.clearance == pytest.approx(expected)


@pytest.mark.parametrize(("altitude_m", "is_climb"), [(3_000.0, True), (2_999.9, False)])
def test_a_rate_is_limited_by_that_of_a_climb_or_of_a_descent(
    altitude_m: float, is_climb: bool
) -> None:
    flight = Flight()
    speeds = B737.speeds.model_copy(update={"maximum_descent_rate_fpm": 3_000.0})
    object.__setattr__(flight.control.modes, "kind", B737.model_copy(update={"speeds": speeds}))
    flight.en_route.hold_altitude(altitude_m, 100.0)
    accepted = flight.control.guidance.vertical.clearance
    assert accepted.vertical_rate_m_s / FPM == pytest.approx(4_000.0 if is_climb else 3_000.0)


@pytest.mark.parametrize(("asked_kt", "flown_kt"), [(250.0, 250.0), (100.0, 200.0), (500.0, 340.0)])
def test_a_speed_is_brought_into_the_limits_of_the_type(asked_kt: float, flown_kt: float) -> None:
    flight = Flight()
    flight.en_route.hold_speed(asked_kt * KNOT)
    assert flight.control.guidance.speed.target_m_s == pytest.approx(flown_kt * KNOT)


def test_a_speed_high_up_is_that_of_the_greatest_mach_number() -> None:
    high = Flight(altitude_m=11_500.0)
    limit_m_s = standard_atmosphere.calibrated_airspeed(B737.speeds.maximum_mach, 11_500.0)
    high.en_route.hold_speed(170.0)
    assert high.control.guidance.speed.target_m_s == pytest.approx(limit_m_s)
    assert limit_m_s < 150.0


def test_a_route_is_flown_left_and_resumed() -> None:
    flight = Flight()
    with pytest.raises(ValueError, match="no route to resume"):
        flight.en_route.resume_route()
    flight.en_route.fly_route([(0.71, -1.3)])
    route = flight.control.guidance.lateral
    flight.en_route.hold_track(2.0)
    assert flight.control.guidance.lateral is not route
    flight.en_route.resume_route()
    assert flight.control.guidance.lateral is route


def test_a_command_ends_an_approach_clean_and_level_on_its_track() -> None:
    flight = Flight()
    final = Final(make_runway("01"), B737)
    systems = flight.control.systems
    flight.control.phase = Glide(systems, final, (), 3_000.0, Preparation(systems))
    flight.en_route.hold_altitude(4_000.0)
    assert flight.phase == "en_route"
    assert "clean_up" in flight.airframe.got
    assert flight.turn_rate() == pytest.approx(0.0)
    assert flight.control.guidance.speed.target_m_s == pytest.approx(200.0 * KNOT)


# --- on the ground ------------------------------------------------------------------------------


def standing(**state: float) -> Flight:
    place = along_runway(60.0)
    track = {"velocity_north_m_s": 0.0, "velocity_east_m_s": 0.0, "altitude_m": RUNWAY_ELEVATION_M,
             "heading_rad": COURSE * DEGREE}  # fmt: skip
    return Flight(OnGround(*place, COURSE * DEGREE, lined_up=True), **{**track, **state})


@pytest.mark.parametrize(("speed_m_s", "is_refused"), [(20.0, False), (20.1, True)])
def test_a_taxi_or_a_takeoff_begins_at_20_m_s_at_most(speed_m_s: float, is_refused: bool) -> None:
    commands: tuple[Callable[[Flight], None], ...] = (
        lambda flight: flight.procedures.taxi([along_runway(200.0)]),
        lambda flight: flight.procedures.take_off(make_runway("01"), 500.0),
    )
    for command in commands:
        flight = standing(velocity_north_m_s=speed_m_s)
        if is_refused:
            with pytest.raises(ValueError, match="at 39 kt; expected at most 39 kt"):
                command(flight)
        else:
            command(flight)


def test_a_taxi_is_at_the_speed_of_the_type_unless_another_was_asked_for() -> None:
    for asked_m_s, expected_m_s in ((None, 15.0 * KNOT), (4.0, 4.0)):
        flight = standing()
        flight.procedures.taxi([along_runway(60.0 + 400.0)], asked_m_s)
        assert flight.phase == "taxi"
        phase = flight.control.phase
        assert isinstance(phase, Taxi)
        phase.fly(flight.control.state)
        assert flight.ground.got["hold_speed"][1] == pytest.approx(expected_m_s)


def test_who_is_to_be_lined_up_lines_up_and_an_empty_path_is_refused() -> None:
    flight = standing()
    flight.procedures.taxi([along_runway(200.0)], then="lined_up")
    assert flight.phase == "line_up"
    with pytest.raises(ValueError, match="the path is empty"):
        flight.procedures.taxi([])


def test_who_stands_may_be_told_to_hold_and_only_who_taxies_goes_on() -> None:
    flight = standing()
    flight.procedures.hold_position()
    assert flight.phase == "lined_up"
    with pytest.raises(ValueError, match="resume_taxi in phase lined_up"):
        flight.procedures.resume_taxi()


@pytest.mark.parametrize(("climb_to_m", "is_refused"), [(4.0, True), (4.1, False)])
def test_a_takeoff_is_to_an_altitude_above(climb_to_m: float, is_refused: bool) -> None:
    flight = standing()
    if is_refused:
        with pytest.raises(ValueError, match="climb_to_m is 4; expected more than the altitude"):
            flight.procedures.take_off(make_runway("01"), climb_to_m)
    else:
        flight.procedures.take_off(make_runway("01"), climb_to_m)
        assert flight.phase == "takeoff_roll"
        assert flight.control.guidance.vertical.clearance.altitude_m == pytest.approx(climb_to_m)


def test_who_is_beside_the_runway_or_too_low_for_a_side_step_is_told_so() -> None:
    with pytest.raises(ValueError, match="60 m beside the centre line of runway 01R"):
        standing().procedures.take_off(make_runway("01R", 60.0), 500.0)
    low = Flight()
    low.control.state = on_final(1_000.0, height_m=60.0)
    low.procedures.land(make_runway("01"))
    with pytest.raises(ValueError, match="expected at least 300 ft"):
        low.procedures.side_step(make_runway("01R", 400.0))


# --- in the air ---------------------------------------------------------------------------------


@pytest.mark.parametrize(("altitude_m", "is_refused"), [(3_000.0, True), (2_999.9, False)])
def test_an_emergency_descent_is_to_an_altitude_below(altitude_m: float, is_refused: bool) -> None:
    flight = Flight()
    if is_refused:
        with pytest.raises(ValueError, match="altitude_m is 3000; expected less"):
            flight.procedures.emergency_descent(altitude_m)
    else:
        flight.procedures.emergency_descent(altitude_m)
        assert flight.phase == "emergency_descent"
        clearance = flight.control.guidance.vertical.clearance
        assert clearance == pytest.approx((altitude_m, 4_000.0 * FPM))
        assert "clean_up" in flight.airframe.got


def test_a_drift_down_descends_at_its_speed_to_below_all_terrain() -> None:
    flight = Flight()
    flight.procedures.drift_down()
    assert flight.phase == "drift_down"
    en_route = flight.control.guidance
    assert en_route.speed.target_m_s == pytest.approx(B737.speeds.drift_down_kt * KNOT)
    # The shore of the Dead Sea is 430 m below sea level.
    assert en_route.vertical.clearance.altitude_m < -430.0
    assert "clean_up" in flight.airframe.got


def on_final(before_m: float, right_m: float = 0.0, off_deg: float = 0.0,
             height_m: float = 300.0) -> AircraftState:  # fmt: skip
    place = along_runway(-before_m, right_m)
    return state_at(place, altitude_m=RUNWAY_ELEVATION_M + height_m,
                    track_rad=(COURSE + off_deg) * DEGREE)  # fmt: skip


@pytest.mark.parametrize(
    ("state", "refusal"),
    [
        (on_final(5_000.0), None),
        (on_final(5_000.0, 4_990.0), None),
        (on_final(5_000.0, 5_010.0), "45 degrees off the final approach course"),
        (on_final(5_000.0, -5_010.0), "45 degrees off the final approach course"),
        (on_final(46_280.0), None),  # 25 NM are 46,300 m.
        (on_final(46_320.0), "25 NM away; expected at most 25 NM"),
        (on_final(5_000.0, 0.0, 89.0), None),
        (on_final(5_000.0, 0.0, -91.0), "91 degrees off its course; expected at most 90"),
        (on_final(1.0), None),
        (on_final(-1.0), "the threshold of runway 01 is 1 m behind"),
    ],
)
def test_a_final_approach_is_joined_from_where_it_can_be(
    state: AircraftState, refusal: str | None
) -> None:
    flight = Flight()
    flight.control.state = state
    if refusal is None:
        flight.procedures.land(make_runway("01"))
    else:
        with pytest.raises(ValueError, match=refusal):
            flight.procedures.land(make_runway("01"))


@pytest.mark.parametrize(("above_m", "correction_m_s"), [(2.0, -0.3), (-2.0, 0.3), (90.0, -4.572),
                                                         (-90.0, 4.572)])  # fmt: skip
def test_the_glide_path_is_regained_by_0_15_of_what_is_missing_and_15_ft_s_at_most(
    above_m: float, correction_m_s: float
) -> None:
    final = Final(make_runway("01"), B737)
    state = on_final(5_000.0)
    on_path_m = state.altitude_m - final.above_glide_path_m(state)
    off = state._replace(altitude_m=on_path_m + above_m)
    rate_m_s = -70.0 * math.tan(3.0 * DEGREE)
    assert final.glide_rate(off) == pytest.approx(rate_m_s)
    assert final.vertical_rate(off) == pytest.approx(rate_m_s + correction_m_s)


def test_the_course_is_joined_by_30_degrees_at_most() -> None:
    final = Final(make_runway("01"), B737)
    for side in (1.0, -1.0):
        joining = on_final(9_000.0, side * 3_000.0, -side * 30.0)
        assert final.turn_rate(joining) == pytest.approx(0.0, abs=2e-4)


def test_landing_it_is_led_to_the_runway_at_approach_speed() -> None:
    flight = Flight()
    flight.control.state = on_final(9_000.0)
    flight.procedures.land(make_runway("01"))
    assert flight.phase == "glide"
    en_route = flight.control.guidance
    assert en_route.speed.target_m_s == pytest.approx(B737.speeds.approach_kt * KNOT)
    assert en_route.vertical.clearance == pytest.approx((RUNWAY_ELEVATION_M, 1_500.0 * FPM))


def test_rolling_out_nobody_goes_around() -> None:
    flight = standing()
    final = cast(Any, Final(make_runway("01"), B737))
    flight.control.phase = Rollout(flight.control.systems, final, ())
    with pytest.raises(ValueError, match="go_around in phase rollout; expected glide or flare"):
        flight.procedures.go_around(500.0)


# --- where it begins ----------------------------------------------------------------------------


class Steps(StandIn):
    """An airframe that counts its steps between two settings of the throttle."""

    def __init__(self) -> None:
        super().__init__(dynamic_pressure_pa=5_000.0, load_factor=1.0)
        self.steps: list[int] = [0]

    def step(self) -> None:
        self.steps[-1] += 1

    def set_throttle(self, lever: float) -> None:
        assert lever == 0.0
        self.steps.append(0)

    def state(self) -> AircraftState:
        return state_at()


@pytest.mark.parametrize(("tick_s", "substeps"), [(0.05, 6), (0.1, 10)])
def test_engines_start_for_5_s_and_idle_for_15_before_a_start_on_the_ground(
    tick_s: float, substeps: int
) -> None:
    airframe = Steps()
    start = Start(cast(Any, airframe), B737, tick_s, substeps)
    start.begin(OnGround(0.7, -1.3, 0.0), Atmosphere(), 0.0)
    starting, idling, rest = airframe.steps
    assert (starting, idling, rest) == (
        round(5.0 / tick_s) * substeps, round(15.0 / tick_s) * substeps, 0,
    )  # fmt: skip
    assert airframe.got["set_brakes"] == (1.0,)
    assert "crank" not in airframe.got


@pytest.mark.parametrize(
    ("altitude_m", "speed_kt", "on_approach", "refusal"),
    [
        (30.1, 250.0, False, None),
        (30.0, 250.0, False, "altitude_m is 30; expected between the terrain at 30 m"),
        (12_496.8, 210.0, False, None),
        (12_496.9, 210.0, False, "the service ceiling of 737 at 12497 m"),
        (3_000.0, 200.0, False, None),
        (3_000.0, 199.9, False, "calibrated_airspeed_m_s"),
        (3_000.0, 340.0, False, None),
        (3_000.0, 340.1, False, "calibrated_airspeed_m_s"),
        (3_000.0, 143.0, True, None),
        (3_000.0, 142.9, True, "calibrated_airspeed_m_s"),
    ],
)
def test_it_may_begin_within_the_envelope_of_its_type(
    altitude_m: float, speed_kt: float, on_approach: bool, refusal: str | None
) -> None:
    """Clean from its slowest clean speed on, and on approach from approach speed."""
    start = Start(cast(Any, StandIn()), B737, 0.05, 6)
    initial = InitialCondition(0.7, -1.3, altitude_m, 0.0, speed_kt * KNOT, 0.0, on_approach)
    if refusal is None:
        start._require_inside_envelope(initial, 30.0)
    else:
        with pytest.raises(ValueError, match=refusal):
            start.begin(initial, Atmosphere(), 30.0)


# --- routes -------------------------------------------------------------------------------------


def away(north_m: float, east_m: float = 0.0) -> Place:
    """Return a place near the equator, so many metres from 0 N 0 E."""
    return north_m / 110_574.0 * DEGREE, east_m / 111_320.0 * DEGREE


@pytest.mark.parametrize(("distance_m", "pieces"), [(99_000.0, 1), (101_000.0, 2), (250_000.0, 3)])
def test_a_leg_of_more_than_100_km_is_divided_evenly(distance_m: float, pieces: int) -> None:
    legs = legs_through((0.0, 0.0), [away(distance_m)])
    assert [leg.length_m for leg in legs] == pytest.approx([distance_m / pieces] * pieces, rel=1e-3)
    assert legs[-1].end == away(distance_m)


@pytest.mark.parametrize(("distance_m", "count"), [(49.0, 1), (51.0, 2)])
def test_waypoints_nearer_than_50_m_are_one(distance_m: float, count: int) -> None:
    assert len(legs_through((0.0, 0.0), [away(5_000.0), away(5_000.0 + distance_m)])) == count


def test_a_route_leads_somewhere_on_earth() -> None:
    with pytest.raises(ValueError, match="leads nowhere"):
        legs_through((0.0, 0.0), [away(10.0)])
    pole = legs_through(away(0.0), [(math.pi / 2.0, 0.0)])
    assert pole[-1].end == (math.pi / 2.0, 0.0)


@pytest.mark.parametrize("turn_deg", [30.0, -30.0, 90.0, -90.0, 170.0])
def test_the_arc_between_two_legs_touches_both(turn_deg: float) -> None:
    """Its centre is a radius abeam of where it begins on the one and ends on the other."""
    angle, lead_m = turn_deg * DEGREE, 2_000.0
    before = Leg(away(-20_000.0), away(0.0))
    after = Leg(away(0.0), away(20_000.0 * math.cos(angle), 20_000.0 * math.sin(angle)))
    assert turn_between(before, after) == pytest.approx(angle, abs=2e-3)
    arc, side = Arc(before, after, lead_m), math.copysign(1.0, turn_deg)
    radius_m = lead_m / math.tan(abs(angle) / 2.0)
    assert arc.radius_m == pytest.approx(radius_m, rel=5e-3)
    ends = (
        (away(-lead_m), 0.0, 2.0 * lead_m),
        (away(lead_m * math.cos(angle), lead_m * math.sin(angle)), angle, 0.0),
    )
    for place, course, _ in ends:
        guide = arc.guide(state_at(place, altitude_m=0.0, speed_m_s=100.0))
        assert guide.cross_track_m == pytest.approx(0.0, abs=20.0)
        assert math.remainder(guide.course_rad - course, math.tau) == pytest.approx(0.0, abs=0.01)
        assert guide.turn_rate == pytest.approx(side * 100.0 / radius_m, rel=5e-3)
    last = state_at(ends[1][0], altitude_m=0.0)
    assert arc.to_go_m(last) == pytest.approx(0.0, abs=20.0)
    # Outside of the circle is to the left of a right turn.
    outside = state_at(away(0.0), altitude_m=0.0)
    assert arc.guide(outside).cross_track_m * side < -50.0


# --- the guard ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "ends"),
    [
        ({"height_agl_m": 4.99, "calibrated_airspeed_m_s": 10.0}, False),
        ({"height_agl_m": 5.0, "calibrated_airspeed_m_s": 10.0}, True),
        ({"height_agl_m": -0.99}, False),
        ({"height_agl_m": -1.0}, True),
    ],
)
def test_who_may_touch_need_not_keep_flying_speed_below_5_m(
    change: dict[str, float], ends: bool
) -> None:
    state = state_at(altitude_m=100.0, speed_m_s=130.0)._replace(**change)
    assert (FlightGuard(B737).check(state, may_touch=True) is not None) is ends


@pytest.mark.parametrize(
    ("change", "ends"),
    [
        ({"velocity_down_m_s": 3.65}, False),
        ({"velocity_down_m_s": 3.66}, True),  # 12 ft/s (14 CFR 25.723).
        ({"roll_rad": 12.9 * DEGREE}, False),
        ({"roll_rad": -13.1 * DEGREE}, True),
        ({"pitch_rad": 14.6 * DEGREE}, False),
        ({"pitch_rad": 14.8 * DEGREE}, True),
    ],
)
def test_wheels_touch_softly_and_alone(change: dict[str, float], ends: bool) -> None:
    state = state_at(altitude_m=0.5, speed_m_s=60.0)._replace(**change)
    guard = FlightGuard(B737)
    assert (guard.check(state, may_touch=True, on_ground=True) is not None) is ends
    assert guard.check(state, may_touch=True, on_ground=False) is None
    assert guard.check(state, may_touch=False, on_ground=True) == "ground_contact"


@pytest.mark.parametrize(
    ("change", "is_inside"),
    [
        ({"roll_rad": 74.9 * DEGREE}, True),
        ({"roll_rad": -75.1 * DEGREE}, False),
        ({"pitch_rad": -44.9 * DEGREE}, True),
        ({"pitch_rad": 45.1 * DEGREE}, False),
        ({"calibrated_airspeed_m_s": 93.0 * KNOT}, True),  # 0.65 of 143 kt.
        ({"calibrated_airspeed_m_s": 92.9 * KNOT}, False),
        ({"calibrated_airspeed_m_s": 390.9 * KNOT}, True),  # 1.15 of 340 kt.
        ({"calibrated_airspeed_m_s": 391.1 * KNOT}, False),
        ({"mach": 0.889}, True),
        ({"mach": 0.891}, False),
        ({"velocity_down_m_s": 11_999.0 * FPM}, True),
        ({"velocity_down_m_s": 12_001.0 * FPM}, False),
        ({"height_agl_m": 0.01}, True),
        ({"height_agl_m": 0.0}, False),
    ],
)
def test_a_flight_goes_on_within_its_envelope(change: dict[str, float], is_inside: bool) -> None:
    state = state_at(altitude_m=3_000.0, speed_m_s=130.0)._replace(**change)
    assert (FlightGuard(B737).check(state) is None) is is_inside
