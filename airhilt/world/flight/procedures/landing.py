"""The landing: approach, flare, decrab, touchdown, rollout; then the runway is left.

The glide path meets the runway where the main wheels aim at, ``landing.aim_m`` of the aircraft
type beyond the threshold. Until it is met from below the altitude is held.
"""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.geodesy.wgs84 import Place
from airhilt.units import FOOT_PER_MINUTE, KNOT
from airhilt.world.flight.guidance import Altitude, AltitudeClearance
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.procedures.final import GREATEST_CORRECTION_M_S, Final
from airhilt.world.flight.procedures.preparation import Preparation
from airhilt.world.flight.procedures.taxi import Standing, Taxi
from airhilt.world.flight.state import AircraftState
from airhilt.world.flight.taxi_path import TaxiPath

CLOSE_HEIGHT_M = 60.0
"""Height in m below which the glide path is followed as closely as the flare: 200 ft, where a
category I approach needs the runway in sight (ICAO Annex 6 part I, 4.2.8.3)."""
GREATEST_DECELERATION_M_S2 = 3.0
"""Greatest deceleration on a dry runway, in m/s2: about an autobrake's highest landing setting."""
LEAD_S = 1.0
"""Time before the exit path at which steering along it begins, in s."""
EXIT_MARGIN_M_S = 2.0
"""Excess over the speed of the exit with which it is still taken, in m/s."""
STANDING_M_S = 0.2
"""Ground speed in m/s below which the rollout has ended."""


class Glide(FlightPhase):
    """Flies the localizer and the glide path down to the flare.

    Below the glide path it keeps its altitude until the path is met. ``preparation`` is that of the
    way before it.
    """

    name = "glide"

    def __init__(
        self,
        systems: AircraftSystems,
        final: Final,
        exit_path: Sequence[Place],
        altitude_m: float,
        preparation: Preparation,
    ) -> None:
        super().__init__(systems)
        self.final = final
        self.exit_path = exit_path
        self.preparation = preparation
        self._intercept = Altitude(
            AltitudeClearance(altitude_m, GREATEST_CORRECTION_M_S),
            systems.kind.gains.guidance.altitude_per_s,
        )
        self._captured = False

    def leave_at(self, exit_path: Sequence[Place]) -> None:
        """Leave the runway by another path."""
        self.exit_path = exit_path

    def fly(self, state: AircraftState) -> FlightPhase:
        """Fly one tick."""
        systems, final = self._systems, self.final
        flare = systems.kind.landing.flare
        airspeed = self.preparation.airspeed_m_s(-final.along_m(state))
        vertical_rate = final.vertical_rate(state)
        if not self._captured:
            level = self._intercept.vertical_rate(state)
            self._captured = vertical_rate <= level
            vertical_rate = min(vertical_rate, level)
        height = systems.airframe.main_wheel_height_m(state)
        sink_at_flare = height / flare.time_constant_s + flare.touchdown_rate_fpm * FOOT_PER_MINUTE
        if sink_at_flare < -final.glide_rate(state):
            return Flare(systems, final, self.exit_path, height).fly(state)
        systems.autopilot.fly(
            state,
            final.turn_rate(state),
            vertical_rate,
            airspeed,
            closely=height < CLOSE_HEIGHT_M,
        )
        return self


class Flare(FlightPhase):
    """Lets the sink rate die away with the height, and the nose turn along the runway.

    The levers come back to idle with the height of the main wheels from that at which the flare
    begins; at touchdown the rollout begins.
    """

    name = "flare"
    may_touch = True

    def __init__(
        self, systems: AircraftSystems, final: Final, exit_path: Sequence[Place], height_m: float
    ) -> None:
        super().__init__(systems)
        self.final = final
        self.exit_path = exit_path
        self._height = height_m
        self._lever = systems.airframe.throttle()
        flare = systems.kind.landing.flare
        self._time_constant = flare.time_constant_s
        self._touchdown_rate = flare.touchdown_rate_fpm * FOOT_PER_MINUTE
        self._idle_part = flare.idle_height_part
        self._decrab_height = flare.decrab_height_m

    def leave_at(self, exit_path: Sequence[Place]) -> None:
        """Leave the runway by another path."""
        self.exit_path = exit_path

    def fly(self, state: AircraftState) -> FlightPhase:
        """Fly one tick."""
        systems, final = self._systems, self.final
        if systems.airframe.on_ground():
            return Rollout(systems, final, self.exit_path).fly(state)
        height = max(systems.airframe.main_wheel_height_m(state), 0.0)
        sink_rate = height / self._time_constant + self._touchdown_rate
        power = (height / self._height - self._idle_part) / (1.0 - self._idle_part)
        systems.autopilot.flare(
            state,
            final.turn_rate(state),
            -sink_rate,
            sink_rate / self._time_constant,
            self._lever * min(max(power, 0.0), 1.0),
            final.crab_rad(state) if height < self._decrab_height else None,
        )
        return self


class Rollout(FlightPhase):
    """Lowers the nose, brakes along the centre line to taxi speed, then leaves the runway.

    Without an exit path, or if its beginning is passed too fast to turn, the aircraft stops on the
    centre line.
    """

    name = "rollout"
    may_touch = True

    def __init__(self, systems: AircraftSystems, final: Final, exit_path: Sequence[Place]) -> None:
        super().__init__(systems)
        self._final = final
        self._deceleration = systems.kind.ground.deceleration_m_s2
        self.leave_at(exit_path)
        systems.ground.reset(systems.autopilot.steady_elevator())
        systems.airframe.set_speed_brakes(1.0)
        systems.airframe.set_ground_spoilers(1.0)

    @property
    def final(self) -> Final:
        """Line along the runway."""
        return self._final

    def leave_at(self, exit_path: Sequence[Place]) -> None:
        """Leave the runway by another path."""
        ground = self._systems.kind.ground
        self._exit = (
            TaxiPath(exit_path, ground.taxi_speed_kt * KNOT, ground.look_ahead_m)
            if exit_path
            else None
        )

    def fly(self, state: AircraftState) -> FlightPhase:
        """Fly one tick."""
        ground, final = self._systems.ground, self._final
        speed = state.ground_speed_m_s
        ground.lower_nose()
        ground.follow_line(
            state, final.cross_track_m(state), final.course_rad(state), slipping=False
        )
        deceleration = self._deceleration
        if self._exit is not None:
            to_go = -self._exit.along_m(state)
            exit_speed = self._exit.speed_m_s(0.0)
            if to_go < LEAD_S * speed and speed < exit_speed + EXIT_MARGIN_M_S:
                return Taxi(self._systems, self._exit, "vacate", "standing").fly(state)
            if speed <= exit_speed and to_go > 0.0:
                ground.hold_speed(state, exit_speed)
                return self
            if to_go > 0.0:
                needed = (speed**2 - exit_speed**2) / (2.0 * max(to_go - LEAD_S * speed, 1.0))
                deceleration = min(max(needed, 0.0), GREATEST_DECELERATION_M_S2)
        if speed < STANDING_M_S:
            return Standing(self._systems).fly(state)
        if self._systems.airframe.nose_on_ground():
            ground.slow_down(state, deceleration)
        return self
