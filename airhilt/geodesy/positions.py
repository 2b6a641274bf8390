"""Positions as scenario files and commands state them."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from airhilt.quantities import DistanceNm, Name, Number

Latitude = Annotated[Number, Field(ge=-90.0, le=90.0)]
Longitude = Annotated[Number, Field(ge=-180.0, le=180.0)]
Bearing = Annotated[Number, Field(ge=0.0, le=360.0, description="degrees from true north")]
RunwayIdent = Annotated[
    str, Field(pattern=r"^\d{1,2}[A-Z]{0,2}$", examples=["01", "18C"], description="one direction")
]
TaxiwayName = Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]{1,20}$", examples=["J"])]


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class GeodeticPosition(_Model):
    """A WGS84 latitude and longitude."""

    type: Literal["geodetic"]
    lat_deg: Latitude
    lon_deg: Longitude


class RelativePosition(_Model):
    """A bearing and a distance from the scene's centre, then an offset to the right of it.

    ``offset_nm`` is across the line from the centre: positive is clockwise, seen from the centre.
    """

    type: Literal["from_centre"]
    bearing_deg: Bearing
    distance_nm: DistanceNm
    offset_nm: Number = Field(default=0.0, ge=-100.0, le=100.0)


class RunwayPosition(_Model):
    """A place along a runway's centre line, counted from the landing threshold.

    A negative distance lies on final approach; ``offset_m`` is to the right of the centre line,
    in the direction of landing.
    """

    type: Literal["runway"]
    runway: RunwayIdent
    along_m: Number = Field(ge=-100_000.0, le=20_000.0)
    offset_m: Number = Field(default=0.0, ge=-50_000.0, le=50_000.0)


class HoldShortPosition(_Model):
    """The hold-short position of a runway on a taxiway."""

    type: Literal["hold_short"]
    runway: RunwayIdent
    taxiway: TaxiwayName


class NodePosition(_Model):
    """A named node of the airport's taxiways: a stand, a junction."""

    type: Literal["node"]
    node: Name


Position = Annotated[
    GeodeticPosition | RelativePosition | RunwayPosition | HoldShortPosition | NodePosition,
    Field(discriminator="type"),
]
