"""Paths over the airport for crews and drivers: taxi routes, hold-short positions, exits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from airhilt.commands import Side, TaxiCommand
from airhilt.errors import ScenarioError
from airhilt.geodesy.wgs84 import Place, distance_and_azimuth, distance_m, onward
from airhilt.units import wrap_angle
from airhilt.world.actors.actor import Unable
from airhilt.world.actors.taxi_clearances import require_taxiway, strip_name
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.runway import RunwayEnd
from airhilt.world.surface.ways import NOSE_MARGIN_M, taxi_way

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Exit, Hold

HOLD_REACH_M = 150.0
"""Greatest distance from a hold-short position at which an aircraft lines up from it, in m."""
ASIDE_M = 30.0
"""Greatest distance from the line of a taxiway at which an actor stands on it, in m; assumed: that
of a bend just before the hold line."""
TOUCHDOWN_M = 450.0
"""Distance past the threshold at which a normal landing has touched down, in m."""
BRAKING_M_S2 = 2.0
"""Deceleration of a firm rollout, in m/s2."""
FIRM_BRAKING_M_S2 = 3.0
"""Greatest deceleration for an exit that a controller names, in m/s2: about an autobrake's highest
landing setting."""
EXIT_SPEED_M_S = 8.0
"""Speed of the turn onto a taxiway, in m/s."""
CREEP_M = 60.0
"""Length of the slow way to a place to hold short on a runway, in m; assumed."""


def taxi_path(site: ScenarioSite, here: Place, command: TaxiCommand, nose_m: float) -> list[Place]:
    """Return the path of a taxi command for the actor's centre.

    If it ends at a hold line, the nose stops before the line. `Unable` says that there is no path.
    """
    try:
        return taxi_way(site, here, command, nose_m)
    except ScenarioError as error:
        raise Unable(str(error)) from None


def hold_beside(
    site: ScenarioSite, here: Place, runway: str, heading_rad: float | None = None
) -> Hold:
    """Return the hold-short position of a runway at which an actor stands, or raise `Unable`.

    The actor stands on its taxiway before the line, or beyond the line already. With a heading, it
    points to the runway.
    """
    airport = site.airport
    strip = airport.strips[strip_name(airport, runway)]
    is_inside = strip.protects(airport.local_frame.to_local(here))
    holds = [
        hold
        for hold in airport.holds.values()
        if hold.runway == strip.name
        and distance_m(here, hold.place) <= HOLD_REACH_M
        and (is_inside or _is_beside(hold, here, heading_rad))
    ]
    if not holds:
        raise Unable(f"unable, not at a hold-short position of runway {runway}")
    return min(holds, key=lambda hold: distance_m(here, hold.place))


def _is_beside(hold: Hold, here: Place, heading_rad: float | None) -> bool:
    """Return whether an actor stands on the taxiway of a hold, and points to the runway."""
    away_m, bearing_rad = distance_and_azimuth(here, hold.place)
    aside_m = abs(away_m * math.sin(bearing_rad - hold.heading_rad))
    turn_rad = 0.0 if heading_rad is None else abs(wrap_angle(hold.heading_rad - heading_rad))
    return aside_m <= ASIDE_M and turn_rad <= math.pi / 2.0


def exits_named(
    site: ScenarioSite, runway: RunwayEnd, name: str | None, side: Side | None
) -> list[Exit]:
    """Return the exits of a name, and of a side; all of them for None.

    `Unable` says that the runway has no exit of that name or side.
    """
    exits = site.airport.exits(runway.ident)
    if name is not None:
        exits = [each for each in exits if name in (each.taxiway, each.position)]
        if not exits:
            require_taxiway(site.airport, name)
            raise Unable(f"unable, runway {runway.ident} has no exit {name}")
    if side is not None:
        exits = [each for each in exits if (each.turn_rad > 0.0) == (side == "right")]
        if not exits:
            raise Unable(f"unable, no exit {name or ''} to the {side}".replace("  ", " "))
    return exits


def exit_for(
    site: ScenarioSite, runway: RunwayEnd, speed_m_s: float, name: str | None
) -> Exit | None:
    """Return the named exit, or the first that a normal rollout can take; None if there is none.

    `Unable` says that the runway has no exit of that name.
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
    # Where a taxiway crosses the runway, the exit is on the side of the stands.
    stands = [site.airport.node(stand) for stand in site.airport.stands]
    both_sides = [each for each in made if each.along_m < made[0].along_m + 1.0]
    return min(
        both_sides,
        key=lambda way: min((distance_m(way.path[-1], stand) for stand in stands), default=0.0),
    )


def path_short_of(
    site: ScenarioSite, runway: RunwayEnd, crossing: str, speed_m_s: float, nose_m: float
) -> list[Place]:
    """Return the way of a landing that stays short of a runway that crosses its own.

    It leaves by the first exit that a normal rollout can take, if that is short of the other
    runway, or ends on the runway. `Unable` says that there is not enough runway for either.
    """
    # Not at the top: scenarios without an airport start without the libraries behind it.
    from shapely import LineString, Point

    airport = site.airport
    strip = airport.strips[strip_name(airport, crossing)]
    if runway in strip.ends:
        raise Unable(f"unable, landing on runway {runway.ident}")
    way_out = exit_for(site, runway, speed_m_s, None)
    if way_out is not None and stays_short_of(site, runway, crossing, way_out.path):
        return list(way_out.path)
    to_local, area = airport.local_frame.to_local, strip.protected_area
    length_m = runway.length_m - runway.displaced_m
    far_end = onward(runway.threshold, runway.course_rad, length_m)
    first = Point(to_local(runway.threshold))
    crossed = LineString([first, to_local(far_end)]).intersection(area)
    free_m = length_m if crossed.is_empty else first.distance(crossed)
    stop_m = free_m - nose_m - NOSE_MARGIN_M
    if TOUCHDOWN_M + speed_m_s**2 / (2.0 * BRAKING_M_S2) > stop_m:
        raise Unable(f"unable to land and hold short of runway {crossing}")
    return [
        onward(runway.threshold, runway.course_rad, along_m)
        for along_m in (stop_m - CREEP_M, stop_m)
    ]


def stays_short_of(
    site: ScenarioSite, runway: RunwayEnd, crossing: str, path: Sequence[Place]
) -> bool:
    """Return whether a landing with a path off the runway stays short of another runway."""
    from shapely import LineString

    airport = site.airport
    way = LineString([airport.local_frame.to_local(each) for each in (runway.threshold, *path)])
    return bool(way.disjoint(airport.strip_of(crossing).protected_area))
