"""Commands that wait until other traffic has passed."""

from __future__ import annotations

from functools import partial

from airhilt.commands import BehindCommand, Command
from airhilt.world.actors.actor import Act
from airhilt.world.actors.traffic import Passage, Traffic


class BehindTraffic:
    """The command of one actor that waits until other traffic has passed, if there is one."""

    def __init__(self, traffic: Traffic) -> None:
        self._traffic = traffic
        self._waiting: tuple[Passage, Command] | None = None

    def plan(self, command: BehindCommand) -> Act:
        """Return what begins to wait; `Unable` says that the traffic is not in sight."""
        other = self._traffic.named(command.whom)
        passage = self._traffic.passage(other, command.traffic)
        return partial(self._wait, passage, command.command)

    def due(self) -> Command | None:
        """Return the command once, when the traffic has passed; None before and after."""
        if self._waiting is None or not self._waiting[0].is_over():
            return None
        _, command = self._waiting
        self._waiting = None
        return command

    def forget(self) -> None:
        """Wait for nothing any more."""
        self._waiting = None

    def _wait(self, passage: Passage, command: Command) -> None:
        self._waiting = passage, command
