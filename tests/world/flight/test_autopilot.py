"""The autopilot by itself: what its loops ask of elevator, ailerons and rudder."""

from __future__ import annotations

import math
from typing import Any, cast

import pytest

from airhilt.units import DEGREE
from airhilt.world.flight import load_aircraft_type
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.autopilot import Autopilot
from airhilt.world.flight.state import AircraftState
from stand_ins import StandIn, state_at

B737 = load_aircraft_type("737")
PRESSURE_PA = B737.gains.pitch.reference_pressure_pa
TICKS = pytest.mark.parametrize("tick_s", [0.1, 0.05, 0.025])


def level(**answers: float) -> StandIn:
    """Return an airframe in level flight at the pressure that its gains are made for."""
    steady = {"dynamic_pressure_pa": PRESSURE_PA, "load_factor": 1.0, "throttle": 0.5}
    return StandIn(**(steady | answers))


def autopilot(
    airframe: StandIn, state: AircraftState, tick_s: float = 0.05, kind: AircraftType = B737
) -> Autopilot:
    return Autopilot(cast(Any, airframe), kind, tick_s, state)


@pytest.mark.parametrize("pitch_deg", [1.0, 3.0, 6.0])
def test_in_steady_flight_it_leaves_the_elevator_where_it_is(pitch_deg: float) -> None:
    airframe = level(angle_of_attack=pitch_deg * DEGREE, elevator=-0.1)
    state = state_at(speed_m_s=120.0, pitch_rad=pitch_deg * DEGREE)
    flying = autopilot(airframe, state)
    for _ in range(20):
        flying.fly(state, 0.0, 0.0, state.calibrated_airspeed_m_s)
        assert airframe.got["set_elevator"] == pytest.approx((-0.1,))


@TICKS
def test_the_bank_that_it_asks_for_grows_at_the_rate_of_the_type(tick_s: float) -> None:
    roll = B737.gains.roll.model_copy(update={"rate_integral": 0.0})
    kind = B737.model_copy(update={"gains": B737.gains.model_copy(update={"roll": roll})})
    airframe, state = level(), state_at(speed_m_s=120.0)
    turning = autopilot(airframe, state, tick_s, kind)
    for _ in range(round(0.4 / tick_s)):
        turning.fly(state, 0.05, 0.0, state.calibrated_airspeed_m_s)
    wanted = roll.bank_per_s * 0.4 * roll.bank_rate_limit_deg_s * DEGREE
    assert airframe.got["set_aileron"] == pytest.approx((roll.rate_s * wanted,))


@TICKS
def test_what_a_sideslip_does_to_the_rudder_in_a_second_does_not_depend_on_ticks(
    tick_s: float,
) -> None:
    airframe, state = level(sideslip=0.02), state_at(speed_m_s=120.0)
    flying = autopilot(airframe, state, tick_s)
    for _ in range(round(1.0 / tick_s)):
        flying.fly(state, 0.0, 0.0, state.calibrated_airspeed_m_s)
    yaw = B737.gains.yaw
    expected = -(yaw.sideslip + yaw.sideslip_integral_per_s * 1.0) * 0.02
    assert airframe.got["set_rudder"] == pytest.approx((expected,))


@pytest.mark.parametrize("up", [1.0, -1.0])
def test_an_elevator_at_its_stop_winds_nothing_up(up: float) -> None:
    """An error of half a radian a second, and as much from its integral, reach just the stop."""
    pitch = B737.gains.pitch.model_copy(update={"rate_s": 1.0, "rate_integral": 16.0})
    kind = B737.model_copy(update={"gains": B737.gains.model_copy(update={"pitch": pitch})})
    airframe, state = level(), state_at(speed_m_s=120.0)
    rotating = autopilot(airframe, state, tick_s=1.0 / 16.0, kind=kind)
    airframe.answers["pitch_rate"] = up * 0.5
    rotating.rotate(state, 0.0, 0.1, None, 1.0)
    assert airframe.got["set_elevator"] == (up,)
    airframe.answers["pitch_rate"] = 0.0
    rotating.rotate(state, 0.0, 0.1, None, 1.0)
    assert airframe.got["set_elevator"] == (0.0,)


@pytest.mark.parametrize(("part", "scale"), [(4.0, 0.25), (1.0, 1.0), (0.3, 1 / 0.3), (0.1, 4.0),
                                             (0.0, 4.0)])  # fmt: skip
def test_surfaces_move_more_at_low_pressure_up_to_four_times(part: float, scale: float) -> None:
    airframe = level(dynamic_pressure_pa=part * PRESSURE_PA)
    state = state_at(speed_m_s=120.0)
    flying = autopilot(airframe, state)
    airframe.answers["pitch_rate"] = 0.01
    flying.rotate(state, 0.0, 0.1, None, 1.0)
    pitch = B737.gains.pitch
    expected = scale * (pitch.rate_s + pitch.rate_integral * 0.05) * 0.01
    assert airframe.got["set_elevator"] == pytest.approx((expected,))


