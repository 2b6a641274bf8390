"""Base class of the phases of flight, and the systems with which they fly."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import NamedTuple

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


class FlightPhase(ABC):
    """One phase of a procedure. It creates the phase that follows it.

    Attributes
    ----------
    name
        Name of the phase, such as ``takeoff_roll``.
    commandable
        True if en-route commands change the flight that follows this phase; else they end it.
    may_touch
        True if the wheels may be on the ground; otherwise ground contact ends the flight.
    """

    name: str
    commandable = False
    may_touch = False

    def __init__(self, systems: AircraftSystems) -> None:
        self._systems = systems

    @abstractmethod
    def fly(self, state: AircraftState) -> FlightPhase:
        """Set the controls for one tick; return the phase of the next, itself if it goes on."""
