"""The ground law: nose wheel, rudder, ailerons, brakes and levers, once the wheels carry weight.

Heading follows a course or a path by a commanded yaw rate, speed follows a deceleration or a taxi
speed. At high speed the rudder does most of the steering, at low speed the nose wheel.
"""

from __future__ import annotations

import math

from airhilt.units import DEGREE, FOOT, wrap_angle
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.airframe import Airframe
from airhilt.world.flight.autopilot import within
from airhilt.world.flight.state import AircraftState

COURSE_GAIN = 1.5
"""Yaw rate per heading error (1/s)."""
CROSS_TRACK_GAIN = 0.4
"""Closing speed per distance from the centre line (1/s)."""
CLOSING_SPEED_M_S = 8.0 * FOOT
"""Greatest speed towards the centre line, in m/s."""
CLOSING_ANGLE = 30.0 * DEGREE
"""Greatest angle towards the centre line, in rad."""
LATERAL_ACCELERATION_M_S2 = 2.5
"""Greatest lateral acceleration in a turn, in m/s2."""
LEAST_SPEED_M_S = 1.0
"""Speed in m/s below which the steering angles no longer grow."""
LARGEST_INTEGRAL = 0.5
"""Greatest part of the rudder that the integral of the yaw rate takes."""
SLIP_FROM_M_S = 10.0
"""Ground speed from which wheels may slip in a crosswind, in m/s."""
SLIP_LAG_S = 2.0
"""Time constant of the filter for the slip angle between nose and track, in s."""
LARGEST_SLIP = 1.5 * DEGREE
"""Greatest slip angle, in rad; a greater angle is the crab in which the aircraft touched down."""
BANK_GAIN = 5.0
"""Aileron per bank that keeps the wings level, in 1/rad."""
ROLL_RATE_GAIN = 1.5
"""Aileron per roll rate that keeps the wings level, in s/rad."""
NOSE_DOWN_RATE = 2.0 * DEGREE
"""Rate (rad/s) at which the nose is lowered after touchdown."""
NOSE_DOWN_ELEVATOR = 0.1
"""Elevator that presses the nose wheel to the ground."""
ELEVATOR_RATE_PER_S = 0.5
"""Rate at which the elevator then moves, in 1/s."""
BRAKE_GAIN = 0.3
"""Pedal per second and deceleration error, 1/(s m/s2)."""
LEVER_GAIN = 0.05
"""Throttle lever per error of taxi speed, in s/m."""
LEVER_INTEGRAL_GAIN = 0.01
"""Throttle lever per integral of that error, in 1/m."""
LARGEST_TAXI_LEVER = 0.5
"""Greatest throttle lever while taxiing."""
LEVER_FADE_PER_S = 0.3
"""Rate at which the lever's integral decays while the brakes are on, in 1/s."""
SPEED_PER_S = 1.5
"""Acceleration per error of taxi speed (1/s)."""
COASTING_M_S2 = 0.3
"""Deceleration without brakes: rolling friction against idle thrust, and a margin."""
FULL_BRAKE_M_S2 = 4.5
"""Deceleration by the brakes: the models' dynamic friction of 0.5, on the main wheels."""
STOP_DECELERATION_M_S2 = 1.5
"""Deceleration of a stop while taxiing, in m/s2."""
LAST_M_S = 0.4
"""Speed in m/s below which the brakes are set."""


