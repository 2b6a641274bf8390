"""Protocol of the phases of flight. A phase flies one tick and returns the phase of the next."""

from __future__ import annotations

from typing import NamedTuple, Protocol

from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.airframe import Airframe
from airhilt.world.flight.autopilot import Autopilot
from airhilt.world.flight.ground import GroundLaw
from airhilt.world.flight.state import AircraftState


class AircraftSystems(NamedTuple):
    """Airframe, autopilot and ground law with which the phases fly."""

    kind: AircraftType
    airframe: Airframe
    autopilot: Autopilot
    ground: GroundLaw
    tick_s: float
    """Time between two calls of a phase, in s."""


class FlightPhase(Protocol):
    """One phase of a procedure. It creates the phase that follows it."""

    @property
    def name(self) -> str:
        """Name of the phase, such as ``takeoff_roll``."""

    @property
    def commandable(self) -> bool:
        """True if en-route commands change the flight that follows this phase; else they end it."""

    @property
    def may_touch(self) -> bool:
        """True if the wheels may be on the ground; otherwise ground contact ends the flight."""

    def fly(self, state: AircraftState) -> FlightPhase:
        """Set the controls for one tick; return the phase of the next, itself if it goes on."""
