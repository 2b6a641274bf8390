"""The weighted score of the AIRHILT paper's ladder (arXiv 2511.18718)."""

from __future__ import annotations

from typing import NamedTuple

from airhilt.assistant.decision.paper.config import PaperConfig
from airhilt.messages import Severity


class Score(NamedTuple):
    """The terms of S = 0.50 W_V + 0.35 W_A + 0.15 W_C.

    Attributes
    ----------
    vision
        Weight times W_V: the cameras' belief that the runway is occupied.
    asr
        Weight times W_A: what was said agrees with a conflict.
    context
        Weight times W_C: somebody else is about to use the runway.
    """

    vision: float
    asr: float
    context: float

    @classmethod
    def of(cls, config: PaperConfig, vision: float, asr: float, context: float) -> Score:
        """Return the score of three values from 0 to 1."""
        return cls(
            config.vision_weight * vision,
            config.asr_weight * asr,
            config.context_weight * context,
        )

    @property
    def total(self) -> float:
        """The score S."""
        return self.vision + self.asr + self.context

    @property
    def shares(self) -> dict[str, float]:
        """Share of each modality in the score; those without a share are left out."""
        terms = {"vision": self.vision, "radio": self.asr, "adsb": self.context}
        return {name: term / self.total for name, term in terms.items() if term > 0.0}

    def severity(self, config: PaperConfig) -> Severity | None:
        """Return the severity of the score; None if it does not suffice."""
        if self.total >= config.caution_from:
            return Severity.CAUTION
        return Severity.ADVISORY if self.total >= config.advisory_from else None
