"""Surface surveillance of a scenario's airport."""

from __future__ import annotations

from pydantic import Field

from airhilt.scenario.models.base import Model


class SurfaceSurveillance(Model):
    """Surface movement radar and multilateration of the airport, fused."""

    loss_probability: float = Field(
        default=0.0,
        ge=0.0,
        le=1.0,
        description="probability that a target has no track in one second, besides the "
        "probabilities of detection",
    )
    outages_s: tuple[tuple[float, float], ...] = Field(
        default=(), description="[from, to] intervals in which there are no tracks"
    )
