"""Ways over an airport, from a place to the end of a taxi command."""

from __future__ import annotations

from airhilt.commands import TaxiCommand
from airhilt.geodesy.positions import HoldShortPosition
from airhilt.geodesy.wgs84 import Place, azimuth, distance_m, onward
from airhilt.world.site import ScenarioSite

NOSE_MARGIN_M = 3.0
"""Distance that is kept between the nose and a hold line, in m."""


def taxi_way(site: ScenarioSite, here: Place, command: TaxiCommand, nose_m: float) -> list[Place]:
    """Return the way to the end of a taxi command, its last place for the actor's centre.

    Short of a hold line the nose, which is ``nose_m`` ahead of the centre, stops before it.

    Raises
    ------
    ScenarioError
        There is no such way.
    """
    end = site.place(command.to)
    if command.off_taxiways:
        return [here, end]
    way = site.airport.taxi_route(here, end, command.via)
    if isinstance(command.to, HoldShortPosition):
        return shortened(way, nose_m + NOSE_MARGIN_M)
    return way


def shortened(way: list[Place], by_m: float) -> list[Place]:
    """Return a way without its last metres; at least its first place is left."""
    left = list(way)
    while len(left) > 1:
        length = distance_m(left[-2], left[-1])
        if length > by_m:
            back = azimuth(left[-1], left[-2])
            return [*left[:-1], onward(left[-1], back, by_m)]
        by_m -= length
        left.pop()
    return left
