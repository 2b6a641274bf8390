"""Reactions of people to an advisory: their delay, and whether they follow it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from airhilt.messages import Advisory, Severity
from airhilt.scenario.models import Reactions
from airhilt.sim.streams import stream

FOLLOWED_FROM = Severity.CAUTION
"""Least severity that people act on."""
REPEAT_FACTOR = 0.5
"""Reaction time to a changed advisory, as a part of the first reaction time: 2.5 s after 5 s in the
standard pilot model of ICAO Annex 10, volume IV."""


@dataclass(frozen=True, slots=True)
class ReactionModel:
    """Lognormal reaction time of a crew or driver, and its probability of following at all."""

    callsign: str
    reactions: Reactions
    seed: int

    def complies(self, advisory_id: str) -> bool:
        """Return whether an advisory is followed; the answer is the same for all its revisions."""
        draw = stream(self.seed, f"compliance/{self.callsign}/{advisory_id}").random()
        return bool(draw < self.reactions.compliance)

    def delay_s(self, advisory: Advisory, again: bool) -> float:
        """Return the reaction time in s; a repeated reaction takes less."""
        name = f"reaction/{self.callsign}/{advisory.id}"
        draw = stream(self.seed, name, advisory.revision).standard_normal()
        first = self.reactions.reaction_median_s * math.exp(self.reactions.reaction_sigma * draw)
        return first * (REPEAT_FACTOR if again else 1.0)
