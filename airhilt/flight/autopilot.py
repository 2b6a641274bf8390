"""Inner loops: turn rate, vertical rate and airspeed become control deflections.

Bank follows the turn rate, pitch the flight-path angle; each becomes an attitude, then a body
rate, then a deflection. The lever follows calibrated airspeed. When the engines give all they
have (or nothing) and the airspeed still leaves its band, the flight-path angle yields.
"""

from __future__ import annotations

import math

from airhilt.flight.aircraft_type import AircraftType
from airhilt.flight.airframe import Airframe
from airhilt.flight.state import AircraftState
from airhilt.units import DEGREE, STANDARD_GRAVITY

LIFT_ANGLE_LAG_S = 2.0
"""Of the filter between angle of attack and commanded pitch: slower than the short period."""
CLIMB_GAIN = 0.5
"""Pitch per error of climb angle."""
CLIMB_INTEGRAL_GAIN = 0.05
"""1/s."""
LEAST_LOAD_FACTOR = 0.5
"""Below it, lift tells nothing of the angle of attack that level flight needs."""
SPEED_LAG_S = 8.0
"""Of the reference airspeed behind the commanded one."""
ACCELERATION_LAG_S = 1.0
ENERGY_LAG_S = 4.0
ROLL_RATE_MARGIN = 1.5
"""Of roll rate above the rate at which the commanded bank moves, to catch up with it."""
MAXIMUM_PRESSURE_RATIO = 4.0
"""Bounds the surface gains at low airspeed."""
TWICE_EARTH_RATE = 2.0 * 7.292115e-5
"""rad/s (WGS84); times the sine of latitude, the turn that a wings-level flight makes by itself."""
MAXIMUM_CLIMB_ANGLE = 15.0 * DEGREE
SPEED_BAND = 0.08
"""Airspeed error, as a part of the commanded one, beyond which the climb angle yields once the
lever is at its stop."""
SPEED_TO_CLIMB = 0.08 / STANDARD_GRAVITY
"""Climb angle per airspeed error (rad s/m) where pitch holds the airspeed."""


