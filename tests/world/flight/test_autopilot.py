"""The autopilot by itself: what its loops ask of elevator, ailerons and rudder."""

from __future__ import annotations

import math
from collections.abc import Callable
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
    state = state_at(speed_m_s=120.0, pitch_rad=3.0 * DEGREE)
    elevators: list[float] = []
    for angle_of_attack_deg in (3.0, 9.0):
        airframe = level(angle_of_attack=3.0 * DEGREE, elevator=-0.1)
        flying = autopilot(airframe, state)
        airframe.answers |= {
            "angle_of_attack": angle_of_attack_deg * DEGREE, "load_factor": load_factor
        }  # fmt: skip
        flying.fly(state, 0.0, 0.0, state.calibrated_airspeed_m_s)
        elevators += airframe.got["set_elevator"]
    before, after = elevators
    # More angle of attack: the nose goes up.
    assert after < before if is_learned else after == before


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


# --- the lever holds the airspeed ---------------------------------------------------------------

THRUST = B737.gains.thrust


@TICKS
def test_the_lever_follows_an_airspeed_that_is_reached_with_a_lag_of_8_s(tick_s: float) -> None:
    """It is proportional to what is missing now, and to the sum of that."""
    wanted_m_s, seconds = 1.2, 4.0
    airframe, state = level(throttle=0.5), state_at(speed_m_s=120.0)
    flying = autopilot(airframe, state, tick_s)
    for _ in range(round(seconds / tick_s)):
        flying.fly(state, 0.0, 0.0, 120.0 + wanted_m_s)
    reached = 1.0 - math.exp(-seconds / 8.0)
    summed_s = seconds - 8.0 * reached
    expected = 0.5 + wanted_m_s * (THRUST.speed_s_m * reached + THRUST.speed_integral_m * summed_s)
    assert airframe.got["set_throttle"] == pytest.approx((expected,), abs=2e-3)


@TICKS
def test_who_gains_speed_by_himself_takes_the_lever_back_within_a_second(tick_s: float) -> None:
    """The measured acceleration is filtered with a time constant of a second."""
    airframe = level(throttle=0.5)
    flying = autopilot(airframe, state_at(speed_m_s=120.0), tick_s)
    acceleration_m_s2, seconds = 0.5, 1.0
    for tick in range(round(seconds / tick_s)):
        true_m_s = 120.0 + acceleration_m_s2 * tick_s * (tick + 1)
        state = state_at(speed_m_s=120.0, true_airspeed_m_s=true_m_s)
        flying.fly(state, 0.0, 0.0, 120.0)
    measured = acceleration_m_s2 * (1.0 - math.exp(-seconds))
    expected = 0.5 - THRUST.acceleration_s2_m * measured
    assert airframe.got["set_throttle"] == pytest.approx((expected,), abs=4e-4)


@pytest.mark.parametrize("climb", [0.001, -0.001])
def test_the_lever_moves_by_its_gain_with_the_climb_angle(climb: float) -> None:
    airframe, state = level(throttle=0.5), state_at(speed_m_s=120.0)
    flying = autopilot(airframe, state)
    flying.fly(state, 0.0, climb * 120.0, 120.0)
    assert airframe.got["set_throttle"] == pytest.approx((0.5 + THRUST.climb_angle * climb,))


@TICKS
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_new_vertical_rate_is_asked_for_with_a_quarter_of_g(tick_s: float, sign: float) -> None:
    """The lever shows the climb angle."""
    airframe, state = level(throttle=0.5), state_at(speed_m_s=120.0)
    flying = autopilot(airframe, state, tick_s)
    for _ in range(round(0.8 / tick_s)):
        flying.fly(state, 0.0, sign * 20.0, 120.0)
    climb = sign * 0.8 * 0.25 * 9.80665 / 120.0
    assert airframe.got["set_throttle"] == pytest.approx((0.5 + THRUST.climb_angle * climb,))


