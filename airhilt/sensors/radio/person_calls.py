"""The calls that people at seats make, and those of the script that wait for them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from airhilt.messages import TaskCard, Transcript, key_chunk
from airhilt.phraseology import TAU_ASR, Call
from airhilt.scenario.models import ScriptedCommand
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.on_air import OnAir, Utterance
from airhilt.sensors.radio.radio_call import RadioCall
from airhilt.world.actors.listening import mean_the_same

NOBODY_THERE = "Nobody answers: no callsign on the frequency is in the call."
"""Notice to a person at a unit whose call is to nobody."""


class RecognisedCall(NamedTuple):
    """A call that a person spoke, as it was recognised."""

    call: RadioCall
    said: Utterance
    on_air: OnAir
    is_clear: bool
    """True if its words are certain."""


class PersonCalls:
    """Makes calls of what people say.

    A call of the script that is due at a seat is told to the person there. What the person says to
    the same addressee with the same instructions takes its place, so that the rest of the script
    goes on from it. It is due until its addressee has taken it. Everything else is a call of its
    own.

    The words of a call that is spoken are those that the recogniser under test gives. Below
    `TAU_ASR`, without words, or without a callsign in the call of a unit, nobody is sure of it.
    """

    def __init__(self, context: RadioContext, said: Mapping[str, RadioCall]) -> None:
        self._director = context.director
        self._seats = context.seats
        self._stations = context.stations
        self._said = said
        self._due: list[RadioCall] = []
        """Calls of the script that wait for their person."""
        self._spoken: dict[str, OnAir] = {}
        """Transmissions whose words are not known yet, by id."""
        self._count = 0

    def leave(self, speaker: str) -> list[RadioCall]:
        """Return the calls that waited for a person who has left, which the script makes now."""
        waiting = [call for call in self._due if call.speaker == speaker and not call.times_said]
        for call in waiting:
            self._finish(call)
        return waiting

    def tell(self, call: RadioCall) -> None:
        """Tell a person that a call of the script is due."""
        self._due.append(call)
        if call.addressed is not None:
            call.once_taken_by(call.addressed, partial(self._finish, call))
        card = TaskCard(
            line=call.id,
            due_ns=self._director.now_ns,
            addressed=call.addressed,
            frequency_khz=call.frequency_khz,
            text=call.said,
        )
        self._seats.add_task(call.speaker, card)

    def _finish(self, call: RadioCall) -> None:
        """Take away the card of a call."""
        if call in self._due:
            self._due.remove(call)
            self._seats.end_task(call.speaker, call.id)

    def frequency_khz(self, speaker: str, given_khz: int | None) -> int:
        """Return the frequency on which a person speaks: the given one, or the seat's first."""
        frequency_khz = given_khz or self._stations.frequency_of(speaker)
        assert frequency_khz is not None  # There are no seats without lines.
        return frequency_khz

    def ended(self, on_air: OnAir) -> None:
        """Wait for the words of a call that a person has spoken."""
        self._spoken[on_air.utterance.id] = on_air

    def recognised(self, transcript: Transcript) -> RecognisedCall | None:
        """Return the spoken call of a transcript, the first time that its words come."""
        on_air = self._spoken.pop(transcript.id, None)
        if on_air is None:
            return None
        said, text = on_air.utterance, transcript.text
        confidences = tuple(word.confidence for word in transcript.words) or None
        meant = self._stations.listener(said.frequency_khz).parse(text, confidences)
        # It is always known whom a crew calls: its unit.
        has_addressee = self._stations.is_actor(said.speaker) or meant.callsign is not None
        is_clear = meant.confidence >= TAU_ASR and has_addressee
        if is_clear:
            call = self.make(said.speaker, said.frequency_khz, text)
        else:
            call = self._unclear(said.speaker, said.frequency_khz, text, meant)
        words = replace(said, text=text, addressed=call.addressed)
        return RecognisedCall(call, words, on_air, is_clear)

    def make(self, speaker: str, frequency_khz: int, text: str) -> RadioCall:
        """Return the call that a person makes with some words."""
        meant = self._stations.listener(frequency_khz).parse(text)
        call = self._stands_for(speaker, meant, frequency_khz)
        if call is None:
            call = self._own(speaker, frequency_khz)
            call.addressed = self._addressed(speaker, meant, frequency_khz)
        elif call.addressed is None:
            self._finish(call)
        call.is_of_person = True
        if meant.kind == "say_again" and "callsign" not in meant.text:
            call.asks_for = self._last_to(speaker, frequency_khz)
        call.commands = self._planned(call, meant)
        call.text = text
        if call.addressed is None and not self._stations.is_actor(speaker):
            self._seats.notify(speaker, NOBODY_THERE)
        return call

    def _last_to(self, name: str, frequency_khz: int) -> RadioCall | None:
        """Return the last call to somebody on a frequency; None if a person made it."""
        calls = [
            call
            for call in self._said.values()
            if (call.addressed, call.frequency_khz) == (name, frequency_khz)
        ]
        return calls[-1] if calls and not calls[-1].is_of_person else None

    def _unclear(self, speaker: str, frequency_khz: int, text: str, meant: Call) -> RadioCall:
        """Return a call of whose words nobody is sure, to whom it names, or to whoever expects one.

        The unit of a crew expects it, the addressee of an open task card, or the only actor on the
        frequency. Without any of them, nobody answers.
        """
        call = self._own(speaker, frequency_khz)
        call.text = text
        call.addressed = self._addressed(speaker, meant, frequency_khz)
        others = [name for name in self._stations.actors_on(frequency_khz) if name != speaker]
        expecting = [one.addressed for one in self._due if one.speaker == speaker and one.addressed]
        if call.addressed is None and not self._stations.is_actor(speaker):
            call.addressed = next(iter(expecting), others[0] if len(others) == 1 else None)
        return call

    def _own(self, speaker: str, frequency_khz: int) -> RadioCall:
        """Return a call that is not in the script."""
        self._count += 1
        name = f"seat.{key_chunk(speaker)}.{self._count}"
        call = RadioCall(name, frequency_khz, speaker, None, "", is_repeated=False)
        call.is_of_person = True
        return call

    def _stands_for(self, speaker: str, meant: Call, frequency_khz: int) -> RadioCall | None:
        """Return the call of the script that some words stand for, None if they are others."""
        actions = [one.action for one in meant.instructions]
        for call in self._due:
            planned = self._stations.listener(frequency_khz).parse(call.said)
            same = [one.action for one in planned.instructions] == actions
            of_crew = self._stations.is_actor(speaker)
            if call.speaker == speaker and same and (of_crew or planned.callsign == meant.callsign):
                return call
        return None

    def _addressed(self, speaker: str, meant: Call, frequency_khz: int) -> str | None:
        """Return whom a call is for: the unit of a crew's frequency, or who a unit names."""
        if not self._stations.is_actor(speaker):
            return meant.callsign
        on_frequency = self._stations.on(frequency_khz)
        return next((name for name in on_frequency if not self._stations.is_actor(name)), None)

    def _planned(self, call: RadioCall, meant: Call) -> tuple[ScriptedCommand, ...]:
        """Return what the script has planned for words that mean the same, such as a taxi route.

        What crews say gives no commands: the person at the seat flies.
        """
        if call.addressed is None or self._stations.is_actor(call.speaker):
            return ()
        line = None if call.scripted is None else call.scripted.line
        if line is None:
            return ()
        planned = self._stations.listener(call.frequency_khz).parse(line.text).instructions
        return line.commands if mean_the_same(meant.instructions, planned) else ()
