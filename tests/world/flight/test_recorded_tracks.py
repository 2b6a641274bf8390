"""Aircraft on recorded tracks: they fly the record until a command takes them off it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.geodesy.wgs84 import Place, displaced, distance_m, onward
from airhilt.units import DEGREE, FOOT, KNOT, STANDARD_GRAVITY, wrap_angle
from airhilt.world.flight import Aircraft, AircraftState, Atmosphere, load_aircraft_type
from airhilt.world.flight.track import TrackPoint, track_problems
from airhilt.world.mover import NOT_BEGUN, TRACK_ENDED
from breadth import examples

B737 = load_aircraft_type("737")
HERE = (47.0 * DEGREE, 8.0 * DEGREE)
TICK_S = 0.05


def straight(
    length_s: float = 200.0,
    *,
    begin_s: float = 0.0,
    speed_m_s: float = 220.0,
    altitude_m: float | None = 9_000.0,
    climb_m_s: float = 0.0,
    track_deg: float = 60.0,
) -> tuple[TrackPoint, ...]:
    """Return the points of a straight flight, every 5 s; on the ground without an altitude."""
    return tuple(
        TrackPoint(
            begin_s + t_s,
            *onward(HERE, track_deg * DEGREE, speed_m_s * t_s),
            None if altitude_m is None else altitude_m + climb_m_s * t_s,
        )
        for t_s in (5.0 * step for step in range(round(length_s / 5.0) + 1))
    )


def circle(speed_m_s: float, rate_rad_s: float) -> tuple[TrackPoint, ...]:
    """Return the points of a turn to the right at a rate, every 4 s for two minutes."""
    radius_m = speed_m_s / rate_rad_s
    turned = (rate_rad_s * 4.0 * step for step in range(31))
    return tuple(
        TrackPoint(
            4.0 * step,
            *displaced(HERE, radius_m * math.sin(angle), radius_m * (1.0 - math.cos(angle))),
            3_000.0,
        )
        for step, angle in enumerate(turned)
    )


def on(points: tuple[TrackPoint, ...], atmosphere: Atmosphere | None = None) -> Aircraft:
    return Aircraft(B737, points, seed=1, atmosphere=atmosphere or Atmosphere())


def flown(aircraft: Aircraft, time_s: float) -> Iterator[AircraftState]:
    for _ in range(round(time_s / TICK_S)):
        aircraft.advance()
        yield aircraft.state


def after(aircraft: Aircraft, time_s: float) -> AircraftState:
    *_, last = flown(aircraft, time_s)
    return last


STEPS = st.tuples(
    st.floats(1.0, 30.0), st.floats(-150.0, 150.0), st.floats(-150.0, 150.0), st.floats(-10.0, 10.0)
)


@given(st.lists(STEPS, min_size=1, max_size=8))
@examples(30)
def test_every_point_of_a_record_is_flown_over_at_its_time(
    steps: list[tuple[float, float, float, float]],
) -> None:
    points = [TrackPoint(0.0, *HERE, 6_000.0)]
    for passed_s, north_m_s, east_m_s, climb_m_s in steps:
        last = points[-1]
        place = displaced(last.place, north_m_s * passed_s, east_m_s * passed_s)
        altitude_m = (last.altitude_m or 0.0) + climb_m_s * passed_s
        points.append(TrackPoint(last.t_s + passed_s, *place, altitude_m))
    aircraft = on(tuple(points))
    states = [aircraft.state, *flown(aircraft, points[-1].t_s)]
    for point in points[:-1]:
        state = states[round(point.t_s / TICK_S)]
        least_m = state.ground_speed_m_s * TICK_S + 1.0
        assert distance_m(state.place, point.place) < least_m
        assert state.altitude_m == pytest.approx(point.altitude_m, abs=1.0)


def test_velocity_and_attitude_follow_from_the_motion() -> None:
    """A wind from the left turns the nose to the left; a climb raises it."""
    wind = Atmosphere(wind_north_m_s=0.0, wind_east_m_s=20.0)
    aircraft = on(straight(climb_m_s=8.0, track_deg=0.0), wind)
    state = after(aircraft, 50.0)
    assert state.ground_speed_m_s == pytest.approx(220.0, abs=0.5)
    assert state.vertical_rate_m_s == pytest.approx(8.0, abs=0.01)
    assert state.pitch_rad == pytest.approx(math.atan(8.0 / 220.0), abs=1e-3)
    assert wrap_angle(state.heading_rad) == pytest.approx(-math.atan(20.0 / 220.0), abs=2e-3)
    assert state.true_airspeed_m_s == pytest.approx(math.hypot(220.0, 20.0, 8.0), abs=0.5)
    assert state.roll_rad == pytest.approx(0.0, abs=1e-3)


def test_the_bank_is_that_of_a_coordinated_turn_and_has_no_steps() -> None:
    speed, rate = 150.0, math.radians(2.0)
    states = list(flown(on(circle(speed, rate)), 110.0))[200:]
    banks = [state.roll_rad for state in states]
    wanted = math.atan(speed * rate / STANDARD_GRAVITY)
    assert banks == pytest.approx([wanted] * len(banks), abs=math.radians(1.0))
    assert max(abs(b - a) for a, b in pairwise(banks)) < math.radians(0.5)


def test_a_track_begins_and_ends_with_its_record() -> None:
    aircraft = on(straight(10.0, begin_s=5.0))
    assert aircraft.ended == NOT_BEGUN
    after(aircraft, 4.9)
    assert aircraft.ended == NOT_BEGUN
    after(aircraft, 0.2)
    assert (aircraft.ended, aircraft.phase) == (None, "on_track")
    last = after(aircraft, 10.0)
    assert aircraft.ended == TRACK_ENDED
    assert after(aircraft, 1.0) == last


def test_a_record_that_ends_on_the_ground_leaves_the_aircraft_there() -> None:
    aircraft = on(straight(10.0, speed_m_s=5.0, altitude_m=None))
    state = after(aircraft, 20.0)
    assert (aircraft.ended, aircraft.on_ground) == (None, True)
    assert (state.ground_speed_m_s, state.height_agl_m) == (0.0, 0.0)


def test_the_target_altitude_is_that_at_which_the_climb_of_the_record_ends() -> None:
    climb = straight(100.0, climb_m_s=8.0)
    level = [point._replace(t_s=point.t_s + 100.0, altitude_m=9_800.0) for point in straight()[1:]]
    level = [p._replace(latitude_rad=p.latitude_rad + 0.003) for p in level]
    aircraft = on((*climb, *level))
    after(aircraft, 50.0)
    assert aircraft.target_altitude_m == pytest.approx(9_800.0)
    assert aircraft.target_vertical_rate_m_s == pytest.approx(8.0, abs=0.01)


# --- off the track ------------------------------------------------------------------------------


@pytest.mark.parametrize("wind_m_s", [0.0, 30.0])
def test_a_command_takes_an_aircraft_off_its_track_without_a_jump(wind_m_s: float) -> None:
    aircraft = on(circle(150.0, math.radians(1.5)), Atmosphere(wind_east_m_s=wind_m_s))
    before = after(aircraft, 30.0)
    aircraft.en_route.hold_altitude(before.altitude_m + 300.0)
    left = after(aircraft, TICK_S)
    assert aircraft.phase == "en_route"
    assert distance_m(before.place, left.place) < 2.0 * before.ground_speed_m_s * TICK_S
    for name in ("velocity_north_m_s", "velocity_east_m_s", "velocity_down_m_s"):
        assert getattr(left, name) == pytest.approx(getattr(before, name), abs=3.0)
    assert left.roll_rad == pytest.approx(before.roll_rad, abs=math.radians(2.0))
    assert after(aircraft, 90.0).altitude_m == pytest.approx(before.altitude_m + 300.0, abs=20.0)
    assert aircraft.ended is None


def test_an_aircraft_off_its_track_flies_on_along_the_rest_of_it() -> None:
    points = straight(400.0)
    aircraft = on(points)
    state = after(aircraft, 20.0)
    aircraft.en_route.hold_altitude(state.altitude_m + 600.0)
    state = after(aircraft, 180.0)
    assert from_line_m(state.place) < 100.0
    assert aircraft.en_route.waypoints_ahead[-1] == points[-1].place


def test_an_aircraft_that_was_turned_goes_back_to_the_rest_of_its_track() -> None:
    aircraft = on(straight(600.0))
    after(aircraft, 20.0)
    aircraft.en_route.turn_by(30.0 * DEGREE)
    assert from_line_m(after(aircraft, 60.0).place) > 2_000.0
    aircraft.en_route.resume_route()
    assert from_line_m(after(aircraft, 240.0).place) < 100.0


def from_line_m(place: Place) -> float:
    """Return the distance of a place from the straight track."""
    away_m = distance_m(HERE, place)
    return distance_m(place, onward(HERE, 60.0 * DEGREE, away_m))


def test_a_speed_outside_the_envelope_is_put_down_to_the_wind() -> None:
    """A jet stream carries the aircraft: its ground speed stays, its Mach number is its type's."""
    aircraft = on(straight(speed_m_s=320.0, altitude_m=10_500.0))
    before = after(aircraft, 20.0)
    assert before.mach > 1.0
    aircraft.en_route.hold_altitude(before.altitude_m - 300.0)
    state = after(aircraft, 1.0)
    assert state.ground_speed_m_s == pytest.approx(before.ground_speed_m_s, abs=2.0)
    assert state.mach == pytest.approx(B737.speeds.maximum_mach, abs=0.01)
    after(aircraft, 60.0)
    assert aircraft.ended is None