def test_who_takes_over_in_a_climb_keeps_lever_and_pitch() -> None:
    airframe = level(throttle=0.8, elevator=-0.05)
    state = state_at(speed_m_s=120.0, rate_m_s=6.0)
    state = state._replace(pitch_rad=6.0 / state.true_airspeed_m_s)
    flying = autopilot(airframe, state)
    assert flying.potential_climb == pytest.approx(6.0 / state.true_airspeed_m_s)
    for _ in range(20):
        flying.fly(state, 0.0, 6.0, 120.0)
        assert airframe.got["set_throttle"] == pytest.approx((0.8,))
        assert airframe.got["set_elevator"] == pytest.approx((-0.05,))


# --- the pitch that it asks for -----------------------------------------------------------------


class Pitching:
    """A 737 without the integral of the pitch rate: its elevator says which pitch is wanted."""

    def __init__(self, state: AircraftState, tick_s: float = 0.05, **answers: float) -> None:
        self._pitch = B737.gains.pitch.model_copy(
            update={"rate_s": 0.5, "rate_integral": 0.0, "rate_limit_deg_s": 180.0}
        )
        gains = B737.gains.model_copy(update={"pitch": self._pitch})
        self.airframe = level(**answers)
        kind = B737.model_copy(update={"gains": gains})
        self.autopilot = autopilot(self.airframe, state, tick_s, kind)

    def wanted(self, attitude_per_s: float = B737.gains.pitch.attitude_per_s) -> float:
        """Return the pitch to which the elevator of the last call leads, from level, in rad."""
        (elevator,) = self.airframe.got["set_elevator"]
        return float(-elevator / self._pitch.rate_s / attitude_per_s)

    def climb_after(self, seconds: float, fly: Callable[[Autopilot], None]) -> float:
        """Return the climb angle that is flown after some time, in rad.

        Where the aircraft stays level, the wanted pitch grows by a fiftieth of it in each second.
        """
        for _ in range(round(seconds / 0.05)):
            fly(self.autopilot)
        before = self.wanted()
        fly(self.autopilot)
        return (self.wanted() - before) / (0.02 * 0.05)


CLIMB = 0.001
LEVEL = state_at(speed_m_s=120.0)


def test_en_route_it_pitches_up_by_twice_the_climb_that_is_missing() -> None:
    """And by a fiftieth of it more in each second."""
    flying = Pitching(LEVEL)
    for tick in range(40):
        flying.autopilot.fly(LEVEL, 0.0, CLIMB * 120.0, 120.0)
        if tick:
            assert flying.wanted() == pytest.approx(CLIMB * (2.0 + 0.02 * 0.05 * (tick + 1)))


def test_en_route_a_change_of_the_climb_angle_is_met_by_one_and_a_half_times_its_rate() -> None:
    """With a load factor that is as much more than 1 as that change needs, nothing is missing."""
    rate_m_s2 = CLIMB * 120.0 / 0.05
    pulling = Pitching(LEVEL, load_factor=1.0 + rate_m_s2 / 9.80665, angle_of_attack=-2.7 * DEGREE)
    entering = Pitching(LEVEL, angle_of_attack=-2.7 * DEGREE)
    for each in (pulling, entering):
        each.autopilot.fly(LEVEL, 0.0, CLIMB * 120.0, 120.0)
    assert entering.wanted() - pulling.wanted() == pytest.approx(1.5 * CLIMB / 0.05)


def test_followed_closely_a_climb_is_flown_by_the_law_of_the_flare() -> None:
    flare = B737.landing.flare
    flying = Pitching(LEVEL)
    for _ in range(2):
        flying.autopilot.fly(LEVEL, 0.0, CLIMB * 120.0, 120.0, closely=True)
    expected = CLIMB * (1.0 + flare.climb + flare.climb_integral_per_s * 0.1)
    assert flying.wanted(flare.attitude_per_s) == pytest.approx(expected)


