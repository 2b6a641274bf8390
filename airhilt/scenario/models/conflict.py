"""The conflict of a scenario: who, what begins it, its window, and what separation is lost."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from airhilt.quantities import Number
from airhilt.scenario.models.base import Model
from airhilt.scenario.models.conditions import Condition, Pair

UnassistedOutcome = Literal["collision", "nmac", "runway_incursion", "loss_of_separation"]


class Conflict(Model):
    """Annotated conflict: its actors, the event that begins it, and its window.

    ``begins`` is t_conflict, from which the time to first warning counts. It is the event by which
    the conflict comes about, spoken (`LineBegun`) or physical, and no threshold of an assistant.
    """

    actors: Pair
    begins: Condition | None = Field(
        default=None,
        description="event by which the conflict comes about; null: the opening of its window",
    )
    opens_when: Condition = Field(
        description="opens the window in which the closest approach is taken"
    )
    unassisted: UnassistedOutcome = Field(
        default="loss_of_separation", description="least severe outcome if nobody is warned"
    )


class Separation(Model):
    """Separation minima: lost when both are infringed.

    5 NM and 1000 ft are ICAO Doc 4444, 8.7.3.1 and 5.3.2. The tolerance allows for aircraft that
    keep their level within tens of feet.
    """

    horizontal_nm: Number = Field(default=5.0, gt=0.0, le=100.0)
    vertical_ft: Number = Field(default=1000.0, gt=0.0, le=10_000.0)
    level_tolerance_ft: Number = Field(default=100.0, ge=0.0, le=300.0)
