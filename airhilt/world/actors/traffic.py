"""Other actors as one of them sees them: which is meant, and when it has passed."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Mapping, Sequence
from typing import Literal

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.relative_motion import horizontal_distance_m
from airhilt.geodesy.wgs84 import Place
from airhilt.phraseology import parse_call
from airhilt.phraseology.say import speak_callsign
from airhilt.scenario.models import VehicleSpec
from airhilt.world.actors.actor import Actor, Unable
from airhilt.world.flight.aircraft import Aircraft

SIGHT_M = 10_000.0
"""Greatest distance in m at which traffic is seen; assumed: the visibility from which weather
reports do not count any more (ICAO Annex 3, appendix 3, 4.2.4.4)."""
STANDS_M_S = 1.0
"""Ground speed in m/s below which traffic stands."""
PASSED_BY_M = 50.0
"""Growth of the distance from its least, in m, by which traffic has passed; assumed: more than half
the length of most airliners."""
OVER_RUNWAY_M = 30.0
"""Height in m below which landing traffic is over the runway: at 3 degrees, 270 m before the
touchdown zone."""
EMPTY = frozenset(
    {"the", "a", "an", "that", "to", "of", "on", "in", "from", "for", "with", "and", "at", "your",
     "you", "left", "right", "side", "front", "behind", "ahead", "opposite", "next", "number",
     "one", "has", "is", "passed", "traffic", "aircraft", "airplane", "plane", "short", "mile",
     "taxiway", "runway"}
)  # fmt: skip
"""Words around the name of other traffic that do not tell it from others."""
Passing = Literal["landing", "departing", "passing"]
"""Movement of traffic when it passes."""
DOING: Mapping[str, frozenset[str]] = {
    "final": frozenset({"en_route", "approach", "orbit", "glide", "flare"}),
    "landing": frozenset({"glide", "flare", "rollout"}),
    "arriving": frozenset({"glide", "flare", "rollout", "vacate"}),
    "arrival": frozenset({"glide", "flare", "rollout", "vacate"}),
    "departing": frozenset({"line_up", "lined_up", "takeoff_roll", "rotate", "climb_out"}),
    "departure": frozenset({"line_up", "lined_up", "takeoff_roll", "rotate", "climb_out"}),
    "takeoff": frozenset({"line_up", "lined_up", "takeoff_roll", "rotate", "climb_out"}),
    "taxiing": frozenset({"taxi", "vacate", "driving"}),
    "vacating": frozenset({"vacate"}),
}
"""Phases in which traffic does what a word says."""
VEHICLES = frozenset({"vehicle", "car", "truck"})


def passing(words: Collection[str]) -> Passing:
    """Return what traffic does when it passes, as words about it say."""
    phases = frozenset[str]().union(*(DOING[word] for word in words if word in DOING))
    if "flare" in phases:
        return "landing"
    return "departing" if "takeoff_roll" in phases else "passing"


class Traffic:
    """The other aircraft and vehicles of a scenario, as one of its actors sees them."""

    def __init__(self, own: str, actors: Mapping[str, Actor]) -> None:
        self._own = own
        self._actors = actors

    def named(self, words: str) -> Actor:
        """Return the actor in sight that words name: its callsign, its type, what it does.

        Raises
        ------
        Unable
            There is none, or more than one.
        """
        others = self._others
        callsigns = [actor.spec.callsign for actor in others]
        by_callsign = words if words in callsigns else parse_call(words, callsigns).callsign
        meant = [
            actor
            for actor in others
            if (actor.spec.callsign == by_callsign if by_callsign else self._fits(actor, words))
        ]
        seen = [actor for actor in meant if self._sees(actor)]
        if not seen:
            raise Unable(f"unable, {words} not in sight")
        if len(seen) > 1:
            raise Unable(f"say again, which {words}")
        return seen[0]

    def passage(self, other: Actor, does: Passing) -> Passage:
        """Return a watch over another actor until it has passed."""
        return Passage(self._actors[self._own], other, does)

    def is_on(self, path: Sequence[Place]) -> bool:
        """Return whether somebody stands so near a path that the actor would run into it."""
        for other in (actor.body for actor in self._others):
            lengths_m = self._actors[self._own].body.dimensions.length_m + other.dimensions.length_m
            stands = other.on_ground and other.state.ground_speed_m_s < STANDS_M_S
            if stands and _away_m(path, other.state.place) < lengths_m / 2.0:
                return True
        return False

    @property
    def _others(self) -> list[Actor]:
        return [
            actor
            for callsign, actor in self._actors.items()
            if callsign != self._own and actor.category != "wildlife" and actor.body.ended is None
        ]

    def _sees(self, actor: Actor) -> bool:
        own = self._actors[self._own].body.state
        return horizontal_distance_m(own, actor.body.state) <= SIGHT_M

    def _fits(self, actor: Actor, words: str) -> bool:
        told = [word for word in _words(words) if word not in EMPTY]
        if not told:
            return actor.category == "aircraft"
        return all(self._is(actor, word) for word in told)

    def _is(self, actor: Actor, word: str) -> bool:
        """Return whether a word is true of an actor."""
        if word in DOING:
            return actor.body.phase in DOING[word]
        callsign = actor.spec.callsign
        if word == "company":
            return callsign[:3] == self._own[:3] and callsign[:3].isalpha()
        names = f"{callsign} {speak_callsign(callsign, 'faa')}"
        if isinstance(actor.spec, VehicleSpec):
            return word in VEHICLES or word in _words(f"{names} {actor.spec.kind}")
        if word == "heavy":
            return actor.emitter_category == "A5"
        if isinstance(actor.body, Aircraft):
            kind = actor.body.kind
            numbers = " ".join(re.findall(r"\d+", kind.icao_designator))
            names += f" {kind.name} {kind.icao_designator} {kind.description} {numbers}"
        return word in _words(names)


class Passage:
    """A watch over other traffic until it has passed: it has come near, and goes away again."""

    def __init__(self, own: Actor, other: Actor, does: Passing) -> None:
        self._own = own
        self._other = other
        self._does = does
        self._nearest_m = math.inf

    def is_over(self) -> bool:
        """Return whether it has passed; asked several times a second."""
        other = self._other.body
        if other.ended is not None:
            return True
        if not self._has_begun():
            return False
        away_m = horizontal_distance_m(self._own.body.state, other.state)
        self._nearest_m = min(self._nearest_m, away_m)
        return away_m > self._nearest_m + PASSED_BY_M

    def _has_begun(self) -> bool:
        other = self._other.body
        if self._does == "landing":
            return other.on_ground or other.state.height_agl_m < OVER_RUNWAY_M
        if self._does == "departing":
            return not other.on_ground or other.phase in ("takeoff_roll", "rotate")
        return True


def _away_m(path: Sequence[Place], place: Place) -> float:
    """Return the distance of a place from a path."""
    # Not at the top: scenarios without an airport start without the libraries behind it.
    from shapely import LineString, Point

    to_local = LocalFrame(place).to_local
    return float(LineString([to_local(each) for each in path]).distance(Point(0.0, 0.0)))


def _words(text: str) -> list[str]:
    return re.findall(r"[a-z0-9]+", text.lower().replace("_", " "))