def test_in_the_flare_pitch_follows_the_change_of_the_sink_rate_too() -> None:
    """With a load factor that is as much more than 1 as that change needs, nothing is missing."""
    flare = B737.landing.flare
    flying = Pitching(LEVEL)
    flying.autopilot.flare(LEVEL, 0.0, 0.0, 0.6, 0.0, None)
    expected = flare.climb * flare.climb_rate_s * 0.6 / 120.0
    assert flying.wanted(flare.attitude_per_s) == pytest.approx(expected)
    pulling = Pitching(LEVEL, load_factor=1.0 + 0.6 / 9.80665, angle_of_attack=-2.7 * DEGREE)
    pulling.autopilot.flare(LEVEL, 0.0, 0.0, 0.6, 0.0, None)
    assert pulling.wanted(flare.attitude_per_s) == pytest.approx(-2.7 * DEGREE)


@TICKS
def test_the_angle_of_attack_of_level_flight_is_learned_with_a_lag_of_2_s(tick_s: float) -> None:
    flying = Pitching(LEVEL, tick_s)
    flying.airframe.answers["angle_of_attack"] = 1.0 * DEGREE
    for _ in range(round(2.0 / tick_s)):
        flying.autopilot.fly(LEVEL, 0.0, 0.0, 120.0)
    assert flying.wanted() == pytest.approx((1.0 - math.exp(-1.0)) * DEGREE, rel=0.03)


@pytest.mark.parametrize("roll_deg", [-20.0, 25.0])
def test_in_a_steady_turn_it_pulls_as_the_turn_needs(roll_deg: float) -> None:
    """The pitch rate is g / v times the sine and the tangent of the bank; the load factor is the
    inverse of its cosine, and so much more is the angle of attack above that without lift."""
    roll, zero = roll_deg * DEGREE, -2.7 * DEGREE
    banked = LEVEL._replace(roll_rad=roll)
    pitch_rate = 9.80665 / 120.0 * math.sin(roll) * math.tan(roll)
    flying = Pitching(LEVEL)
    flying.airframe.answers |= {
        "load_factor": 1.0 / math.cos(roll),
        "angle_of_attack": -zero / math.cos(roll) + zero,
        "pitch_rate": pitch_rate,
    }
    for _ in range(20):
        flying.autopilot.fly(banked, 0.0, 0.0, 120.0)
    assert flying.wanted() == pytest.approx(zero * (math.cos(roll) - 1.0))


def test_no_pitch_is_changed_faster_than_the_type_allows() -> None:
    airframe, low = level(), LEVEL._replace(pitch_rad=-60.0 * DEGREE)
    pitch = B737.gains.pitch
    flying = autopilot(airframe, low)
    airframe.answers["pitch_rate"] = pitch.rate_limit_deg_s * DEGREE
    flying.fly(low, 0.0, 0.0, 120.0)
    assert airframe.got["set_elevator"] == pytest.approx((0.0,), abs=1e-9)


@pytest.mark.parametrize(("to_go_deg", "rate_deg_s"), [(0.5, 1.0), (-1.0, -2.0), (9.0, 2.5)])
def test_the_nose_is_lifted_by_twice_what_is_left_a_second_and_by_the_greatest_rate_at_most(
    to_go_deg: float, rate_deg_s: float
) -> None:
    airframe = level(pitch_rate=rate_deg_s * DEGREE)
    state = LEVEL._replace(pitch_rad=(12.0 - to_go_deg) * DEGREE)
    rotating = autopilot(airframe, state)
    rotating.rotate(state, 12.0 * DEGREE, 2.5 * DEGREE, None, 1.0)
    assert airframe.got["set_elevator"] == pytest.approx((0.0,), abs=1e-9)


# --- thrust at its end --------------------------------------------------------------------------


