"""Aircraft on the ground and vehicles as one sort of body, which moves along paths."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from airhilt.geodesy.wgs84 import Place, distance_m
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.flight.ground import STOP_DECELERATION_M_S2
from airhilt.world.mover import Driven, Motion
from airhilt.world.surface.vehicle import Vehicle

AT_END_M = 1.0
"""Distance to the end of its path, in m, within which a vehicle has reached it."""
LEAST_BRAKING_M_S2 = 1.0
"""Deceleration of a vehicle whose own is unknown, in m/s2; assumed: that of a tug with an aircraft
in tow."""


class GroundBody(Protocol):
    """A body that moves over the ground along paths."""

    @property
    def state(self) -> Motion:
        """Place and movement now."""

    @property
    def length_m(self) -> float:
        """Length from nose to tail."""

    @property
    def braking_m_s2(self) -> float:
        """Deceleration with which it stops on its path."""

    @property
    def is_airborne(self) -> bool:
        """True for an aircraft in the air."""

    @property
    def is_moving(self) -> bool:
        """True while it follows a path, and is not held on it."""

    @property
    def can_resume(self) -> bool:
        """True if there is something left of its path."""

    @property
    def is_rolling_out(self) -> bool:
        """True from a touchdown until the runway has been left, or the body stands."""

    @property
    def busy(self) -> str:
        """Why it cannot follow a path now, as it is said on the radio; empty if it can."""

    def go(self, path: Sequence[Place], speed_m_s: float | None) -> None:
        """Follow a path from here, and stop at its end."""

    def stop(self) -> None:
        """Stop on the path; no-op for one that stands."""

    def resume(self) -> None:
        """Go on along the path; ValueError if there is nothing left of it."""


class TaxiingAircraft:
    """An aircraft, moved over the ground by its crew."""

    braking_m_s2 = STOP_DECELERATION_M_S2

    def __init__(self, aircraft: Aircraft) -> None:
        self._aircraft = aircraft

    @property
    def state(self) -> Motion:
        """Place and movement now."""
        return self._aircraft.state

    @property
    def length_m(self) -> float:
        """Length from nose to tail."""
        return self._aircraft.kind.dimensions.length_m

    @property
    def is_airborne(self) -> bool:
        """True if no main wheel carries weight."""
        return not self._aircraft.on_ground

    @property
    def is_moving(self) -> bool:
        """True while it taxis."""
        return self._aircraft.phase in ("taxi", "line_up", "vacate")

    @property
    def can_resume(self) -> bool:
        """True if there is something left of its path."""
        return self._aircraft.procedures.is_taxiing

    @property
    def is_rolling_out(self) -> bool:
        """True from the touchdown until it stands, off the runway or on it."""
        return self._aircraft.phase in ("rollout", "vacate")

    @property
    def busy(self) -> str:
        """Why it cannot taxi now."""
        phase = self._aircraft.phase
        if phase in ("standing", "lined_up", "taxi", "line_up", "vacate"):
            return ""
        if phase in ("takeoff_roll", "rotate") and self._aircraft.on_ground:
            return "unable, already rolling"
        if phase == "rejected_takeoff":
            return "unable, rejecting takeoff"
        return "unable, still rolling" if self._aircraft.on_ground else "unable, airborne"

    def go(self, path: Sequence[Place], speed_m_s: float | None) -> None:
        """Taxi along a path from here, and stand at its end."""
        self._aircraft.procedures.taxi(path, speed_m_s)

    def stop(self) -> None:
        """Stop on the path."""
        self._aircraft.procedures.hold_position()

    def resume(self) -> None:
        """Go on along the path."""
        self._aircraft.procedures.resume_taxi()


class DrivenVehicle:
    """A vehicle, driven along paths."""

    is_airborne = False
    is_rolling_out = False
    busy = ""

    def __init__(self, body: Driven) -> None:
        self._body = body
        self._end: Place | None = None
        self.braking_m_s2 = (
            body.kind.braking_m_s2 if isinstance(body, Vehicle) else LEAST_BRAKING_M_S2
        )

    @property
    def state(self) -> Motion:
        """Place and movement now."""
        return self._body.state

    @property
    def length_m(self) -> float:
        """Length from nose to tail."""
        return self._body.dimensions.length_m

    @property
    def is_moving(self) -> bool:
        """True while it drives."""
        return self._body.phase == "driving"

    @property
    def can_resume(self) -> bool:
        """True if there is something left of its path."""
        return self._end is not None and distance_m(self.state.place, self._end) > AT_END_M

    def go(self, path: Sequence[Place], speed_m_s: float | None) -> None:
        """Drive along a path from here, and stop at its end."""
        self._body.drive(path, speed_m_s)
        self._end = path[-1]

    def stop(self) -> None:
        """Stop on the path."""
        self._body.stop()

    def resume(self) -> None:
        """Go on along the path."""
        self._body.resume()
