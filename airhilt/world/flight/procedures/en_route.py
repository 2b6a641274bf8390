"""En route: the autopilot holds the commanded track, altitude and airspeed."""

from __future__ import annotations

from airhilt.world.flight.guidance import Airspeed, Altitude, LateralMode
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.state import AircraftState


class EnRoute:
    """Holds one mode in each direction; a command replaces one of them.

    Parameters
    ----------
    systems
        Airframe, autopilot and ground law.
    lateral, vertical, speed
        The modes.
    """

    name = "en_route"
    commandable = True
    may_touch = False

    def __init__(
        self, systems: AircraftSystems, lateral: LateralMode, vertical: Altitude, speed: Airspeed
    ) -> None:
        self._autopilot = systems.autopilot
        self.lateral = lateral
        self.vertical = vertical
        self.speed = speed

    def fly(self, state: AircraftState) -> FlightPhase:
        """Fly one tick."""
        self._autopilot.fly(
            state,
            self.lateral.turn_rate(state),
            self.vertical.vertical_rate(state),
            self.speed.airspeed(state),
        )
        return self