class GroundLaw:
    """Steers and brakes one airframe on its wheels, once every ``tick_s``."""

    def __init__(self, airframe: Airframe, kind: AircraftType, tick_s: float) -> None:
        self._airframe = airframe
        self._tick = tick_s
        self._yaw_gain = kind.ground.yaw_rate_s
        self._yaw_integral_gain = kind.ground.yaw_integral
        self._look_ahead = kind.ground.look_ahead_m
        self._nose_wheel_limit = kind.ground.nose_wheel_limit_deg * DEGREE
        pitch = kind.gains.pitch
        self._pitch_rate_gain = 0.5 * pitch.rate_s
        self._pitch_integral_gain = pitch.rate_integral * tick_s
        self._reference_pressure = pitch.reference_pressure_pa
        self.reset()

    def reset(self, elevator: float | None = None) -> None:
        """Start again from the present controls, or from a steady elevator."""
        self._yaw_integral = 0.0
        self._slip = 0.0
        self._pedals = 0.0
        self._lever_integral = 0.0
        self._taxi_speed: float | None = None
        self._speed: float | None = None
        self._elevator_integral = self._airframe.elevator() if elevator is None else elevator

    def follow_line(
        self,
        state: AircraftState,
        cross_track_m: float,
        course_rad: float,
        *,
        slipping: bool = True,
    ) -> None:
        """Steer along a straight line, by the distance to its right and its true course.

        ``slipping`` is true if the nose may point off the track, as a crosswind makes it on wheels
        that carry little weight. After a touchdown in a crab it must not: the crab would be kept.
        """
        speed = max(state.ground_speed_m_s, LEAST_SPEED_M_S)
        reach = max(self._look_ahead, speed / CROSS_TRACK_GAIN)
        offset = within(cross_track_m / reach, min(CLOSING_SPEED_M_S / speed, CLOSING_ANGLE))
        gain = min(COURSE_GAIN, speed / self._look_ahead)
        slip = wrap_angle(state.heading_rad - state.track_rad)
        if not slipping or speed < SLIP_FROM_M_S:
            slip = 0.0
        self._slip += self._tick / SLIP_LAG_S * (within(slip, LARGEST_SLIP) - self._slip)
        heading = course_rad - offset + self._slip
        self.steer(state, gain * wrap_angle(heading - state.heading_rad))

    def steer(self, state: AircraftState, yaw_rate: float) -> None:
        """Yaw at a rate (rad/s, positive to the right), the wings level."""
        airframe = self._airframe
        speed = max(state.ground_speed_m_s, LEAST_SPEED_M_S)
        yaw_rate = within(yaw_rate, LATERAL_ACCELERATION_M_S2 / speed)
        error = airframe.yaw_rate() - yaw_rate
        self._yaw_integral = within(
            self._yaw_integral + self._yaw_integral_gain * self._tick * error, LARGEST_INTEGRAL
        )
        airframe.set_rudder(within(self._yaw_gain * error + self._yaw_integral, 1.0))
        curvature = airframe.wheelbase_m / speed
        angle = math.atan(yaw_rate * curvature) - error * curvature
        airframe.set_nose_wheel(within(angle, self._nose_wheel_limit))
        aileron = BANK_GAIN * state.roll_rad + ROLL_RATE_GAIN * airframe.roll_rate()
        airframe.set_aileron(-within(aileron, 1.0))

    def lower_nose(self) -> None:
        """Lower the nose wheel to the ground and keep it there."""
        airframe = self._airframe
        if airframe.nose_on_ground():
            step = ELEVATOR_RATE_PER_S * self._tick
            elevator = airframe.elevator()
            airframe.set_elevator(elevator + within(NOSE_DOWN_ELEVATOR - elevator, step))
            return
        pressure = max(airframe.dynamic_pressure_pa(), 0.25 * self._reference_pressure)
        scale = self._reference_pressure / pressure
        error = -NOSE_DOWN_RATE - airframe.pitch_rate()
        self._elevator_integral -= scale * self._pitch_integral_gain * error
        airframe.set_elevator(
            within(self._elevator_integral - scale * self._pitch_rate_gain * error, 1.0)
        )

    def slow_down(self, state: AircraftState, deceleration_m_s2: float) -> None:
        """Brake at a deceleration, the levers at idle."""
        speed = state.ground_speed_m_s
        if self._speed is not None:
            error = deceleration_m_s2 - (self._speed - speed) / self._tick
            self._pedals += BRAKE_GAIN * self._tick * error
            self._pedals = min(max(self._pedals, 0.0), 1.0)
        self._speed = speed
        self._airframe.set_throttle(0.0)
        self._airframe.set_brakes(self._pedals)

    def hold_speed(self, state: AircraftState, speed_m_s: float) -> None:
        """Taxi at a speed that may change from call to call; at 0, brake to a stand and stay."""
        airframe, now = self._airframe, state.ground_speed_m_s
        self._speed, self._pedals = None, 0.0
        if speed_m_s <= 0.0:
            self._lever_integral = 0.0
            airframe.set_throttle(0.0)
            firm = STOP_DECELERATION_M_S2 / FULL_BRAKE_M_S2
            airframe.set_brakes(1.0 if now < LAST_M_S else firm)
            return
        before = speed_m_s if self._taxi_speed is None else self._taxi_speed
        self._taxi_speed = speed_m_s
        slope = within((speed_m_s - before) / self._tick, STOP_DECELERATION_M_S2)
        error = speed_m_s - now
        wanted = min(slope, 0.0) + SPEED_PER_S * error
        airframe.set_brakes(min(max((-wanted - COASTING_M_S2) / FULL_BRAKE_M_S2, 0.0), 1.0))
        if wanted < -COASTING_M_S2:
            self._lever_integral -= LEVER_FADE_PER_S * self._tick * self._lever_integral
            airframe.set_throttle(0.0)
            return
        integral = self._lever_integral + LEVER_INTEGRAL_GAIN * self._tick * error
        self._lever_integral = min(max(integral, 0.0), LARGEST_TAXI_LEVER)
        lever = LEVER_GAIN * error + self._lever_integral
        airframe.set_throttle(min(max(lever, 0.0), LARGEST_TAXI_LEVER))
