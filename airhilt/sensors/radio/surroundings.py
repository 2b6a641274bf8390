"""Protocols of the world and the failures of a run, as the radio needs them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from airhilt.commands import Command
from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import Condition


class RadioWorld(Protocol):
    """The world in which calls are made and acted upon.

    Attributes
    ----------
    ended_lines
        Ids of the calls that have been on the air.
    """

    ended_lines: set[str]

    def line_begun(self, line: str) -> None:
        """Take in that a call begins, also when it is said again."""

    def once(self, condition: Condition, action: Callable[[], None]) -> None:
        """Do an action as soon as a condition is true."""

    def do(self, callsign: str, command: Command) -> None:
        """Let an actor carry out a command."""


class RadioFailures(Protocol):
    """Gets what the failures of a scenario do to the radio."""

    def line_failed(self, line: EffectiveLine) -> None:
        """Take in that a line is due which a failure changes."""

    def microphone_stuck(self, callsign: str, text: str) -> None:
        """Take in that the microphone of an actor is stuck, with a description."""

    def microphones_free(self) -> None:
        """Take in that no microphone is stuck any more."""
