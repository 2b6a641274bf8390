"""Compliance: what actors decide to do of a call that they have taken, and do in time.

An ordinary instruction is obeyed unless it cannot be. Whether and when an urgent one is, one that a
controller gives because of an advisory, is drawn from the response model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from airhilt.commands import Command, ContactCommand, GoAroundCommand
from airhilt.messages import Event
from airhilt.phraseology import Call, Instruction
from airhilt.phraseology.call import OTHERWISE
from airhilt.scenario.models import ScriptedCommand
from airhilt.sensors.radio.answers import Answers
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.radio_call import RadioCall, Speakers
from airhilt.world.actors.orders import ON_THE_WAY, Order, subject_of
from airhilt.world.actors.reactions import reaction_models

COMPLY_AFTER_S = 2.0
"""Time in s from taking a call to doing what was understood, where that is not what was said. The
same as the default of scripted commands."""
TUNING_S = 4.0
"""Time in s from leaving a frequency to the first call on the next one: an assumption."""
FORESEEN_S = 5.0
"""Time in s for which a crew foresees if it can do what the script has for it: an assumption."""


class Decision(NamedTuple):
    """Decision of an actor about a call that it has taken."""

    commands: tuple[ScriptedCommand, ...] = ()
    """Commands that it carries out."""
    accepted: tuple[Instruction, ...] = ()
    """Instructions that it reads back."""
    unable: tuple[str, ...] = ()
    """Words about the rest: why it cannot do it, or what it asks before it can."""


class Compliance:
    """Lets actors do what calls make them do.

    A later call about the same subject replaces what an actor has not done yet of earlier ones.
    """

    def __init__(self, context: RadioContext, speakers: Speakers) -> None:
        self._context = context
        self._speakers = speakers
        self._answers = Answers(context)
        self._director = context.director
        self._world = context.world
        self._seats = context.seats
        self._stations = context.stations
        self._reactions = reaction_models(context.scenario, context.seed)
        self._undone: set[tuple[str, str]] = set()
        """Calls, and actors, of which was told that there is no response."""
        self._latest: dict[tuple[str, str], RadioCall] = {}
        """The last call about each subject to each actor."""
        self._decided: dict[tuple[str, str], tuple[ScriptedCommand, ...]] = {}
        """Commands that actors have decided on, by the ids of the calls as they were first."""

    # --- deciding ---------------------------------------------------------------------------

    def decide(self, call: RadioCall, actor: str, taken: Call, *, as_said: bool) -> Decision:
        """Return what an actor decides to do of a call, whose words it has taken as a meaning.

        What the script plans for its words is done; of other words, what they order.
        """
        planned = tuple(one for one in call.meant if one.actor == actor)
        if as_said and (planned or (call.scripted is not None and not call.is_of_person)):
            return self._planned(planned, taken, actor)
        return self._ordered(call, taken, actor)

    def _planned(self, planned: tuple[ScriptedCommand, ...], taken: Call, actor: str) -> Decision:
        soon = (one for one in planned if one.when is None and one.delay_s <= FORESEEN_S)
        first = next(soon, None)
        why = None if first is None else self._refusal(actor, first.command)
        if why is not None:
            return self._told(actor, Decision(unable=(why,)))
        return Decision(planned, taken.instructions)

    def _ordered(self, call: RadioCall, taken: Call, actor: str) -> Decision:
        listener = self._stations.listener(call.frequency_khz)
        orders = listener.orders_of(taken.instructions, self._stations.bound_runway(actor))
        commands: dict[Command, None] = {}
        accepted: list[Order] = []
        unable = []
        refused: dict[str, str | None] = {}
        """Why the first order about each subject cannot be done; None if it can."""
        for order in self._possible(actor, orders):
            why = order.unable or order.question or None
            if why is None and order.command is not None:
                subject = subject_of(order.command)
                if subject not in refused:
                    breaks_off = any(isinstance(each, GoAroundCommand) for each in commands)
                    why = None if breaks_off else self._refusal(actor, order.command)
                    refused[subject] = why  # Where it goes around, it is not where it was.
                why = refused[subject]
            if why is not None:
                unable.append(why)
                continue
            accepted.append(order)
            if order.command is not None:
                commands[order.command] = None
        scripted = tuple(
            ScriptedCommand(actor=actor, command=command, delay_s=COMPLY_AFTER_S)
            for command in commands
        )
        if refused.get("surface") or refused.get("approach"):
            accepted = [each for each in accepted if each.instruction.action not in ON_THE_WAY]
        read_back = tuple(each.instruction for each in accepted)
        decision = Decision(scripted, read_back, tuple(dict.fromkeys(unable)))
        return self._told(actor, decision)

    def _possible(self, actor: str, orders: Sequence[Order]) -> list[Order]:
        """Return orders without the second of two alternatives, or without a first that fails."""
        possible: list[Order] = []
        for order in orders:
            if possible and order.instruction.condition == OTHERWISE:
                first = possible[-1].command
                if first is None or self._refusal(actor, first) is None:
                    continue
                possible.pop()
                order = replace(order, instruction=replace(order.instruction, condition=None))
            possible.append(order)
        return possible

    def _refusal(self, actor: str, command: Command) -> str | None:
        """Return why an actor cannot carry out a command now; a person decides without us."""
        if self._seats.has_person(actor):
            return None
        if isinstance(command, ContactCommand):
            return self._stations.unknown(command.unit, command.frequency_khz)
        return self._world.refusal(actor, command)

    def _told(self, actor: str, decision: Decision) -> Decision:
        """Publish what an actor refuses, and return the decision."""
        for text in decision.unable:
            now_ns = self._director.now_ns
            event = Event(t_ns=now_ns, kind="unable", subject=actor, text=text)
            self._context.publish("truth/event", event)
        return decision

    # --- doing ------------------------------------------------------------------------------

    def carry_out(self, call: RadioCall, actor: str) -> None:
        """Let the speaker of a call do what the script has for it in the call."""
        self.comply(call, actor, tuple(one for one in call.meant if one.actor == actor))

    def comply(self, call: RadioCall, actor: str, commands: tuple[ScriptedCommand, ...]) -> None:
        """Let an actor do what it has decided to do of a call, once if that is only confirmed."""
        subjects = {subject_of(scripted.command) for scripted in commands}
        latest = [self._latest.get((actor, subject)) for subject in subjects]
        is_latest = all(other is not None and other.first is call.first for other in latest)
        if self._decided.get((call.first.id, actor)) == commands and is_latest:
            return
        self._decided[call.first.id, actor] = commands
        self._latest |= {(actor, subject): call for subject in subjects}
        for other in latest:
            if other is not None and not self._is_latest_of_any(other, actor):
                other.withdrawn_for.add(actor)
        for scripted in commands:
            self._do_later(call, scripted)

    def _is_latest_of_any(self, call: RadioCall, actor: str) -> bool:
        """Return whether a call is the last one to an actor about any subject."""
        return any(name == actor and one is call for (name, _), one in self._latest.items())

    def _offer(self, actor: str, call: str, command: Command) -> bool:
        """Offer the person who acts for an actor a command; return False if there is none."""
        if not self._seats.has_person(actor):
            return False
        self._seats.offer(actor, call, command)
        return True

    def _do_later(self, call: RadioCall, scripted: ScriptedCommand) -> None:
        """Let an actor carry out a command in time; a person is offered it at once instead."""
        if self._offer(scripted.actor, call.id, scripted.command):
            return
        if call.is_urgent:
            response = self._reactions[scripted.actor].respond("controller", call.id)
            if not response.follows:
                self._leave_undone(call, scripted)
                return
            scripted = scripted.model_copy(update={"delay_s": response.delay_s})
        self._director.after(scripted.delay_s, partial(self._do_on_condition, call, scripted))

    def _leave_undone(self, call: RadioCall, scripted: ScriptedCommand) -> None:
        """Tell once that an actor does not respond to a call."""
        if (call.id, scripted.actor) not in self._undone:
            self._undone.add((call.id, scripted.actor))
            does = scripted.command.action.replace("_", " ")
            self._world.no_response(scripted.actor, f"does not respond to {does} ({call.id})")

    def _change_frequency(self, call: RadioCall, actor: str, command: ContactCommand) -> None:
        """Let an actor leave its frequency, and call the unit on another one."""
        frequency_khz = self._stations.tune(actor, command.unit, command.frequency_khz)
        event = Event(
            t_ns=self._director.now_ns,
            kind="command",
            subject=actor,
            text=command.model_dump_json(exclude_none=True),
        )
        self._context.publish("truth/event", event)
        unit = self._stations.unit_on(frequency_khz)
        if command.calls:
            text = self._answers.to_unit(actor, unit or (command.unit or "station").title())
            hail = RadioCall(f"{call.id}.contact", frequency_khz, actor, unit, text)
            self._speakers.say_later(hail, TUNING_S)

    def _do_on_condition(self, call: RadioCall, scripted: ScriptedCommand) -> None:
        def act() -> None:
            actor, command = scripted.actor, scripted.command
            is_latest = self._latest[actor, subject_of(command)] is call
            if actor in call.withdrawn_for or not is_latest:
                return
            if isinstance(command, ContactCommand):
                self._change_frequency(call, actor, command)
            elif not self._offer(actor, call.id, command):
                self._world.do(actor, command)

        if scripted.when is None:
            act()
        else:
            self._world.once(scripted.when, act)
