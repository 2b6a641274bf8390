"""Where a taxi clearance leads: the places that controllers name, and the way to them."""

from __future__ import annotations

import difflib
import re
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from airhilt.commands import TaxiToCommand
from airhilt.errors import ScenarioError
from airhilt.geodesy.wgs84 import Place, distance_m
from airhilt.world.actors.actor import Unable

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Hold, Layout

FULL_LENGTH_M = 100.0
"""Holding positions that lead on to a runway within so much of the one nearest to its beginning, in
m, serve equally for a takeoff with its full length."""
STANDS = frozenset({"stand", "gate", "parking", "spot", "position"})
"""Words for a place where an aircraft stands."""
AREAS = frozenset({"ramp", "apron", "parking", "terminal", "stand", "gate", "base"})
"""Words for all places where aircraft and vehicles stand."""
EMPTY = frozenset({"the", "to", "your", "taxiway", "intersection", "holding", "point", "of", "at"})
"""Words around a name that do not belong to it."""


class TaxiWay(NamedTuple):
    """A way to where a controller says."""

    places: list[Place]
    is_hold: bool
    """True if it ends at a hold line, before which the nose stops."""


def way_to(
    airport: Layout, here: Place, heading_rad: float | None, command: TaxiToCommand
) -> TaxiWay:
    """Return the way of a taxi clearance from a place; `Unable` says why there is none."""
    for name in command.via:
        require_taxiway(airport, name)
    ends = _ends(airport, command)
    ways = []
    for end in ends:
        try:
            ways.append((end, airport.taxi_route(here, end, command.via, heading_rad)))
        except ScenarioError:
            continue
    if not ways:
        through = f" via {' '.join(command.via)}" if command.via else ""
        raise Unable(f"unable, no taxi route to {_said(command)}{through} from here")
    end, places = min(ways, key=lambda way: (_length_m(way[1]), way[0]))
    return TaxiWay(places, end in airport.holds)


def hold_of(airport: Layout, runway: str, taxiway: str, here: Place) -> Hold:
    """Return the holding position of a runway on a taxiway, the nearest if it has two.

    `Unable` says that there is none.
    """
    require_taxiway(airport, taxiway)
    strip = strip_name(airport, runway)
    holds = [
        hold
        for hold in airport.holds.values()
        if hold.runway == strip and taxiway in (hold.taxiway, hold.position)
    ]
    if not holds:
        raise Unable(f"unable, taxiway {taxiway} does not lead to runway {runway}")
    return min(holds, key=lambda hold: distance_m(here, hold.place))


def strip_name(airport: Layout, runway: str) -> str:
    """Return the name of the whole runway of a direction, such as ``01/19``, or raise `Unable`."""
    try:
        return airport.strip_of(runway).name
    except ScenarioError:
        known = [end.ident for strip in airport.strips.values() for end in strip.ends]
        raise Unable(
            f"unable, no runway {runway} at {airport.airport.icao}{_nearest(runway, known)}"
        ) from None


def require_taxiway(airport: Layout, name: str) -> None:
    """Raise `Unable` unless the airport has a taxiway of that name."""
    known = sorted({edge.taxiway for edge in airport.airport.taxiways.edges})
    if name not in known:
        raise Unable(f"unable, no taxiway {name} at {airport.airport.icao}{_nearest(name, known)}")


def _ends(airport: Layout, command: TaxiToCommand) -> list[str]:
    """Return the nodes any of which is the end of a clearance."""
    if command.runway is not None:
        return _holds_for(airport, command.runway, command.place, command.via)
    if command.place is None:
        return _short_of(airport, command)
    if found := _holds_on(airport, command.place, command.hold_short):
        return found
    if found := nodes_of(airport, command.place):
        return found
    known = [*airport.stands, *sorted({edge.taxiway for edge in airport.airport.taxiways.edges})]
    icao = airport.airport.icao
    raise Unable(f"unable, no {command.place} at {icao}{_nearest(command.place, known)}")