def on_pitch(lacking_m_s: float, **limits: float) -> float:
    """Return the climb angle that is flown where the thrust keeps a level flight, in rad."""
    return Pitching(LEVEL, throttle=1.0).climb_after(
        40.0, lambda flying: flying.fly_on_pitch(LEVEL, 0.0, 120.0 + lacking_m_s, 1.0, **limits)
    )


@pytest.mark.parametrize(
    ("lacking_m_s", "climb"), [(10.0, -0.0816), (-10.0, 0.0816), (90.0, -0.2618), (-90.0, 0.2618)]
)
def test_on_pitch_it_climbs_8_hundredths_of_a_g_less_for_each_m_s_and_15_degrees_at_most(
    lacking_m_s: float, climb: float
) -> None:
    assert on_pitch(lacking_m_s) == pytest.approx(climb, rel=1e-3)


@pytest.mark.parametrize(("lacking_m_s", "climb"), [(-10.0, 0.0), (90.0, -0.1)])
def test_on_pitch_it_keeps_the_limits_of_its_climb(lacking_m_s: float, climb: float) -> None:
    limited = on_pitch(lacking_m_s, steepest_climb=0.0, steepest_descent=0.1)
    assert limited == pytest.approx(climb, abs=1e-6)


@TICKS
def test_the_climb_that_the_thrust_can_keep_is_learned_with_a_lag_of_4_s(tick_s: float) -> None:
    """It is what the aircraft climbs, and its acceleration over g."""
    climbing = LEVEL._replace(velocity_down_m_s=-6.0)
    flying = autopilot(level(), LEVEL, tick_s)
    for _ in range(round(4.0 / tick_s)):
        flying.fly(climbing, 0.0, 6.0, 120.0)
    expected = (1.0 - math.exp(-1.0)) * 6.0 / 120.0
    assert flying.potential_climb == pytest.approx(expected, rel=0.03)
    gaining = autopilot(level(), LEVEL, tick_s)
    for tick in range(round(40.0 / tick_s)):
        faster = LEVEL._replace(true_airspeed_m_s=120.0 + 0.5 * tick_s * (tick + 1))
        gaining.fly(faster, 0.0, 0.0, 120.0)
    assert gaining.potential_climb == pytest.approx(0.5 / 9.80665, rel=0.01)


@pytest.mark.parametrize(("lever", "sign"), [(1.0, 1.0), (0.0, -1.0)])
@pytest.mark.parametrize("beyond_m_s", [-2.0, 0.0, 2.0])
def test_once_the_lever_is_at_its_stop_the_climb_yields_beyond_8_percent_of_the_airspeed(
    lever: float, sign: float, beyond_m_s: float
) -> None:
    """What is flown then is what the thrust keeps, here level flight, less 0.08 / g for each m/s
    beyond the band."""
    airspeed_m_s = 120.0 / (1.0 - sign * 0.08)
    state = LEVEL._replace(calibrated_airspeed_m_s=120.0 - sign * beyond_m_s)
    flying = Pitching(state, throttle=lever)
    climb = flying.climb_after(
        60.0, lambda pilot: pilot.fly(state, 0.0, sign * 0.003 * 120.0, airspeed_m_s)
    )
    assert flying.airframe.got["set_throttle"] == (lever,)
    allowed = -0.08 / 9.80665 * beyond_m_s
    assert climb == pytest.approx(sign * min(0.003, allowed), abs=1e-4)


@pytest.mark.parametrize(("asked_rad", "flown_rad"), [(0.02, 0.02), (0.5, 15.0 * DEGREE)])
def test_with_the_lever_between_its_stops_no_climb_yields(
    asked_rad: float, flown_rad: float
) -> None:
    """Up to 15 degrees."""

    def climb(pilot: Autopilot) -> None:
        pilot.fly(LEVEL, 0.0, asked_rad * 120.0, LEVEL.calibrated_airspeed_m_s)

    assert Pitching(LEVEL, throttle=0.5).climb_after(20.0, climb) == pytest.approx(flown_rad)


