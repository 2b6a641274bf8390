"""Flight progress strips: what the units know of each actor from the radio."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from airhilt.phraseology import Action, agree
from airhilt.sensors.radio.radio_call import HeardCall, RadioCall
from airhilt.sensors.radio.stations import Stations
from airhilt.sim import Director
from airhilt.world.actors.listening import words

RUNWAY_USES: frozenset[Action] = frozenset(
    {"cleared_to_land", "touch_and_go", "stop_and_go", "low_approach", "cleared_option",
     "cleared_for_takeoff", "line_up", "cross", "proceed", "backtrack", "go_around",
     "cancel_takeoff", "cancel_landing", "vacate", "hold_short", "hold_position", "stop"}
)  # fmt: skip
"""Instructions after which an earlier one about the use of a runway is not in force any more."""
LANDING: frozenset[Action] = frozenset(
    {"cleared_to_land", "touch_and_go", "stop_and_go", "low_approach", "cleared_option"}
)
ENTERING: frozenset[Action] = frozenset({"cross", "proceed", "backtrack"})
DEPARTING: frozenset[Action] = frozenset({"cleared_for_takeoff", "line_up"})


class Contact(NamedTuple):
    """A unit that works an actor, and the frequency on which it does."""

    unit: str
    frequency_khz: int


@dataclass(slots=True)
class Strip:
    """What is known of one actor."""

    contact: Contact | None = None
    """The last exchange; None before the first."""
    instructions: list[RadioCall] = field(default_factory=list)
    """Calls of units with instructions for it, in the order in which they were made."""
    runway_use: Action | None = None
    """The last instruction about the use of a runway."""
    runway: str | None = None
    """The runway of that instruction."""
    read_back: set[str] = field(default_factory=set)
    """Ids of the calls to it that it has read back as they were."""
    told_ns: int = 0
    """End of the last call with instructions for it."""
    follows_ra: bool = False
    """True from its report of a TCAS RA to its "clear of conflict"."""


class Strips:
    """The strips of all units: a unit passes a strip on with the aircraft."""

    def __init__(self, stations: Stations, director: Director) -> None:
        self._stations = stations
        self._director = director
        self._strips: dict[str, Strip] = {}

    def of(self, callsign: str) -> Strip:
        """Return the strip of an actor."""
        return self._strips.setdefault(callsign, Strip())

    def said(self, call: RadioCall) -> None:
        """Note a call that a unit has made to an actor."""
        callsign = call.addressed
        if callsign is None or not self._stations.is_actor(callsign):
            return
        strip = self.of(callsign)
        strip.contact = Contact(call.speaker, call.frequency_khz)
        instructions = self._stations.listener(call.frequency_khz).parse(call.said).instructions
        if instructions:
            strip.instructions.append(call)
            strip.told_ns = self._director.now_ns
        for each in instructions:
            if each.action in RUNWAY_USES and not each.is_conditional:
                strip.runway_use, strip.runway = each.action, each.runway or strip.runway

    def heard(self, heard: HeardCall) -> bool:
        """Note a call of an actor as a unit has heard it; return whether it is a wrong readback."""
        call, unit, text = heard.call, heard.listener, heard.text
        strip = self.of(call.speaker)
        strip.contact = Contact(unit, call.frequency_khz)
        said = " ".join(words(text))
        if "tcas ra" in said or "t c a s r a" in said:
            strip.follows_ra = True
        elif "clear of conflict" in said:
            strip.follows_ra = False
        parse = self._stations.listener(call.frequency_khz).parse
        if any(each.action == "go_around" for each in parse(text).instructions):
            strip.runway_use = "go_around"
        told = call.in_reply_to
        if told is None or (told.speaker, told.addressed) != (unit, call.speaker):
            return False
        meant = parse(told.said).instructions
        actions = {each.action for each in meant}
        read = [each for each in parse(text).instructions if each.action in actions]
        is_right = all(any(agree(one, other) for other in meant) for one in read)
        if read and is_right:
            strip.read_back.add(told.id)
        return not is_right

    def contact(self, callsign: str) -> Contact | None:
        """Return who works an actor: the unit of the last exchange.

        Before the first, it is the unit on the frequency on which the actor is expected; None
        without one, and for what is no actor of the scenario.
        """
        if not self._stations.is_actor(callsign):
            return None
        known = self.of(callsign).contact
        if known is not None:
            return known
        for frequency_khz in self._stations.frequencies_of(callsign):
            on = self._stations.on(frequency_khz)
            unit = next((name for name in on if not self._stations.is_actor(name)), None)
            if unit is not None:
                return Contact(unit, frequency_khz)
        return None
