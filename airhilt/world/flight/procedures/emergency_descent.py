"""The emergency descent: idle, speed brakes where there are any, nearly as fast as allowed."""

from __future__ import annotations

from airhilt.units import DEGREE, KNOT
from airhilt.world.flight.guidance import Airspeed
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.procedures.en_route import EnRoute
from airhilt.world.flight.state import AircraftState

AIRSPEED_MARGIN = 10.0 * KNOT
"""Margin below the greatest speed, in m/s."""
MACH_MARGIN = 0.02
"""Margin below the greatest Mach number."""
STEEPEST_DESCENT = 9.0 * DEGREE
"""Steepest descent while the airspeed builds up, in rad."""


class EmergencyDescent:
    """Descends as fast as the aircraft safely can, and levels off into what follows.

    Parameters
    ----------
    systems
        Airframe, autopilot and ground law.
    then
        En route on the track and to the altitude that follow.
    """

    name = "emergency_descent"
    commandable = True
    may_touch = False

    def __init__(self, systems: AircraftSystems, then: EnRoute) -> None:
        self._systems = systems
        self._then = then
        speeds = systems.kind.speeds
        self._speed = Airspeed(
            speeds.maximum_kt * KNOT - AIRSPEED_MARGIN, speeds.maximum_mach - MACH_MARGIN
        )
        systems.airframe.set_speed_brakes(1.0)

    def fly(self, state: AircraftState) -> FlightPhase:
        """Fly one tick."""
        if self._then.vertical.captures(state):
            self._systems.airframe.set_speed_brakes(0.0)
            return self._then.fly(state)
        self._systems.autopilot.fly_on_pitch(
            state,
            self._then.lateral.turn_rate(state),
            self._speed.airspeed(state),
            0.0,
            steepest_descent=STEEPEST_DESCENT,
        )
        return self
