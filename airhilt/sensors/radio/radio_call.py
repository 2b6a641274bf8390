"""Calls, from the first word until they are taken or given up, and their speakers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Literal

from airhilt.commands import Command
from airhilt.scenario.conversation import needed_lines
from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import RadioLine, Scenario, ScriptedCommand
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.frequency_arbiter import FrequencyArbiter
from airhilt.sensors.radio.on_air import Utterance
from airhilt.world.actors.listening import Understanding

MOST_TIMES = 3
"""Number of times that the content of a call is given before its speaker gives up."""

ANSWER_AFTER_S = 1.0
"""Time in s from the end of a call to an answer that is not in the script: an estimate."""

MISSED = Understanding("not_for_me")
UNCLEAR = Understanding("unclear")


@dataclass(eq=False)
class RadioCall:
    """One call, which may be made several times, and the recipients that have taken it."""

    id: str
    frequency_khz: int
    speaker: str
    addressed: str | None
    text: str
    commands: tuple[ScriptedCommand, ...] = ()
    in_reply_to: RadioCall | None = None
    is_of_person: bool = False
    """True if a person says it, in words of its own."""
    is_urgent: bool = False
    """True if a controller makes it because of an advisory: how it is obeyed is drawn."""
    is_repeated: bool = True
    """True if it is made again if it goes unanswered."""
    scripted: EffectiveLine | None = None
    gives_again: RadioCall | None = None
    """Call of the same speaker whose content it gives again, to confirm or to correct it."""
    asks_for: RadioCall | None = None
    """Call that it asks to be made again."""
    answer: RadioCall | None = None
    """Call that the addressee makes once this one is taken."""
    needs: tuple[RadioCall | None, ...] = ()
    """Calls that its speaker must have taken before; None stands for one that is never said."""
    times_said: int = 0
    times_given: int = 0
    """Number of times that it was said, or its content was given again in other calls."""
    transmission: str | None = None
    """Id of the transmission in which it was made last; None: it was not made yet."""
    is_due_again: bool = False
    is_given_up: bool = False
    """True once somebody has said that it cannot be understood."""
    in_force: dict[str, tuple[ScriptedCommand, ...]] = field(default_factory=dict)
    """Commands that actors have decided on, as far as nothing has replaced them since."""
    taken_by: set[str] = field(default_factory=set)
    _then: dict[str, list[Callable[[], None]]] = field(default_factory=dict)

    @property
    def deaf(self) -> frozenset[str]:
        """Actors that a failure keeps from taking it. The failure does not affect repetitions."""
        if self.scripted is None or self.times_said > 1:
            return frozenset()
        return self.scripted.deaf

    @property
    def said(self) -> str:
        """Its words as they are said this time; the last time they are said twice."""
        text = self.text if self._corrected is None else self._corrected.text
        return f"{text} I say again. {text}" if self.is_said_twice else text

    @property
    def is_said_twice(self) -> bool:
        """True the last time that it is said (ICAO Annex 10 volume II, 5.2.1.5.8)."""
        return self.first.times_given >= MOST_TIMES and not self.is_of_person

    @property
    def first(self) -> RadioCall:
        """The call that gave its content first."""
        return self if self.gives_again is None else self.gives_again.first

    @property
    def meant(self) -> tuple[ScriptedCommand, ...]:
        """Commands to the recipients, as it is said this time."""
        return self.commands if self._corrected is None else self._corrected.commands

    @property
    def _corrected(self) -> RadioLine | None:
        """The line without its failure, if it is made again after it went to the wrong actor."""
        if self.scripted is None or not self.scripted.deaf or self.times_said <= 1:
            return None
        return self.scripted.declared

    @property
    def is_outdated(self) -> bool:
        """True for an answer to what its speaker has been told otherwise about since."""
        told = self.in_reply_to
        return self.scripted is None and told is not None and told.is_replaced_for(self.speaker)

    def is_replaced_for(self, actor: str) -> bool:
        """Return whether something has replaced all that an actor was to do."""
        return self.in_force.get(actor) == ()

    def is_in_force(self, actor: str, command: Command) -> bool:
        """Return whether an actor is still to do a command."""
        return any(one.command == command for one in self.in_force.get(actor, ()))

    def recipients(self) -> list[str]:
        """Return who has yet to take it: its addressee, and all that it gives commands to."""
        names = (self.addressed, *(scripted.actor for scripted in self.meant))
        return [
            name
            for name in dict.fromkeys(names)
            if name is not None and name != self.speaker and name not in self.taken_by
        ]

    def reply(self, kind: str, speaker: str, text: str, **more: Any) -> RadioCall:
        """Return a call that somebody makes to the speaker of this one in reply to it."""
        name, khz = f"{self.id}.{kind}", self.frequency_khz
        return RadioCall(name, khz, speaker, self.speaker, text, in_reply_to=self, **more)

    def once_taken_by(self, name: str, action: Callable[[], None]) -> None:
        """Call an action as soon as a recipient has taken it."""
        self._then.setdefault(name, []).append(action)

    def take(self, name: str) -> None:
        """Note that a recipient has taken it."""
        self.taken_by.add(name)
        for action in self._then.pop(name, ()):
            action()


@dataclass(frozen=True, slots=True)
class HeardCall:
    """A call as one listener has heard or read it."""

    call: RadioCall
    said: Utterance
    listener: str
    source: Literal["ear", "transcript"] = "ear"
    text: str = ""
    """Words that came to the listener."""
    understanding: Understanding = MISSED

    @property
    def is_taken(self) -> bool:
        """True if the listener acts on it, rightly or not."""
        return self.understanding.kind in ("as_said", "otherwise")


class Speakers:
    """Lets units and actors make calls, where no person speaks for them."""

    def __init__(self, context: RadioContext, arbiter: FrequencyArbiter) -> None:
        self.on_air: dict[str, RadioCall] = {}
        """Calls on the air or waiting for it, by the id of the transmission."""
        self.said: dict[str, RadioCall] = {}
        """Calls that were made, in that order, by the ids of their transmissions."""
        self._context = context
        self._arbiter = arbiter

    def say_later(self, call: RadioCall, delay_s: float = ANSWER_AFTER_S) -> None:
        """Make a call after a delay in s."""
        self._context.director.after(delay_s, partial(self.say, call))

    def is_being_made(self, call: RadioCall) -> bool:
        """Return whether a call is on the air, or waits for a free frequency."""
        return call.transmission in self.on_air

    def say(self, call: RadioCall) -> None:
        """Make a call."""
        if not self._context.stations.is_there(call.speaker):
            return
        if self._context.seats.has_person(call.speaker) and not call.is_of_person:
            return
        again = call.times_said
        call.times_said += 1
        call.first.times_given += 1
        call.is_due_again = False
        scripted = call.scripted
        replied_to = call.in_reply_to
        utterance = Utterance(
            f"{call.id}.repeat-{again}" if again else call.id,
            call.frequency_khz,
            call.speaker,
            call.addressed,
            call.said,
            None if replied_to is None else replied_to.transmission or replied_to.id,
            None if scripted is None else scripted.declared.id,
            listens_first=again > 0 or scripted is None or scripted.listens_first,
        )
        call.transmission = utterance.id
        self.on_air[utterance.id] = self.said[utterance.id] = call
        self._arbiter.say(utterance, partial(self._is_wanted, call, utterance.id))

    def _is_wanted(self, call: RadioCall, transmission: str) -> bool:
        """Return whether a call that waits for the frequency is still to be made."""
        if call.is_outdated:
            self.on_air.pop(transmission, None)
            self.said.pop(transmission, None)
            return False
        return True


def calls_of(scenario: Scenario, lines: Sequence[EffectiveLine]) -> dict[str, RadioCall]:
    """Return the calls of the lines that are said, by their ids."""
    found = {
        line.declared.id: RadioCall(
            line.line.id,
            line.line.frequency_khz,
            line.line.speaker,
            line.line.to,
            line.line.text,
            line.line.commands,
            scripted=line,
        )
        for line in lines
        if line.line is not None
    }
    needed = needed_lines(scenario)
    needed_by_others = {name for names in needed.values() for name in names}
    for name, call in found.items():
        call.needs = tuple(found.get(other) for other in needed[name])
        call.in_reply_to = next(iter(call.needs), None)
        has_orders = any(scripted.actor != call.speaker for scripted in call.commands)
        call.is_repeated = not call.needs or has_orders or name in needed_by_others
    return found
