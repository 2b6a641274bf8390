"""How long people take to react to an advisory, and whether they follow it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from airhilt.messages import Advisory, Severity
from airhilt.scenario.models import Reactions
from airhilt.sim.streams import stream

FOLLOWED_FROM = Severity.CAUTION
"""Least severity that is acted on."""
REPEAT_FACTOR = 0.5
"""Reaction time to a changed advisory, against the first one: the standard pilot model
of ICAO Annex 10, volume IV, has 2.5 s after 5 s."""


@dataclass(frozen=True, slots=True)
class ReactionModel:
    """Who reacts: a lognormal reaction time, and how probable it is to follow at all."""

    callsign: str
    reactions: Reactions
    seed: int

    def complies(self, advisory_id: str) -> bool:
        """Return whether an advisory is followed; the same for all its revisions."""
        draw = stream(self.seed, f"compliance/{self.callsign}/{advisory_id}").random()
        return bool(draw < self.reactions.compliance)

    def delay_s(self, advisory: Advisory, again: bool) -> float:
        """Return how long the reaction takes; a repeated one takes less."""
        name = f"reaction/{self.callsign}/{advisory.id}"
        draw = stream(self.seed, name, advisory.revision).standard_normal()
        first = self.reactions.reaction_median_s * math.exp(self.reactions.reaction_sigma * draw)
        return first * (REPEAT_FACTOR if again else 1.0)
