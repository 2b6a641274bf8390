"""Inner loops: turn rate, vertical rate and airspeed become control deflections.

Bank follows the turn rate, pitch the flight-path angle; each becomes an attitude, then a body
rate, then a deflection. The lever follows calibrated airspeed. When the engines give all they
have (or nothing) and the airspeed still leaves its band, the flight-path angle yields.

Three ways to fly: `Autopilot.fly` (the lever holds the airspeed), `Autopilot.fly_on_pitch` (the
lever stands, pitch holds the airspeed) and `Autopilot.flare` (the lever stands, the vertical rate
is followed as closely as the aircraft can).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from airhilt.geodesy.wgs84 import ROTATION_RATE_RAD_S
from airhilt.units import DEGREE, STANDARD_GRAVITY
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.airframe import Airframe
from airhilt.world.flight.state import AircraftState

LIFT_ANGLE_LAG_S = 2.0
"""Time constant between angle of attack and commanded pitch, in s: slower than the short period."""
LEAST_LOAD_FACTOR = 0.5
"""Load factor below which lift does not show the angle of attack that level flight needs."""
SPEED_LAG_S = 8.0
"""Time constant of the reference airspeed behind the commanded one, in s."""
ACCELERATION_LAG_S = 1.0
"""Time constant of the measured acceleration, in s."""
ENERGY_LAG_S = 4.0
"""Time constant of the climb angle that the thrust can keep, in s."""
ROLL_RATE_MARGIN = 1.5
"""Greatest roll rate, as a multiple of the rate at which the commanded bank moves."""
MAXIMUM_PRESSURE_RATIO = 4.0
"""Greatest factor on the surface gains at low dynamic pressure."""
TWICE_EARTH_RATE = 2.0 * ROTATION_RATE_RAD_S
"""Twice the Earth's rotation rate, in rad/s (WGS84). Times the sine of the latitude, it is the turn
rate of a wings-level flight."""
ROTATION_PER_S = 2.0
"""Pitch rate per error of pitch while the nose is lifted, in 1/s."""
MAXIMUM_CLIMB_ANGLE = 15.0 * DEGREE
"""Greatest climb or descent angle that airspeed control asks for, in rad."""
VERTICAL_ACCELERATION_M_S2 = 0.25 * STANDARD_GRAVITY
"""Greatest vertical acceleration to a new vertical rate, in m/s2: that of the standard pilot who
follows a resolution advisory (ICAO Annex 10, volume IV, 4.4.2.6)."""
SPEED_BAND = 0.08
"""Airspeed error, as a part of the commanded one, beyond which the climb angle yields once the
lever is at its stop."""
SPEED_TO_CLIMB = 0.08 / STANDARD_GRAVITY
"""Climb angle per airspeed error (rad s/m) where pitch holds the airspeed."""


class PitchLaw(NamedTuple):
    """Gains by which pitch follows the climb angle."""

    climb: float
    """Pitch per error of climb angle."""
    climb_integral_per_s: float
    """Pitch per integral of that error, in 1/s."""
    climb_rate_s: float
    """Climb angle per error of its rate, in s; the load factor shows that rate."""
    attitude_per_s: float
    """Pitch rate per error of pitch, in 1/s."""


class Autopilot:
    """Flies one airframe that is in steady flight.

    Turn rates are those of the track, in rad/s, positive to the right; vertical rates are in m/s,
    positive up; airspeeds are calibrated, in m/s. A lever is the wanted position of all throttle
    levers (0..1), which move there at their own rate.
    """

    def __init__(
        self, airframe: Airframe, kind: AircraftType, tick_s: float, state: AircraftState
    ) -> None:
        self._airframe = airframe
        self._tick = tick_s
        self._gains = gains = kind.gains
        self._acceleration_blend = tick_s / ACCELERATION_LAG_S
        self._energy_blend = tick_s / ENERGY_LAG_S
        self._lift_blend = tick_s / LIFT_ANGLE_LAG_S
        self._reference_blend = tick_s / SPEED_LAG_S
        self._vertical_rate_step = VERTICAL_ACCELERATION_M_S2 * tick_s
        self._steady_law = PitchLaw(1.0, 0.02, 1.5, gains.pitch.attitude_per_s)
        flare = kind.landing.flare
        self._flare_law = PitchLaw(
            flare.climb,
            flare.climb_integral_per_s,
            flare.climb_rate_s,
            flare.attitude_per_s,
        )
        self._pitch_rate_limit = gains.pitch.rate_limit_deg_s * DEGREE
        self._elevator_integral_gain = gains.pitch.rate_integral * tick_s
        self._bank_limit = gains.roll.bank_limit_deg * DEGREE
        self._bank_step = gains.roll.bank_rate_limit_deg_s * DEGREE * tick_s
        self._roll_rate_limit = ROLL_RATE_MARGIN * gains.roll.bank_rate_limit_deg_s * DEGREE
        self._aileron_integral_gain = gains.roll.rate_integral * tick_s
        self._sideslip_integral_gain = gains.yaw.sideslip_integral_per_s * tick_s
        self._speed_integral_gain = gains.thrust.speed_integral_m * tick_s
        self._lever_step = gains.thrust.lever_rate_per_s * tick_s
        self._zero_lift_angle = gains.pitch.zero_lift_angle_deg * DEGREE
        self.take_over(state)

    def take_over(self, state: AircraftState, elevator: float | None = None) -> None:
        """Start from the present flight and controls, or with another elevator (-1..1)."""
        airframe = self._airframe
        speed = max(state.true_airspeed_m_s, 1.0)
        # The integrals begin at what steady flight needs.
        elevator = airframe.elevator() if elevator is None else elevator
        self._elevator_integral = -elevator / self._surface_scale()
        self._climb_integral = 0.0
        self._follow_aileron_and_rudder(state)
        self._lift_angle = airframe.angle_of_attack() - self._zero_lift_angle
        self._true_airspeed = speed
        self._acceleration = 0.0
        climb = state.vertical_rate_m_s / speed
        self._potential_climb = climb
        self._shortfall = 0.0
        self._lever = airframe.throttle()
        self._lever_integral = self._lever - self._gains.thrust.climb_angle * climb
        self._reference_airspeed = state.calibrated_airspeed_m_s
        self._reference_climb = climb

    @property
    def lever(self) -> float:
        """Position of the throttle levers (0..1)."""
        return self._lever

    @property
    def potential_climb(self) -> float:
        """The climb angle (rad) that the thrust can keep at the present airspeed."""
        return self._potential_climb

    @property
    def level_angle_of_attack(self) -> float:
        """Angle of attack (rad) that carries the weight with level wings."""
        return self._lift_angle + self._zero_lift_angle

    def steady_elevator(self) -> float:
        """Return the elevator (-1..1) without what it does against the errors of this instant."""
        return within(-self._surface_scale() * self._elevator_integral, 1.0)

    def fly(
        self,
        state: AircraftState,
        turn_rate: float,
        vertical_rate: float,
        airspeed: float,
        *,
        closely: bool = False,
    ) -> None:
        """Set the controls so that the lever holds the airspeed.

        ``closely`` is true to follow the vertical rate as closely as in a flare.
        """
        speed = state.true_airspeed_m_s
        before = self._reference_climb
        wanted = within(vertical_rate / speed, MAXIMUM_CLIMB_ANGLE)
        self._reference_climb += within(wanted - before, self._vertical_rate_step / speed)
        climb_rate = (self._reference_climb - before) / self._tick
        self._sense_energy(state, airspeed)
        climb_angle = self._hold_airspeed(state, self._reference_climb, airspeed)
        law = self._flare_law if closely else self._steady_law
        self._set_elevator(state, climb_angle, climb_rate, law)
        self._set_aileron(state, turn_rate)
        self._set_rudder(state, self._airframe.sideslip())

    def fly_on_pitch(
        self,
        state: AircraftState,
        turn_rate: float,
        airspeed: float,
        lever: float,
        *,
        steepest_climb: float = MAXIMUM_CLIMB_ANGLE,
        steepest_descent: float = MAXIMUM_CLIMB_ANGLE,
    ) -> None:
        """Set the controls so that the climb angle holds the airspeed, whatever the thrust.

        The limits of the climb angle are in rad, both positive.
        """
        self._sense_energy(state, airspeed)
        climb_angle = self._potential_climb - SPEED_TO_CLIMB * self._shortfall
        climb_angle = min(max(climb_angle, -steepest_descent), steepest_climb)
        self._move_lever(state, climb_angle, lever)
        self._set_elevator(state, climb_angle, 0.0, self._steady_law)
        self._set_aileron(state, turn_rate)
        self._set_rudder(state, self._airframe.sideslip())

    def rotate(
        self,
        state: AircraftState,
        pitch: float,
        pitch_rate: float,
        turn_rate: float | None,
        lever: float,
    ) -> None:
        """Set the controls so that the nose comes to a pitch and stays there.

        Pitch is in rad, positive up; its rate on the way there is at most ``pitch_rate``, in rad/s.
        The turn rate is None while the wheels steer.
        """
        self._sense_energy(state, state.calibrated_airspeed_m_s)
        self._move_lever(state, 0.0, lever)
        wanted = within(ROTATION_PER_S * (pitch - state.pitch_rad), pitch_rate)
        self._move_elevator(wanted - self._airframe.pitch_rate())
        if turn_rate is None:
            self._follow_aileron_and_rudder(state)
        else:
            self._set_aileron(state, turn_rate)
            self._set_rudder(state, self._airframe.sideslip())

    def _follow_aileron_and_rudder(self, state: AircraftState) -> None:
        """Be ready to go on from where something else has set them."""
        self._aileron_integral = self._airframe.aileron() / self._surface_scale()
        self._rudder_integral = self._airframe.rudder()
        self._bank = state.roll_rad

    def flare(
        self,
        state: AircraftState,
        turn_rate: float,
        vertical_rate: float,
        vertical_acceleration: float,
        lever: float,
        crab: float | None,
    ) -> None:
        """Set the controls so that the vertical rate and its rate of change are followed closely.

        ``crab`` is the angle from the wanted heading of the nose to its present heading, positive
        to the right (rad); None to fly without sideslip.
        """
        speed = state.true_airspeed_m_s
        self._sense_energy(state, state.calibrated_airspeed_m_s)
        self._move_lever(state, vertical_rate / speed, lever)
        self._set_elevator(
            state, vertical_rate / speed, vertical_acceleration / speed, self._flare_law
        )
        self._set_aileron(state, turn_rate)
        self._set_rudder(state, self._airframe.sideslip() if crab is None else -crab)

    def _sense_energy(self, state: AircraftState, airspeed: float) -> None:
        """Filter the acceleration, the climb angle that the thrust can keep, the speed's error."""
        speed = state.true_airspeed_m_s
        self._acceleration += self._acceleration_blend * (
            (speed - self._true_airspeed) / self._tick - self._acceleration
        )
        self._true_airspeed = speed
        shortfall = airspeed - state.calibrated_airspeed_m_s
        potential = self._acceleration / STANDARD_GRAVITY - state.velocity_down_m_s / speed
        self._potential_climb += self._energy_blend * (potential - self._potential_climb)
        self._shortfall += self._energy_blend * (shortfall - self._shortfall)

    def _hold_airspeed(self, state: AircraftState, climb_angle: float, airspeed: float) -> float:
        """Set the lever; return the climb angle, or what of it the engines can keep."""
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
            self._gains.thrust.speed_s_m * error
            + self._lever_integral
            - self._gains.thrust.acceleration_s2_m * self._acceleration
            + self._gains.thrust.climb_angle * climb_angle
        )
        if 0.0 < wanted < 1.0:
            self._lever_integral += self._speed_integral_gain * error
        lever += within(wanted - lever, self._lever_step)
        self._lever = lever = min(max(lever, 0.0), 1.0)
        self._airframe.set_throttle(lever)
        return climb_angle

    def _move_lever(self, state: AircraftState, climb_angle: float, lever: float) -> None:
        """Move the lever to where it shall stand, ready to hold airspeed and climb from there."""
        self._lever += within(lever - self._lever, self._lever_step)
        self._airframe.set_throttle(self._lever)
        self._lever_integral = self._lever - self._gains.thrust.climb_angle * climb_angle
        self._reference_airspeed = state.calibrated_airspeed_m_s
        self._reference_climb = state.vertical_rate_m_s / state.true_airspeed_m_s

    def _set_elevator(
        self, state: AircraftState, climb_angle: float, climb_rate: float, law: PitchLaw
    ) -> None:
        """Follow a climb angle that changes at a rate, with the pitch rate that a turn needs."""
        airframe = self._airframe
        speed = state.true_airspeed_m_s
        roll = state.roll_rad
        turn_rate = STANDARD_GRAVITY * math.sin(roll) * math.tan(roll) / speed
        # The angle of attack that carries the weight, whatever the load factor is just now: its
        # part in the vertical is the same in a turn, but for the zero-lift angle's.
        load_factor = airframe.load_factor()
        if load_factor > LEAST_LOAD_FACTOR:
            lift_angle = (airframe.angle_of_attack() - self._zero_lift_angle) / load_factor
            self._lift_angle += self._lift_blend * (lift_angle - self._lift_angle)
        error = climb_angle + state.velocity_down_m_s / speed
        self._climb_integral += law.climb_integral_per_s * self._tick * error
        curvature = STANDARD_GRAVITY * (load_factor * math.cos(roll) - 1.0) / speed
        error += law.climb_rate_s * (climb_rate - curvature)
        wanted_pitch = (
            climb_angle
            + law.climb * error
            + self._climb_integral
            + self._lift_angle
            + self._zero_lift_angle * math.cos(roll)
        )
        pitch_rate = turn_rate + within(
            law.attitude_per_s * (wanted_pitch - state.pitch_rad), self._pitch_rate_limit
        )
        self._move_elevator(pitch_rate - airframe.pitch_rate())

    def _move_elevator(self, error: float) -> None:
        """Bring an error of pitch rate to zero."""
        integral = self._elevator_integral + self._elevator_integral_gain * error
        elevator = -self._surface_scale() * (self._gains.pitch.rate_s * error + integral)
        if -1.0 < elevator < 1.0:
            self._elevator_integral = integral
        self._airframe.set_elevator(within(elevator, 1.0))

    def _set_aileron(self, state: AircraftState, turn_rate: float) -> None:
        """Bank for the turn rate of the track, the Earth's own turn taken off."""
        airframe = self._airframe
        turn_rate -= TWICE_EARTH_RATE * math.sin(state.latitude_rad)
        bank = math.atan(turn_rate * state.true_airspeed_m_s / STANDARD_GRAVITY)
        self._bank += within(within(bank, self._bank_limit) - self._bank, self._bank_step)
        roll_rate = within(
            self._gains.roll.bank_per_s * (self._bank - state.roll_rad), self._roll_rate_limit
        )
        error = roll_rate - airframe.roll_rate()
        integral = self._aileron_integral + self._aileron_integral_gain * error
        aileron = self._surface_scale() * (self._gains.roll.rate_s * error + integral)
        if -1.0 < aileron < 1.0:
            self._aileron_integral = integral
        airframe.set_aileron(within(aileron, 1.0))

    def _set_rudder(self, state: AircraftState, sideslip: float) -> None:
        """Bring the sideslip (or what stands for it) to zero in a coordinated turn."""
        coordinated_yaw_rate = (
            STANDARD_GRAVITY
            * math.sin(state.roll_rad)
            * math.cos(state.pitch_rad)
            / state.true_airspeed_m_s
        )
        airframe = self._airframe
        integral = self._rudder_integral - self._sideslip_integral_gain * sideslip
        rudder = (
            integral
            - self._gains.yaw.sideslip * sideslip
            + self._gains.yaw.rate_s * (airframe.yaw_rate() - coordinated_yaw_rate)
        )
        if -1.0 < rudder < 1.0:
            self._rudder_integral = integral
        airframe.set_rudder(within(rudder, 1.0))

    def _surface_scale(self) -> float:
        """Return by how much more elevator and ailerons move than at their reference pressure."""
        least = self._gains.pitch.reference_pressure_pa / MAXIMUM_PRESSURE_RATIO
        return self._gains.pitch.reference_pressure_pa / max(
            self._airframe.dynamic_pressure_pa(), least
        )


def within(value: float, limit: float) -> float:
    """Return ``value`` brought into [-limit, limit]."""
    return limit if value > limit else -limit if value < -limit else value