@pytest.mark.parametrize(
    ("load_factor", "is_learned"),
    [(-1.0, False), (0.0, False), (0.4, False), (0.5, False), (0.51, True), (1.0, True)],
)
def test_with_little_load_the_angle_of_attack_says_nothing_about_level_flight(
    load_factor: float, is_learned: bool
) -> None:
    airframe = level(angle_of_attack=3.0 * DEGREE, elevator=-0.1)
    state = state_at(speed_m_s=120.0, pitch_rad=3.0 * DEGREE)
    flying = autopilot(airframe, state)
    airframe.answers |= {"angle_of_attack": 9.0 * DEGREE, "load_factor": load_factor}
    for _ in range(20):
        flying.fly(state, 0.0, 0.0, state.calibrated_airspeed_m_s)
    (elevator,) = airframe.got["set_elevator"]
    assert (elevator < -0.11) is is_learned  # More angle of attack: the nose goes up.
    assert is_learned or elevator == pytest.approx(-0.1)


@pytest.mark.parametrize(("too_fast_m_s", "stop"), [(40.0, 0.0), (-40.0, 1.0)])
def test_a_lever_at_its_stop_winds_nothing_up(too_fast_m_s: float, stop: float) -> None:
    """It goes back to where it was, once the airspeed is right again."""
    airframe, right = level(throttle=0.5), state_at(speed_m_s=120.0)
    flying = autopilot(airframe, right)
    for _ in range(600):
        flying.fly(state_at(speed_m_s=120.0 + too_fast_m_s), 0.0, 0.0, 120.0)
    assert airframe.got["set_throttle"] == (stop,)
    for _ in range(600):
        flying.fly(right, 0.0, 0.0, 120.0)
    assert airframe.got["set_throttle"] == pytest.approx((0.5,), abs=0.02)


def test_the_lever_moves_at_its_own_rate() -> None:
    airframe, state = level(throttle=0.5), state_at(speed_m_s=120.0)
    flying = autopilot(airframe, state, 0.1)
    step = B737.gains.thrust.lever_rate_per_s * 0.1
    for count in (1, 2, 3):
        flying.fly_on_pitch(state, 0.0, 120.0, 1.0)
        assert airframe.got["set_throttle"] == pytest.approx((0.5 + count * step,))
        assert flying.lever == pytest.approx(0.5 + count * step)


@pytest.mark.parametrize("turn_rate", [0.02, -0.02])
def test_it_banks_to_the_side_of_the_turn_and_by_its_rate(turn_rate: float) -> None:
    """Where the bank is the tangent of v / g for the turn rate it leaves the ailerons alone. At the
    equator the Earth's own turn is nothing."""
    bank = math.atan(turn_rate * 120.0 / 9.80665)
    airframe, state = level(), state_at(speed_m_s=120.0, roll_rad=bank)
    flying = autopilot(airframe, state)
    for _ in range(20):
        flying.fly(state, turn_rate, 0.0, 120.0)
        assert airframe.got["set_aileron"] == pytest.approx((0.0,), abs=1e-12)
    flying.fly(state, 1.5 * turn_rate, 0.0, 120.0)
    assert airframe.got["set_aileron"][0] * turn_rate > 0.0


def test_no_bank_is_steeper_than_that_of_the_type() -> None:
    limit = B737.gains.roll.bank_limit_deg * DEGREE
    for side in (1.0, -1.0):
        airframe, state = level(), state_at(speed_m_s=120.0, roll_rad=side * limit)
        flying = autopilot(airframe, state)
        flying.fly(state, side * 0.5, 0.0, 120.0)
        assert airframe.got["set_aileron"] == pytest.approx((0.0,), abs=1e-12)


@pytest.mark.parametrize("latitude_deg", [0.0, 47.0, -60.0])
def test_level_wings_turn_with_the_earth(latitude_deg: float) -> None:
    """Twice 7.2921e-5 rad/s times the sine of the latitude (Coriolis)."""
    turn_rate = 2.0 * 7.292115e-5 * math.sin(latitude_deg * DEGREE)
    airframe = level()
    state = state_at((latitude_deg * DEGREE, 0.0), speed_m_s=120.0)
    flying = autopilot(airframe, state)
    flying.fly(state, turn_rate, 0.0, 120.0)
    assert airframe.got["set_aileron"] == pytest.approx((0.0,), abs=1e-9)


@pytest.mark.parametrize(("roll_deg", "pitch_deg"), [(0.0, 0.0), (25.0, 0.0), (-20.0, 10.0)])
def test_a_coordinated_turn_needs_no_rudder(roll_deg: float, pitch_deg: float) -> None:
    """Its yaw rate is g / v times the sine of the bank and the cosine of the pitch."""
    roll, pitch = roll_deg * DEGREE, pitch_deg * DEGREE
    yaw_rate = 9.80665 / 120.0 * math.sin(roll) * math.cos(pitch)
    airframe = level(yaw_rate=yaw_rate)
    state = state_at(speed_m_s=120.0, roll_rad=roll, pitch_rad=pitch)
    autopilot(airframe, state).fly(state, 0.0, 0.0, 120.0)
    assert airframe.got["set_rudder"] == pytest.approx((0.0,), abs=1e-12)
