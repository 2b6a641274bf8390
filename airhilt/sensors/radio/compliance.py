"""Compliance: actors carry out the calls that they have taken; people choose if they do.

An ordinary instruction is always obeyed. Whether and when an urgent one is, one that a controller
gives because of an advisory, is drawn from the response model.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

from airhilt.commands import Command
from airhilt.scenario.models import ScriptedCommand
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.radio_call import RadioCall
from airhilt.world.actors.reactions import reaction_models

COMPLY_AFTER_S = 2.0
"""Time in s from taking a call to doing what was understood, where that is not what was said. The
same as the default of scripted commands."""


class Compliance:
    """Lets actors do what calls make them do."""

    def __init__(self, context: RadioContext) -> None:
        self._director = context.director
        self._world = context.world
        self._seats = context.seats
        self._reactions = reaction_models(context.scenario, context.seed)
        self._undone: set[tuple[str, str]] = set()
        """Calls, and actors, of which was told that there is no response."""

    def carry_out(self, call: RadioCall, actor: str) -> None:
        """Let an actor do what the script has for it in a call."""
        for scripted in call.meant:
            if scripted.actor == actor:
                self._do_later(call, scripted)

    def comply(self, call: RadioCall, actor: str, commands: Iterable[Command]) -> None:
        """Let an actor do what it has understood."""
        for command in commands:
            scripted = ScriptedCommand(actor=actor, command=command, delay_s=COMPLY_AFTER_S)
            self._do_later(call, scripted)

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

    def _do_on_condition(self, call: RadioCall, scripted: ScriptedCommand) -> None:
        def act() -> None:
            actor, command = scripted.actor, scripted.command
            if actor not in call.withdrawn_for and not self._offer(actor, call.id, command):
                self._world.do(actor, command)

        if scripted.when is None:
            act()
        else:
            self._world.once(scripted.when, act)
