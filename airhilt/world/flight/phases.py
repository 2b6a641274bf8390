"""What a phase of flight is: it flies one tick and says which phase flies the next."""

from __future__ import annotations

from typing import NamedTuple, Protocol

from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.flight.airframe import Airframe
from airhilt.world.flight.autopilot import Autopilot
from airhilt.world.flight.ground import GroundLaw
from airhilt.world.flight.state import AircraftState


class Cockpit(NamedTuple):
    """What the phases fly with."""

    kind: AircraftType
    airframe: Airframe
    autopilot: Autopilot
    ground: GroundLaw
    tick_s: float
    """Between two calls of a phase."""


class FlightPhase(Protocol):
    """One phase of a procedure; each names the phase that follows it."""

    @property
    def name(self) -> str:
        """What it is, in the field's words, such as ``takeoff_roll``."""

    @property
    def commandable(self) -> bool:
        """Whether en-route commands change what it leads to; otherwise they end it."""

    @property
    def may_touch(self) -> bool:
        """Whether the wheels may be on the ground; otherwise ground contact ends the flight."""

    def fly(self, state: AircraftState) -> FlightPhase:
        """Set the controls for one tick; return the phase of the next, itself if it goes on."""