class Autopilot:
    """Flies one airframe.

    Parameters
    ----------
    airframe
        In steady flight.
    kind
        Its type.
    tick_s
        Between two calls of `fly`.
    state
        The airframe's state now.
    """

    def __init__(
        self, airframe: Airframe, kind: AircraftType, tick_s: float, state: AircraftState
    ) -> None:
        self._airframe = airframe
        self._tick = tick_s
        gains = kind.gains
        pitch, roll, yaw, thrust = gains.pitch, gains.roll, gains.yaw, gains.thrust
        self._acceleration_blend = tick_s / ACCELERATION_LAG_S
        self._energy_blend = tick_s / ENERGY_LAG_S
        self._lift_blend = tick_s / LIFT_ANGLE_LAG_S
        self._climb_integral_gain = CLIMB_INTEGRAL_GAIN * tick_s
        self._pitch_gain = pitch.attitude_per_s
        self._pitch_rate_limit = pitch.rate_limit_deg_s * DEGREE
        self._elevator_gain = pitch.rate_s
        self._elevator_integral_gain = pitch.rate_integral * tick_s
        self._reference_pressure = pitch.reference_pressure_pa
        self._bank_limit = roll.bank_limit_deg * DEGREE
        self._bank_step = roll.bank_rate_limit_deg_s * DEGREE * tick_s
        self._bank_gain = roll.bank_per_s
        self._roll_rate_limit = ROLL_RATE_MARGIN * roll.bank_rate_limit_deg_s * DEGREE
        self._aileron_gain = roll.rate_s
        self._aileron_integral_gain = roll.rate_integral * tick_s
        self._sideslip_gain = yaw.sideslip
        self._sideslip_integral_gain = yaw.sideslip_integral_per_s * tick_s
        self._yaw_rate_gain = yaw.rate_s
        self._speed_gain = thrust.speed_s_m
        self._speed_integral_gain = thrust.speed_integral_m * tick_s
        self._reference_blend = tick_s / SPEED_LAG_S
        self._acceleration_gain = thrust.acceleration_s2_m
        self._climb_gain = thrust.climb_angle
        self._lever_step = thrust.lever_rate_per_s * tick_s

        # The integrals begin at what steady flight needs.
        self._elevator_integral = -airframe.elevator() / self._surface_scale()
        self._climb_integral = 0.0
        self._aileron_integral = airframe.aileron()
        self._rudder_integral = airframe.rudder()
        self._bank = state.roll_rad
        self._zero_lift_angle = pitch.zero_lift_angle_deg * DEGREE
        self._lift_angle = airframe.angle_of_attack() - self._zero_lift_angle
        self._true_airspeed = state.true_airspeed_m_s
        self._acceleration = 0.0
        climb = state.vertical_rate_m_s / state.true_airspeed_m_s
        self._potential_climb = climb
        self._shortfall = 0.0
        self._lever = airframe.throttle()
        self._lever_integral = self._lever - self._climb_gain * climb
        self._reference_airspeed = state.calibrated_airspeed_m_s

    def fly(
        self, state: AircraftState, turn_rate: float, vertical_rate: float, airspeed: float
    ) -> None:
        """Set the controls.

        Parameters
        ----------
        state
            Of the airframe now.
        turn_rate
            Of the track, positive to the right (rad/s).
        vertical_rate
            Positive up (m/s).
        airspeed
            Calibrated (m/s).
        """
        speed = state.true_airspeed_m_s
        roll = state.roll_rad
        turn = STANDARD_GRAVITY * math.sin(roll) / speed
        climb_angle = self._set_throttle(state, vertical_rate / speed, airspeed)
        self._set_elevator(state, climb_angle, turn * math.tan(roll))
        self._set_aileron(state, turn_rate)
        self._set_rudder(turn * math.cos(state.pitch_rad))

    def _set_throttle(self, state: AircraftState, climb_angle: float, airspeed: float) -> float:
        """Set the lever; return the climb angle, or what of it the engines can keep."""
        speed = state.true_airspeed_m_s
        self._acceleration += self._acceleration_blend * (
            (speed - self._true_airspeed) / self._tick - self._acceleration
        )
        self._true_airspeed = speed
        acceleration = self._acceleration
        shortfall = airspeed - state.calibrated_airspeed_m_s
        potential = acceleration / STANDARD_GRAVITY - state.velocity_down_m_s / speed
        self._potential_climb += self._energy_blend * (potential - self._potential_climb)
        self._shortfall += self._energy_blend * (shortfall - self._shortfall)

        climb_angle = within(climb_angle, MAXIMUM_CLIMB_ANGLE)
        lever = self._lever
        if lever >= 1.0:
            excess = SPEED_BAND * airspeed - self._shortfall
            climb_angle = min(climb_angle, self._potential_climb + SPEED_TO_CLIMB * excess)
        elif lever <= 0.0:
            excess = -SPEED_BAND * airspeed - self._shortfall
            climb_angle = max(climb_angle, self._potential_climb + SPEED_TO_CLIMB * excess)

        # The reference takes its time to a new airspeed: the integral then has none to overshoot.
        self._reference_airspeed += self._reference_blend * (airspeed - self._reference_airspeed)
        error = self._reference_airspeed - state.calibrated_airspeed_m_s
        wanted = (
            self._speed_gain * error
            + self._lever_integral
            - self._acceleration_gain * acceleration
            + self._climb_gain * climb_angle
        )
        if 0.0 < wanted < 1.0:
            self._lever_integral += self._speed_integral_gain * error
        lever += within(wanted - lever, self._lever_step)
        self._lever = lever = min(max(lever, 0.0), 1.0)
        self._airframe.set_throttle(lever)
        return climb_angle

    def _set_elevator(self, state: AircraftState, climb_angle: float, turn_rate: float) -> None:
        """Follow the climb angle, with the pitch rate (rad/s) that the turn alone needs."""
        airframe = self._airframe
        # The angle of attack that carries the weight, whatever the load factor is just now: its
        # part in the vertical is the same in a turn, but for the zero-lift angle's.
        load_factor = airframe.load_factor()
        if load_factor > LEAST_LOAD_FACTOR:
            lift_angle = (airframe.angle_of_attack() - self._zero_lift_angle) / load_factor
            self._lift_angle += self._lift_blend * (lift_angle - self._lift_angle)
        error = climb_angle + state.velocity_down_m_s / state.true_airspeed_m_s
        self._climb_integral += self._climb_integral_gain * error
        wanted_pitch = (
            climb_angle
            + CLIMB_GAIN * error
            + self._climb_integral
            + self._lift_angle
            + self._zero_lift_angle * math.cos(state.roll_rad)
        )
        pitch_rate = turn_rate + within(
            self._pitch_gain * (wanted_pitch - state.pitch_rad), self._pitch_rate_limit
        )
        error = pitch_rate - airframe.pitch_rate()
        integral = self._elevator_integral + self._elevator_integral_gain * error
        elevator = -self._surface_scale() * (self._elevator_gain * error + integral)
        if -1.0 < elevator < 1.0:
            self._elevator_integral = integral
        airframe.set_elevator(within(elevator, 1.0))

    def _set_aileron(self, state: AircraftState, turn_rate: float) -> None:
        """Bank for the turn rate of the track, the Earth's own turn taken off."""
        airframe = self._airframe
        turn_rate -= TWICE_EARTH_RATE * math.sin(state.latitude_rad)
        bank = math.atan(turn_rate * state.true_airspeed_m_s / STANDARD_GRAVITY)
        self._bank += within(within(bank, self._bank_limit) - self._bank, self._bank_step)
        roll_rate = within(self._bank_gain * (self._bank - state.roll_rad), self._roll_rate_limit)
        error = roll_rate - airframe.roll_rate()
        integral = self._aileron_integral + self._aileron_integral_gain * error
        aileron = self._aileron_gain * error + integral
        if -1.0 < aileron < 1.0:
            self._aileron_integral = integral
        airframe.set_aileron(within(aileron, 1.0))

    def _set_rudder(self, coordinated_yaw_rate: float) -> None:
        """Bring sideslip to zero and yaw at the rate of a coordinated turn (rad/s)."""
        airframe = self._airframe
        sideslip = airframe.sideslip()
        integral = self._rudder_integral - self._sideslip_integral_gain * sideslip
        rudder = (
            integral
            - self._sideslip_gain * sideslip
            + self._yaw_rate_gain * (airframe.yaw_rate() - coordinated_yaw_rate)
        )
        if -1.0 < rudder < 1.0:
            self._rudder_integral = integral
        airframe.set_rudder(within(rudder, 1.0))

    def _surface_scale(self) -> float:
        """Return by how much more the elevator moves than at its reference pressure."""
        pressure = max(self._airframe.dynamic_pressure_pa(), 1.0)
        return min(self._reference_pressure / pressure, MAXIMUM_PRESSURE_RATIO)


def within(value: float, limit: float) -> float:
    """Return ``value`` brought into [-limit, limit]."""
    return limit if value > limit else -limit if value < -limit else value
