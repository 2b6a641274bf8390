"""Parts of a run that its radio uses."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

from airhilt.commands import Command
from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import Condition, Radio, Scenario
from airhilt.seats import Seats
from airhilt.sensors.base import Publish
from airhilt.sensors.radio.answers import Answers
from airhilt.sensors.radio.backends import RadioBackend
from airhilt.sensors.radio.reception import Receptions
from airhilt.sensors.radio.stations import Stations
from airhilt.sim import Director


class RadioWorld(Protocol):
    """The world in which calls are made and acted upon."""

    ended_lines: set[str]
    """Ids of the calls that have been on the air."""

    def line_begun(self, line: str) -> None:
        """Take in that a call begins, also when it is said again."""

    def once(self, condition: Condition, action: Callable[[], None]) -> None:
        """Do an action as soon as a condition is true."""

    def do(self, callsign: str, command: Command) -> None:
        """Let an actor carry out a command."""

    def never(self, condition: Condition) -> str | None:
        """Return why a condition cannot come true, as an actor says it; None: it can."""

    def refusal(self, callsign: str, command: Command) -> str | None:
        """Return why an actor cannot carry out a command now, as it says it; None: it can."""

    def no_response(self, callsign: str, text: str) -> None:
        """Take in that an actor does not do what an urgent call says."""


class RadioFailures(Protocol):
    """Gets what the failures of a scenario do to the radio."""

    def line_failed(self, line: EffectiveLine) -> None:
        """Take in that a line is due which a failure changes."""

    def microphone_stuck(self, callsign: str, text: str) -> None:
        """Take in that the microphone of an actor is stuck, with a description."""

    def microphones_free(self) -> None:
        """Take in that no microphone is stuck any more."""


@dataclass(frozen=True)
class RadioContext:
    """Parts of a run that its radio uses."""

    director: Director
    scenario: Scenario
    lines: Sequence[EffectiveLine]
    """Lines of the script, as failures change them."""
    stations: Stations
    backend: RadioBackend
    seed: int
    world: RadioWorld
    failures: RadioFailures
    publish: Publish
    seats: Seats
    """Seats of people: nobody else speaks or acts there."""

    @property
    def radio(self) -> Radio:
        """Radio of the scenario."""
        return self.scenario.radio

    @cached_property
    def receptions(self) -> Receptions:
        """Reception of the calls of the scenario."""
        return Receptions(self.radio)

    @cached_property
    def answers(self) -> Answers:
        """Words of answers that are not in the script."""
        return Answers(self.stations, self.radio.phraseology)
