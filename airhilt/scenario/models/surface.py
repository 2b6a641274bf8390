"""Surface surveillance of a scenario's airport."""

from __future__ import annotations

from pydantic import Field

from airhilt.quantities import PeriodS, Share
from airhilt.scenario.models.base import Model


class SurfaceSurveillance(Model):
    """Surface movement radar and multilateration of the airport, fused."""

    loss_probability: Share = Field(
        default=0.0,
        description="probability that a target has no track in one second, besides the "
        "probabilities of detection",
    )
    outages_s: tuple[PeriodS, ...] = Field(
        default=(), max_length=100, description="[from, to] intervals in which there are no tracks"
    )
