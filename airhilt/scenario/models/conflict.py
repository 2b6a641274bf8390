"""The conflict of a scenario: who, from when on, and what separation is lost."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from airhilt.scenario.models.base import Model
from airhilt.scenario.models.conditions import Condition, Pair

UnassistedOutcome = Literal["collision", "nmac", "runway_incursion", "loss_of_separation"]


class Conflict(Model):
    """Annotated conflict: its actors, and the condition on the true state at which it begins."""

    actors: Pair
    opens_when: Condition
    unassisted: UnassistedOutcome = Field(
        default="loss_of_separation", description="least severe outcome if nobody is warned"
    )


class Separation(Model):
    """Separation minima: lost when both are infringed.

    5 NM and 1000 ft are ICAO Doc 4444, 8.7.3.1 and 5.3.2. The tolerance allows for aircraft that
    keep their level within tens of feet.
    """

    horizontal_nm: float = Field(default=5.0, gt=0.0, le=100.0)
    vertical_ft: float = Field(default=1000.0, gt=0.0, le=10_000.0)
    level_tolerance_ft: float = Field(default=100.0, ge=0.0, le=300.0)
