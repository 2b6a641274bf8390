"""Flight progress strips: what the units know of each actor from the radio."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from airhilt.phraseology import Action, agree
from airhilt.sensors.radio.radio_call import MOST_TIMES, HeardCall, RadioCall
from airhilt.sensors.radio.stations import Stations
from airhilt.sim import Director
from airhilt.units import SECOND_NS
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
ANSWERS_WITHIN_S = 5.0
"""Time in s in which a controller expects the answer to a call: an assumption."""


class Contact(NamedTuple):
    """A unit that works an actor, and the frequency on which it does."""

    unit: str
    frequency_khz: int


@dataclass(slots=True)
class Given:
    """An instruction to an actor, however often it was given."""

    call: RadioCall
    """The call that gave it last."""
    told_ns: int
    """End of that call."""
    readback: RadioCall | None = None
    """The last readback of it."""
    is_read_back: bool | None = None
    """True if it was read back as it was; None: it was not read back since that call."""


@dataclass(slots=True)
class Strip:
    """What is known of one actor."""

    contact: Contact | None = None
    """The last exchange; None before the first."""
    instructions: dict[RadioCall, Given] = field(default_factory=dict)
    """Instructions to it, by the calls that gave them first, in the order of the last ones."""
    correction: RadioCall | None = None
    """Call that gives an instruction again because of its readback; None once it is answered."""
    runway_use: Action | None = None
    """The last instruction about the use of a runway."""
    runway: str | None = None
    """The runway of that instruction."""
    follows_ra: bool = False
    """True from its report of a TCAS RA to its "clear of conflict"."""

    @property
    def last(self) -> Given | None:
        """Its last instruction; None before the first."""
        return next(reversed(self.instructions.values()), None)


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
            strip.instructions.pop(call.first, None)
            strip.instructions[call.first] = Given(call, self._director.now_ns)
        for each in instructions:
            if each.action in RUNWAY_USES and not each.is_conditional:
                strip.runway_use, strip.runway = each.action, each.runway or strip.runway

    def heard(self, heard: HeardCall) -> None:
        """Note a call of an actor as a unit has heard it."""
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
            return
        meant = parse(told.said).instructions
        actions = {each.action for each in meant}
        read = [each for each in parse(text).instructions if each.action in actions]
        is_right = all(any(agree(one, other) for other in meant) for one in read)
        given = strip.instructions.get(told.first)
        if read and given is not None:
            given.readback, given.is_read_back = call, is_right

    def misread(self, unit: str) -> Given | None:
        """Return an urgent instruction of a unit that was read back otherwise, and is not given up.

        A unit says it again, as often as every call is made.
        """
        of_unit = (
            given
            for strip in self._strips.values()
            for given in strip.instructions.values()
            if given.call.speaker == unit and given.call.is_urgent
        )
        wrong = (each for each in of_unit if each.is_read_back is False)
        return next((each for each in wrong if each.call.first.times_given < MOST_TIMES), None)

    def corrects(self, correction: RadioCall) -> None:
        """Note that a unit is to say a call by which it corrects a readback."""
        if correction.addressed is not None:
            self.of(correction.addressed).correction = correction

    def awaits_answer(self, unit: str, callsign: str) -> bool:
        """Return whether a unit has corrected an actor that has not answered yet."""
        correction = self.of(callsign).correction
        if correction is None or correction.speaker != unit or correction.first.is_given_up:
            return False
        given = self.of(callsign).instructions.get(correction.first)
        if callsign not in correction.taken_by or given is None:
            return self._stations.is_there(callsign)
        return self._director.now_ns - given.told_ns < ANSWERS_WITHIN_S * SECOND_NS

    def answered(self, call: RadioCall) -> None:
        """Note that a call of an actor has ended, which may answer a correction."""
        strip = self.of(call.speaker)
        if call.in_reply_to is not None and call.in_reply_to is strip.correction:
            strip.correction = None

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
