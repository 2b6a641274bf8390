"""Rewards of a step, from what became true in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from airhilt.messages import ConflictTruth


@dataclass(frozen=True)
class Rewards:
    """Rewards for what becomes true of any aircraft, and for what the agent says or commands.

    Each applies once, when a loss of separation, a runway incursion or a collision begins.
    """

    loss_of_separation: float = -1.0
    runway_incursion: float = -1.0
    collision: float = -1.0
    manoeuvre: float = -0.05

    def of(self, conflicts: Sequence[ConflictTruth], manoeuvres: int) -> float:
        """Return the reward of a step with these conflicts and a number of manoeuvres."""
        of_phase = {
            "loss_of_separation": self.loss_of_separation,
            "runway_incursion": self.runway_incursion,
            "collision": self.collision,
        }
        bad = sum(of_phase.get(conflict.phase, 0.0) for conflict in conflicts)
        return bad + manoeuvres * self.manoeuvre
