"""Questionnaires about workload."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field


class NasaTlx(BaseModel):
    """Ratings of the NASA Task Load Index (Hart & Staveland 1988), from 0 to 100 in steps of 5.

    Performance is 0 for perfect and 100 for failure. The mean is the raw TLX (Hart 2006).
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    mental_demand: int = Field(ge=0, le=100, multiple_of=5)
    physical_demand: int = Field(ge=0, le=100, multiple_of=5)
    temporal_demand: int = Field(ge=0, le=100, multiple_of=5)
    performance: int = Field(ge=0, le=100, multiple_of=5)
    effort: int = Field(ge=0, le=100, multiple_of=5)
    frustration: int = Field(ge=0, le=100, multiple_of=5)

    @property
    def raw_tlx(self) -> float:
        """Mean of the six ratings."""
        ratings: list[int] = list(self.model_dump().values())
        return sum(ratings) / len(ratings)
