"""Controllers' working positions: what each is shown, and what it has said."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

from airhilt.messages import Advisory
from airhilt.phraseology import Action, Instruction
from airhilt.scenario.models import Alerting, Controller
from airhilt.sensors.radio.radio_call import RadioCall
from airhilt.world.actors.reactions import ReactionModel

Told = tuple[frozenset[str], str, tuple[Action, ...]]
"""Traffic of a conflict, callsign of who was told something about it, and the actions."""
FURTHER_FT = 500.0
"""Distance in ft beyond a level that was given from which another one is news: half a level."""


@dataclass(slots=True)
class Position:
    """A controller's working position at one unit."""

    unit: str
    controller: Controller
    reactions: ReactionModel
    attended: set[str] = field(default_factory=set)
    """Ids of the advisories that the controller has seen and acts on."""
    said: dict[Told, tuple[Instruction, ...]] = field(default_factory=dict)
    """The last instructions about each conflict to each actor, by their actions."""
    silences: set[tuple[str, str]] = field(default_factory=set)
    """Causes of silence that are in the log, with the ids of the advisories."""
    speaking: RadioCall | None = None
    """Call on the air, or waiting for the frequency."""
    calls: int = 0

    def has_news(self, told: Told, instructions: tuple[Instruction, ...]) -> bool:
        """Return whether instructions are to be said, after what was said with the same actions.

        A level is news if it is further in the same sense, or if it replaces "maintain". Whoever
        was told to climb is not told to descend because of the same conflict.
        """
        before = self.said.get(told)
        if before is None:
            return bool(instructions)
        return any(_is_further(*pair) for pair in zip(instructions, before, strict=True))

    def forget(self, traffic: frozenset[str]) -> None:
        """Forget what was said about a conflict that is over."""
        for told in [each for each in self.said if each[0] == traffic]:
            del self.said[told]


class Alert(NamedTuple):
    """What a controller is shown of a conflict."""

    kind: Alerting
    advisory: Advisory

    @property
    def urgency(self) -> tuple[int, float]:
        """Key that is the least for the most urgent one."""
        evidence = self.advisory.evidence
        times = (evidence.time_to_go_s, evidence.time_to_loss_s)
        known = (time for time in times if time is not None)
        return -self.advisory.severity.rank, min(known, default=math.inf)


def _is_further(one: Instruction, before: Instruction) -> bool:
    """Return whether an instruction about a level goes further than one before."""
    if one.altitude_ft is None or before.altitude_ft is None:
        return False
    if before.sense == "maintain" or one.sense != before.sense:
        return before.sense == "maintain" and one.sense != "maintain"
    up = 1.0 if one.sense == "climb" else -1.0
    return up * (one.altitude_ft - before.altitude_ft) >= FURTHER_FT
