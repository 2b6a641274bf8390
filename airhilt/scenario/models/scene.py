"""Scene of a scenario: an airport, or airspace without one."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from airhilt.geodesy.positions import GeodeticPosition
from airhilt.quantities import FileName, Number
from airhilt.scenario.models.base import Model


class EnRouteScene(Model):
    """Airspace away from any airport."""

    type: Literal["en_route"]
    centre: GeodeticPosition
    terrain_elevation_ft: Number = Field(default=0.0, ge=-1500.0, le=29_000.0)


class AirportScene(Model):
    """An airport and the airspace around it.

    The airport's reference point is the scene's centre. The ground is flat, at the airport's
    elevation.
    """

    type: Literal["airport"]
    airport: FileName = Field(
        description="its ICAO location indicator, or a file beside the scenario",
        examples=["KDCA", "kaus.json"],
    )


Scene = Annotated[EnRouteScene | AirportScene, Field(discriminator="type")]