def _short_of(airport: Layout, command: TaxiToCommand) -> list[str]:
    """Return the ends of a call such as "taxi via K, hold short of runway 04"."""
    if not (command.via and command.hold_short):
        raise Unable("say again, taxi to where")
    name = command.hold_short[-1]
    if not name[:1].isdigit():
        require_taxiway(airport, name)
        return nodes_of(airport, name)
    strip = strip_name(airport, name)
    return _holds_on(airport, command.via[-1], (name,)) or [
        hold.name for hold in airport.holds.values() if hold.runway == strip
    ]


def _holds_on(airport: Layout, place: str, hold_short: Sequence[str]) -> list[str]:
    """Return the holding positions of a call such as "drive to D, hold short of runway 01"."""
    wanted = set(_words(place))
    return [
        hold.name
        for hold in airport.holds.values()
        if hold.taxiway.lower() in wanted
        and any(
            name in (end.ident for end in airport.strips[hold.runway].ends) for name in hold_short
        )
    ]


def _holds_for(airport: Layout, runway: str, place: str | None, via: Sequence[str]) -> list[str]:
    """Return the holding positions that a clearance to a runway may end at."""
    strip = airport.strips[strip_name(airport, runway)]
    holds = [hold for hold in airport.holds.values() if hold.runway == strip.name]
    if not holds:
        raise Unable(f"unable, no holding position of runway {runway}")
    if place is not None:
        wanted = set(_words(place))
        named = [
            hold.name
            for hold in holds
            if wanted & {hold.taxiway.lower(), hold.position.lower(), hold.name.lower()}
        ]
        if named:
            return named
        raise Unable(f"unable, {place} does not lead to runway {runway}")
    on_the_way = [hold.name for hold in holds if via and hold.taxiway == via[-1]]
    if on_the_way:
        return on_the_way
    end = airport.runway(runway)
    rolled = {
        hold.name: distance_m(end.start, airport.node(_on_centreline(airport, hold)))
        for hold in holds
    }
    first_m = min(rolled.values())
    return [name for name, metres in rolled.items() if metres <= first_m + FULL_LENGTH_M]


def _on_centreline(airport: Layout, hold: Hold) -> str:
    return airport.taxiways.to_centreline(hold.name, hold.runway)[-1]


def nodes_of(airport: Layout, place: str) -> list[str]:
    """Return the nodes of the taxiways that words name: a stand, a junction, a taxiway, an area."""
    if place in airport.taxiways.nodes:
        return [place]
    wanted = _words(place)
    stands = {stand: _words(stand) for stand in airport.stands}
    if same := [stand for stand, words in stands.items() if words == wanted]:
        return same
    bare = [word for word in wanted if word not in STANDS]
    if bare and (
        alike := [
            stand
            for stand, words in stands.items()
            if [word for word in words if word not in STANDS] == bare
        ]
    ):
        return alike
    if not set(wanted) & STANDS:
        on_it = [
            node
            for edge in airport.airport.taxiways.edges
            if [edge.taxiway.lower()] == wanted
            for node in edge.nodes
        ]
        if on_it and wanted[0] not in AREAS:
            return list(dict.fromkeys(on_it))
    if wanted and set(wanted) <= AREAS:
        return list(airport.stands)
    return []


def _words(place: str) -> list[str]:
    """Return the words of a place's name that tell it from others."""
    return [word for word in re.findall(r"[a-z0-9]+", place.lower()) if word not in EMPTY]


def _nearest(name: str, known: Sequence[str]) -> str:
    """Return the words that offer the name most like one that does not exist."""
    like = difflib.get_close_matches(name.lower(), [each.lower() for each in known], 1, 0.5)
    found = next((each for each in known if like and each.lower() == like[0]), None)
    return "" if found is None else f", there is {found.replace('_', ' ')}"


def _said(command: TaxiToCommand) -> str:
    if command.runway is None and command.place is None:
        return f"hold short of {command.hold_short[-1]}"
    return command.place or f"runway {command.runway}"


def _length_m(places: Sequence[Place]) -> float:
    return sum(distance_m(a, b) for a, b in pairwise(places))
