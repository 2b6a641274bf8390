"""Simulated controllers of a scenario: how each responds to advisories and alerts."""

from __future__ import annotations

import typing
from typing import Literal

from pydantic import Field

from airhilt.quantities import FrequencyKhz, Share
from airhilt.scenario.models.actors import Reactions

Alerting = Literal[
    "loss_of_separation", "readback_mismatch", "runway_conflict", "clarification", "conflict_alert"
]
"""Alert that a controller acts on: a kind of advisory, or the conflict alert of the world."""


class Controller(Reactions):
    """Simulated controller of one unit: what it acts on, how soon, and how surely.

    Reaction time and compliance are those of the response model, unless given here.
    """

    acts_on: tuple[Alerting, ...] = Field(
        default=typing.get_args(Alerting),
        description="kinds of advisories that it acts on, and conflict_alert for that of the world",
    )
    frequencies_khz: tuple[FrequencyKhz, ...] = Field(
        default=(),
        max_length=20,
        description="frequencies of its unit besides those of the unit's radio lines",
    )
    ignores_contradicted: Share = Field(
        default=0.0,
        description="probability of ignoring an advisory that its own displays contradict: by "
        "them, no two of the traffic come near each other",
    )
