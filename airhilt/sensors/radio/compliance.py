"""Compliance: actors carry out the calls that they have taken; people choose if they do."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

from airhilt.commands import Command
from airhilt.scenario.models import Condition, ScriptedCommand
from airhilt.sensors.radio.radio_call import RadioCall
from airhilt.sim import Director, Priority
from airhilt.units import seconds_to_ns

COMPLY_AFTER_S = 2.0
"""Time in s from taking a call to doing what was understood, where that is not what was said. The
same as the default of scripted commands."""


class Compliance:
    """Lets actors do what calls make them do.

    Parameters
    ----------
    once
        Calls its second argument as soon as its first, a condition, is true.
    do
        Lets an actor carry out a command.
    offer
        Offers the person who acts for an actor a command of a call, by its id; returns False if
        there is no person, so that the actor does it by itself.
    """

    def __init__(
        self,
        director: Director,
        once: Callable[[Condition, Callable[[], None]], None],
        do: Callable[[str, Command], None],
        offer: Callable[[str, str, Command], bool],
    ) -> None:
        self._director = director
        self._once = once
        self._do = do
        self._offer = offer

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

    def _do_later(self, call: RadioCall, scripted: ScriptedCommand) -> None:
        """Let an actor carry out a command in time; a person is offered it at once instead."""
        if self._offer(scripted.actor, call.id, scripted.command):
            return
        due_ns = self._director.now_ns + seconds_to_ns(scripted.delay_s)
        self._director.at(due_ns, partial(self._do_on_condition, call, scripted), Priority.SCRIPT)

    def _do_on_condition(self, call: RadioCall, scripted: ScriptedCommand) -> None:
        def act() -> None:
            actor, command = scripted.actor, scripted.command
            if actor not in call.withdrawn_for and not self._offer(actor, call.id, command):
                self._do(actor, command)

        if scripted.when is None:
            act()
        else:
            self._once(scripted.when, act)
