"""ADS-B reception of a scenario."""

from __future__ import annotations

from pydantic import Field

from airhilt.geodesy.positions import Position
from airhilt.quantities import Number, PeriodS, Share
from airhilt.scenario.models.base import Identifier, Model


class AdsbReceiver(Model):
    """A receiver. It receives what is above its radio horizon and within its range."""

    name: Identifier
    position: Position
    antenna_height_ft: Number = Field(default=50.0, ge=-1500.0, le=60_000.0)
    range_nm: Number = Field(default=200.0, gt=0.0, le=500.0)


class Adsb(Model):
    """ADS-B reception. If no receiver is listed, one stands at the scene's centre."""

    receivers: tuple[AdsbReceiver, ...] = Field(default=(), max_length=100)
    loss_probability: Share = Field(default=0.05, description="probability that a squitter is lost")
    outages_s: tuple[PeriodS, ...] = Field(
        default=(), max_length=100, description="[from, to] intervals in which nothing is received"
    )
