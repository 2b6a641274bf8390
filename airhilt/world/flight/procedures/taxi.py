"""Taxi: along a path, holding on the way, and standing at its end."""

from __future__ import annotations

from typing import Literal

from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.state import AircraftState
from airhilt.world.flight.taxi_path import TaxiPath

AT_REST_M_S = 0.05
"""Ground speed in m/s below which the brakes hold an aircraft where it is."""
END_M = 2.0
"""Distance to the end of its path, in m, at which an aircraft that stands has reached it."""

Stand = Literal["standing", "lined_up"]
Way = Literal["taxi", "line_up", "vacate"]


class Standing(FlightPhase):
    """Stands with the brakes set; ``lined_up`` on a runway, ready to take off.

    ``at_rest`` is true once it has come to rest: nothing moves it any more.
    """

    may_touch = True

    def __init__(self, systems: AircraftSystems, name: Stand = "standing") -> None:
        super().__init__(systems)
        self.name = name
        self.at_rest = False

    def fly(self, state: AircraftState) -> FlightPhase:
        """Stand one tick."""
        if not self.at_rest:
            self._systems.ground.hold_speed(state, 0.0)
            self.at_rest = state.ground_speed_m_s < AT_REST_M_S
        return self


class Taxi(FlightPhase):
    """Follows a path and stands at its end.

    The name of the phase is that of the way, and ``standing`` while the aircraft is held.
    """

    may_touch = True

    def __init__(self, systems: AircraftSystems, path: TaxiPath, way: Way, then: Stand) -> None:
        super().__init__(systems)
        self._path = path
        self.name = way
        self._way = way
        self._then = then
        self._holding = False
        systems.airframe.set_speed_brakes(0.0)
        systems.airframe.set_ground_spoilers(0.0)
        systems.ground.reset()

    def hold(self) -> None:
        """Stop on the way."""
        self._holding = True

    def resume(self) -> None:
        """Go on after a hold."""
        self._holding = False
        self.name = self._way
        self._systems.ground.reset()

    def fly(self, state: AircraftState) -> FlightPhase:
        """Taxi one tick."""
        ground, path = self._systems.ground, self._path
        along = path.along_m(state)
        slow = state.ground_speed_m_s < AT_REST_M_S
        self.name = "standing" if slow and self._holding else self._way
        if slow and not self._holding and path.length_m - along < END_M:
            return Standing(self._systems, self._then).fly(state)
        ground.lower_nose()
        ground.steer(state, path.yaw_rate(state, along))
        ground.hold_speed(state, 0.0 if self._holding else path.speed_m_s(along))
        return self