def test_an_arrival_on_its_track_goes_around() -> None:
    aircraft = on(straight(120.0, speed_m_s=75.0, altitude_m=500.0, climb_m_s=-3.8))
    before = after(aircraft, 60.0)
    aircraft.procedures.go_around(900.0)
    assert aircraft.phase == "go_around"
    state = after(aircraft, 90.0)
    assert state.altitude_m > before.altitude_m + 300.0
    assert aircraft.ended is None


def test_an_aircraft_that_rolls_on_its_track_takes_no_command() -> None:
    aircraft = on(straight(speed_m_s=8.0, altitude_m=None))
    after(aircraft, 20.0)
    with pytest.raises(ValueError, match="on the ground"):
        aircraft.en_route.hold_altitude(3_000.0)
    with pytest.raises(ValueError, match="on the ground"):
        aircraft.procedures.taxi([onward(HERE, 0.0, 300.0)])
    assert aircraft.phase == "on_track"


def test_the_same_track_gives_the_same_flight_on_it_and_off_it() -> None:
    def states() -> list[AircraftState]:
        aircraft = on(circle(150.0, math.radians(1.0)))
        found = list(flown(aircraft, 20.0))
        aircraft.en_route.hold_track(0.0)
        return found + list(flown(aircraft, 20.0))

    assert states() == states()


# --- what cannot be flown -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"t_s": 4.0}, "time"),
        ({"t_s": 5.0}, "time"),
        ({"latitude_rad": HERE[0] + 0.01}, "position"),
        ({"altitude_m": 9_000.0 + 5_000.0 * FOOT}, "altitude"),
    ],
)
def test_a_point_that_cannot_be_flown_to_is_named(changes: dict[str, float], field: str) -> None:
    points = list(straight(50.0))
    points[2] = points[2]._replace(**changes)
    (problem,) = track_problems(points)
    assert (problem.number, problem.field) == (2, field)


def test_a_fast_flight_is_no_problem() -> None:
    assert list(track_problems(straight(speed_m_s=700.0 * KNOT))) == []