# --- bank and rudder ----------------------------------------------------------------------------


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_it_rolls_no_faster_than_by_half_more_than_its_bank_moves(side: float) -> None:
    fastest = 1.5 * B737.gains.roll.bank_rate_limit_deg_s * DEGREE
    airframe = level(roll_rate=side * fastest)
    tilted = LEVEL._replace(roll_rad=-side * 0.6)
    flying = autopilot(airframe, LEVEL)
    flying.fly(tilted, 0.0, 0.0, 120.0)
    assert airframe.got["set_aileron"] == pytest.approx((0.0,), abs=1e-9)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_ailerons_and_rudder_at_their_stops_wind_nothing_up(sign: float) -> None:
    airframe = level()
    flying = autopilot(airframe, LEVEL)
    airframe.answers |= {"roll_rate": -sign * 2.0, "yaw_rate": sign * 2.0, "sideslip": -sign}
    for _ in range(100):
        flying.fly(LEVEL, 0.0, 0.0, 120.0)
    assert airframe.got["set_aileron"] == (sign,)
    assert airframe.got["set_rudder"] == (sign,)
    airframe.answers |= {"roll_rate": 0.0, "yaw_rate": 0.0, "sideslip": 0.0}
    flying.fly(LEVEL, 0.0, 0.0, 120.0)
    assert airframe.got["set_aileron"] == pytest.approx((0.0,), abs=1e-9)
    assert airframe.got["set_rudder"] == pytest.approx((0.0,), abs=1e-9)


def test_a_yaw_that_nobody_asked_for_is_met_by_rudder() -> None:
    """A positive rudder yaws left."""
    airframe = level(yaw_rate=0.1)
    autopilot(airframe, LEVEL).fly(LEVEL, 0.0, 0.0, 120.0)
    assert airframe.got["set_rudder"] == pytest.approx((B737.gains.yaw.rate_s * 0.1,))


def test_decrabbing_the_rudder_turns_the_nose_back_to_the_runway() -> None:
    """A nose to the right of it needs a yaw to the left, as sideslip from the left does."""
    yaw = B737.gains.yaw
    airframe = level(sideslip=0.3)
    autopilot(airframe, LEVEL).flare(LEVEL, 0.0, 0.0, 0.0, 0.0, 0.05)
    expected = (yaw.sideslip + yaw.sideslip_integral_per_s * 0.05) * 0.05
    assert airframe.got["set_rudder"] == pytest.approx((expected,))


def test_while_the_wheels_steer_the_rotation_leaves_ailerons_and_rudder_alone() -> None:
    """In the air it goes on from where they are."""
    airframe = level(aileron=0.2, rudder=-0.1, yaw_rate=0.0)
    rotating = autopilot(airframe, LEVEL)
    airframe.answers |= {"aileron": 0.3, "rudder": -0.25}
    rotating.rotate(LEVEL, 0.0, 0.1, None, 1.0)
    assert not {"set_aileron", "set_rudder"} & set(airframe.got)
    rotating.rotate(LEVEL, 0.0, 0.1, 0.0, 1.0)
    assert airframe.got["set_aileron"] == pytest.approx((0.3,))
    assert airframe.got["set_rudder"] == pytest.approx((-0.25,))


def test_the_steady_elevator_is_that_without_errors_of_this_instant() -> None:
    airframe = level(elevator=-0.2)
    flying = autopilot(airframe, LEVEL)
    airframe.answers["pitch_rate"] = 0.02
    flying.rotate(LEVEL, 0.0, 0.1, None, 1.0)
    integral = B737.gains.pitch.rate_integral * 0.05 * 0.02
    assert flying.steady_elevator() == pytest.approx(-0.2 + integral)
    airframe.answers["dynamic_pressure_pa"] = 0.25 * PRESSURE_PA
    assert flying.steady_elevator() == pytest.approx(4.0 * (-0.2 + integral))
    flying.take_over(LEVEL, -0.7)
    assert flying.steady_elevator() == pytest.approx(-0.7)
