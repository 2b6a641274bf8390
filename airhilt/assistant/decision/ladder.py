"""The last rung of the AIRHILT paper's ladder: several weak hints together (arXiv 2511.18718).

S = 0.50 W_V + 0.35 W_A + 0.15 W_C. Each engine says what it takes for the last two.
"""

from __future__ import annotations

from typing import NamedTuple

from pydantic import Field, model_validator

from airhilt.configuration import Configuration, Share, require_order
from airhilt.messages import Severity


class ScoreConfig(Configuration):
    """Weights and thresholds of the score; all of them from arXiv 2511.18718."""

    vision_weight: Share = Field(0.50, description="weight of W_V, what cameras show")
    asr_weight: Share = Field(0.35, description="weight of W_A")
    context_weight: Share = Field(0.15, description="weight of W_C")
    caution_from: Share = Field(0.75, description="score from which it is a CAUTION")
    advisory_from: Share = Field(0.50, description="score from which it is an ADVISORY")

    @model_validator(mode="after")
    def _in_order(self) -> ScoreConfig:
        require_order(self, "advisory_from", "caution_from")
        return self


class Score(NamedTuple):
    """The three terms of the score, each with its weight."""

    vision: float
    asr: float
    context: float

    @classmethod
    def of(cls, config: ScoreConfig, vision: float, asr: float, context: float) -> Score:
        """Return the score of three values from 0 to 1."""
        return cls(
            config.vision_weight * vision,
            config.asr_weight * asr,
            config.context_weight * context,
        )

    def severity(self, config: ScoreConfig) -> Severity | None:
        """Return the severity of the score; None if it does not suffice."""
        total = self.vision + self.asr + self.context
        if total >= config.caution_from:
            return Severity.CAUTION
        return Severity.ADVISORY if total >= config.advisory_from else None

    def shares(self, **modalities: float) -> dict[str, float]:
        """Return the share of each modality that has one, from the terms that rest on each."""
        total = sum(modalities.values())
        return {name: term / total for name, term in modalities.items() if term > 0.0}
