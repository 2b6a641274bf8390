"""Ways off a runway for an actor that stands or taxies on it."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from airhilt.commands import VacateCommand
from airhilt.errors import ScenarioError
from airhilt.geodesy.wgs84 import Place, azimuth, distance_and_azimuth
from airhilt.units import wrap_angle
from airhilt.world.actors.actor import Unable
from airhilt.world.actors.errand import Errand
from airhilt.world.actors.runway_turns import RunwayTurns
from airhilt.world.actors.taxi_paths import exits_named
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.ways import NOSE_MARGIN_M

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Layout
    from airhilt.world.surface.strips import RunwayStrip

TURN_COST_M = 300.0
"""Length of the way to an exit, in m, that is preferred to a turn on the runway; assumed."""


class _Way(NamedTuple):
    cost_m: float
    places: list[Place]


def way_off(
    site: ScenarioSite,
    strip: RunwayStrip,
    here: Place,
    heading_rad: float,
    nose_m: float,
    command: VacateCommand,
) -> list[Place]:
    """Return the shortest way off a runway that a command allows, to where the tail is clear.

    The actor is at a place, points in a true heading, and is twice ``nose_m`` long. `Unable` says
    that there is no such way.
    """
    ways = [
        *_along_the_runway(site, strip, here, heading_rad, command),
        *_from_here(site, strip, here, heading_rad, nose_m, command),
    ]
    if not ways:
        where = command.exit or (f"to the {command.side}" if command.side else "here")
        raise Unable(f"unable, no way off the runway {where}")
    return min(ways, key=lambda way: way.cost_m).places


def clear_of_line(
    airport: Layout, places: Sequence[Place], line_m: float, nose_m: float
) -> list[Place]:
    """Return a way, cut where the tail is past a hold line that is so many metres along it."""
    # Not at the top: scenarios without an airport start without the libraries behind it.
    from airhilt.world.surface import path as lines

    points = [airport.local_frame.to_local(place) for place in places]
    cut = lines.cut(points, line_m + nose_m + NOSE_MARGIN_M)
    return [airport.local_frame.to_place(*point) for point in cut]


def _along_the_runway(
    site: ScenarioSite, strip: RunwayStrip, here: Place, heading_rad: float, command: VacateCommand
) -> Iterator[_Way]:
    """Yield the ways to exits further on along the runway, in both directions."""
    for end in strip.ends:
        turns = abs(wrap_angle(heading_rad - end.course_rad)) > math.pi / 2.0
        if turns and command.side is not None:
            continue
        round_m, before = 0.0, list[Place]()
        if turns:
            (other,) = (each for each in strip.ends if each is not end)
            round_m = TURN_COST_M
            before = RunwayTurns(other).back_from(_along_m(other.start, other.course_rad, here))
        here_m = _along_m(end.threshold, end.course_rad, here)
        with contextlib.suppress(Unable):
            for way in exits_named(site, end, command.exit, command.side):
                if way.along_m - here_m > round_m / 2.0:
                    yield _Way(way.along_m - here_m + round_m, [*before, *way.path])


def _from_here(
    site: ScenarioSite,
    strip: RunwayStrip,
    here: Place,
    heading_rad: float,
    nose_m: float,
    command: VacateCommand,
) -> Iterator[_Way]:
    """Yield the ways off by the taxiways next to the actor."""
    airport = site.airport
    for hold in airport.holds.values():
        if hold.runway != strip.name:
            continue
        if command.exit not in (None, hold.taxiway, hold.position):
            continue
        bearing_rad = wrap_angle(azimuth(here, hold.place) - heading_rad)
        if command.side is not None and (bearing_rad > 0.0) != (command.side == "right"):
            continue
        with contextlib.suppress(ScenarioError):
            places, line_m = airport.way_off(here, hold, heading_rad)
            errand = Errand(
                airport, [here, *places], nose_m, None, before_end_m=0.0, overhangs=False
            )
            if errand.stays_on(strip.name, line_m):
                turns = abs(bearing_rad) > math.pi / 2.0
                cut = clear_of_line(airport, places, line_m, nose_m)
                yield _Way(line_m + (TURN_COST_M if turns else 0.0), cut)


def _along_m(start: Place, course_rad: float, place: Place) -> float:
    """Return how far a place is from another along a course, in m."""
    away_m, bearing_rad = distance_and_azimuth(start, place)
    return away_m * math.cos(bearing_rad - course_rad)
