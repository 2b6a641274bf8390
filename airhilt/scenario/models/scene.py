"""Scene of a scenario: an airport, or airspace without one; its weather and daylight."""

from __future__ import annotations

import datetime
from typing import Annotated, Literal

from pydantic import Field

from airhilt.geodesy.positions import Bearing, GeodeticPosition
from airhilt.quantities import Count, Date, FileName, Number, Share
from airhilt.scenario.models.base import Model

Visibility = Annotated[Number, Field(gt=0.0, le=100_000.0)]
"""Meteorological optical range in m."""


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


class Wind(Model):
    """A steady wind, the same everywhere."""

    from_deg: Bearing = 0.0
    speed_kt: Number = Field(default=0.0, ge=0.0, le=250.0)


class Turbulence(Model):
    """MIL-F-8785C turbulence: severity 0 is none, 3 light, 4 moderate, 6 severe."""

    severity: Count = Field(default=0, ge=0, le=7)
    wind_at_20ft_kt: Number = Field(default=15.0, ge=0.0, le=100.0)


class Weather(Model):
    """Wind, turbulence, visibility and rain."""

    wind: Wind = Wind()
    turbulence: Turbulence = Turbulence()
    visibility_m: Visibility = 10_000.0
    rain_mm_h: Number = Field(default=0.0, ge=0.0, le=150.0, description="rate of rainfall")
    cloud_cover: Share = Field(
        default=0.25,
        description="share of the sky in which thin clouds high up are seen, none in rain or at a "
        "visibility of 5.5 km or less; with any, fair-weather clouds "
        "stand about airports too, from 1200 to 1900 m, and hide what is behind them",
    )


class Appearance(Model):
    """Detail that cameras see."""

    texture: Share = Field(
        default=1.0,
        description="how much surfaces vary about their colours, as a share of what is seen in "
        "photographs",
    )


class Daylight(Model):
    """Date and time that set the sun's position; it stays there for the whole run."""

    date: Date = datetime.date(2026, 5, 1)
    solar_time_h: Number = Field(
        default=10.0, ge=0.0, lt=24.0, description="local solar time: the sun is highest at 12"
    )
