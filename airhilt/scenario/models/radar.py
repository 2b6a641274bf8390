"""Surveillance radars of a scenario."""

from __future__ import annotations

from pydantic import Field

from airhilt.geodesy.positions import Position
from airhilt.messages import RadarKind
from airhilt.quantities import Number
from airhilt.scenario.models.base import Identifier, Model


class Radar(Model):
    """A surveillance radar, primary and secondary on one antenna.

    A terminal radar turns once in 4.8 s and reaches 60 NM (replies 120 NM), an en-route radar turns
    once in 12 s and reaches 250 NM.
    """

    name: Identifier
    kind: RadarKind = "terminal"
    position: Position
    antenna_height_ft: Number = Field(
        default=75.0, ge=0.0, le=10_000.0, description="above the ground"
    )
