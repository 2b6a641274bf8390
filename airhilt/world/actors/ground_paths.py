"""Ways over the airport, for crews and drivers alike."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from airhilt.commands import TaxiCommand
from airhilt.errors import ScenarioError
from airhilt.geodesy.positions import HoldShortPosition
from airhilt.geodesy.wgs84 import Place, azimuth, distance_m, onward
from airhilt.units import wrap_angle
from airhilt.world.actors.actor import Unable
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.runway import RunwayEnd

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Exit, Hold, Layout

NOSE_MARGIN_M = 3.0
"""Kept between the nose and a hold line."""
HOLD_REACH_M = 150.0
"""From a hold-short position, an aircraft within this can line up by it."""
TOUCHDOWN_M = 450.0
"""Past the threshold, where a normal landing has touched down."""
BRAKING_M_S2 = 2.0
"""Of a firm rollout."""
EXIT_SPEED_M_S = 8.0
"""At which a taxiway is turned on to."""


def taxi_path(site: ScenarioSite, here: Place, command: TaxiCommand, nose_m: float) -> list[Place]:
    """Return the way to the end of a taxi command, its last place for the actor's centre.

    Short of a hold line the nose stops before it.

    Raises
    ------
    Unable
        There is no such way.
    """
    try:
        end = site.place(command.to)
        if command.off_taxiways:
            return [here, end]
        path = site.airport.taxi_route(here, end, command.via)
    except ScenarioError as error:
        raise Unable(str(error)) from None
    if isinstance(command.to, HoldShortPosition):
        return shortened(path, nose_m + NOSE_MARGIN_M)
    return path


def shortened(path: list[Place], by_m: float) -> list[Place]:
    """Return a path without its last metres; at least its first place is left."""
    left = list(path)
    while len(left) > 1:
        length = distance_m(left[-2], left[-1])
        if length > by_m:
            back = azimuth(left[-1], left[-2])
            return [*left[:-1], onward(left[-1], back, by_m)]
        by_m -= length
        left.pop()
    return left


def hold_beside(site: ScenarioSite, here: Place, runway: str) -> Hold:
    """Return the hold-short position of a runway at which an actor stands.

    Raises
    ------
    Unable
        It stands at none.
    """
    airport = site.airport
    try:
        strip = airport.strip_of(runway)
    except ScenarioError as error:
        raise Unable(str(error)) from None
    holds = [hold for hold in airport.holds.values() if hold.runway == strip.name]
    nearest = min(holds, key=lambda hold: distance_m(here, hold.place), default=None)
    if nearest is None or distance_m(here, nearest.place) > HOLD_REACH_M:
        raise Unable(f"unable, not at a hold-short position of runway {runway}")
    return nearest


def exit_for(
    site: ScenarioSite, runway: RunwayEnd, speed_m_s: float, name: str | None
) -> Exit | None:
    """Return the exit by that name, or the first that a normal rollout makes; None: none does.

    Raises
    ------
    Unable
        The runway has no exit of that name.
    """
    exits = site.airport.exits(runway.ident)
    if name is not None:
        named = [each for each in exits if name in (each.taxiway, each.position)]
        if not named:
            known = ", ".join(dict.fromkeys(each.position for each in exits)) or "none"
            raise Unable(f"unable, runway {runway.ident} has no exit {name}; there are: {known}")
        return named[-1]
    needed_m = TOUCHDOWN_M + (speed_m_s**2 - EXIT_SPEED_M_S**2) / (2.0 * BRAKING_M_S2)
    made = [each for each in exits if each.along_m >= needed_m]
    if not made:
        return None
    # Where a taxiway crosses the runway, to the side of the stands.
    stands = [site.airport.node(stand) for stand in site.airport.stands]
    both_sides = [each for each in made if each.along_m < made[0].along_m + 1.0]
    return min(
        both_sides,
        key=lambda way: min((distance_m(way.path[-1], stand) for stand in stands), default=0.0),
    )


class FinalApproach:
    """Where an aircraft is with regard to a final approach, cheap enough to ask all the time."""

    def __init__(self, airport: Layout, runway: RunwayEnd) -> None:
        self.runway = runway
        self._frame = airport.frame
        self._east, self._north = airport.frame.to_local(runway.threshold)
        self._sin, self._cos = math.sin(runway.course_rad), math.cos(runway.course_rad)

    def before_m(self, here: Place) -> float:
        """Return the distance to the threshold along the approach, negative beyond it."""
        east, north = self._off_threshold(here)
        return -(east * self._sin + north * self._cos)

    def right_m(self, here: Place) -> float:
        """Return the distance to the right of the approach."""
        east, north = self._off_threshold(here)
        return east * self._cos - north * self._sin

    def angle_rad(self, track_rad: float) -> float:
        """Return the angle of a track against the approach, positive to the right."""
        return wrap_angle(track_rad - self.runway.course_rad)

    def _off_threshold(self, here: Place) -> tuple[float, float]:
        east, north = self._frame.to_local(here)
        return east - self._east, north - self._north
