"""Arrivals that have gone around: a unit takes them into the circuit, and clears them again."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from airhilt.phraseology import Instruction
from airhilt.phraseology.say import speak_instruction
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.controllers.calls import ControllerCalls
from airhilt.sensors.radio.controllers.displays import Displays
from airhilt.sensors.radio.controllers.positions import Position
from airhilt.sensors.radio.controllers.strips import LANDING, Contact, Strips
from airhilt.sensors.radio.radio_call import HeardCall, RadioCall
from airhilt.units import SECOND_NS

TAKEN_IN_AFTER_S = 15.0
"""Time in s after a go-around until a unit speaks: the crew is busy before (an assumption)."""
LOOKS_EVERY_S = 5.0
"""Time in s between two looks of a unit for an arrival on final approach: an assumption."""
GIVES_UP_AFTER_S = 900.0
"""Time in s after which a unit does not wait for an arrival any more: a long circuit."""


@dataclass(frozen=True, slots=True)
class _Arrival:
    """An arrival that has gone around, and is to land on a runway."""

    callsign: str
    runway: str
    contact: Contact
    begun_ns: int


class Arrivals:
    """Offers a further approach to each arrival that has gone around.

    The unit sends it round the circuit, and clears it to land once its displays show it on final
    approach and nobody on the runway.
    """

    def __init__(
        self, context: RadioContext, calls: ControllerCalls, displays: Displays, strips: Strips
    ) -> None:
        self._context = context
        self._director = context.director
        self._calls = calls
        self._displays = displays
        self._strips = strips
        self._again: dict[str, _Arrival] = {}
        """Arrivals that are to land, by callsign."""
        self._count = 0

    def heard(self, heard: HeardCall, position: Position) -> None:
        """Take in what a crew says, such as that it goes around."""
        callsign, frequency_khz = heard.call.speaker, heard.call.frequency_khz
        listener = self._context.stations.listener(frequency_khz)
        actions = {each.action for each in listener.parse(heard.text).instructions}
        target = self._displays.target(callsign)
        if "go_around" not in actions or target is None or target.on_ground:
            return
        runway = self._displays.final_of(target) or self._strips.of(callsign).runway
        if runway is None or callsign in self._again:
            return
        contact = Contact(position.unit, frequency_khz)
        arrival = _Arrival(callsign, runway, contact, self._director.now_ns)
        self._again[callsign] = arrival
        self._director.after(TAKEN_IN_AFTER_S, partial(self._take_in, arrival, position))

    def _take_in(self, arrival: _Arrival, position: Position) -> None:
        """Send an arrival round the circuit, once its unit is free to speak."""
        if self._is_over(arrival, position):
            return
        if position.speaking is not None:
            self._director.after(LOOKS_EVERY_S, partial(self._take_in, arrival, position))
            return
        join = Instruction("join", arrival.runway, position="downwind", turn="left")
        self._say(arrival, position, join)
        self._director.after(LOOKS_EVERY_S, partial(self._clear, arrival, position))

    def _clear(self, arrival: _Arrival, position: Position) -> None:
        """Clear an arrival to land, once it is on final approach and the runway is free."""
        if self._is_over(arrival, position):
            return
        target = self._displays.target(arrival.callsign)
        is_final = target is not None and self._displays.final_of(target) == arrival.runway
        is_free = not any(
            self._displays.are_one_runway(self._displays.runway_of(other), arrival.runway)
            for other in self._displays.targets()
        )
        if is_final and is_free and position.speaking is None:
            del self._again[arrival.callsign]
            self._say(arrival, position, Instruction("cleared_to_land", arrival.runway))
        else:
            self._director.after(LOOKS_EVERY_S, partial(self._clear, arrival, position))

    def _is_over(self, arrival: _Arrival, position: Position) -> bool:
        """Return whether a unit is not to care for an arrival any more."""
        now_ns = self._director.now_ns
        is_over = (
            self._context.seats.has_person(position.unit)
            or not self._context.stations.is_there(arrival.callsign)
            or self._strips.of(arrival.callsign).runway_use in LANDING
            or now_ns - arrival.begun_ns > GIVES_UP_AFTER_S * SECOND_NS
        )
        if is_over:
            self._again.pop(arrival.callsign, None)
        return is_over

    def _say(self, arrival: _Arrival, position: Position, instruction: Instruction) -> None:
        self._count += 1
        unit, frequency_khz = arrival.contact
        style = self._context.radio.phraseology
        text = speak_instruction(arrival.callsign, instruction, style)
        name = f"arrival.{arrival.callsign}.{self._count}"
        call = RadioCall(name, frequency_khz, unit, arrival.callsign, text)
        self._calls.say(position, call)
