"""The ``airports/*.json`` files: what an airport is, and where its numbers come from."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, Literal, Self, get_args

import pydantic
from pydantic import Field

from airhilt.geodesy.positions import Bearing, Latitude, Longitude, RunwayIdent, TaxiwayName
from airhilt.geodesy.wgs84 import Place, are_within_m
from airhilt.host import library
from airhilt.imaging.lenses import FieldOfView
from airhilt.quantities import AltitudeFt, Count, Flag, Number
from airhilt.scenario import documents
from airhilt.scenario.models.base import Model
from airhilt.scenario.problems import validated
from airhilt.units import DEGREE

FARTHEST_M = 100_000.0
"""Greatest distance of what an airport has from its reference point, in m."""
MOST_PARTS = 20_000
"""Greatest number of nodes, of corners and the like in one list."""
Text = Annotated[str, Field(max_length=2000)]
Point = tuple[Latitude, Longitude]
"""Latitude and longitude in degrees, as polygons have them."""
Polygon = Annotated[tuple[Point, ...], Field(min_length=3, max_length=MOST_PARTS)]
"""The corners of an area, in order; the last joins the first."""
Block = Literal[
    "reference",
    "elevation_ft",
    "magnetic_variation",
    "runways",
    "taxiways",
    "holds",
    "tower",
    "buildings",
    "water",
    "frequencies",
    "cameras",
]
Role = Literal["tower", "ground", "clearance", "approach", "departure", "atis", "unicom", "other"]


class _Located(Model):
    lat_deg: Latitude
    lon_deg: Longitude

    @property
    def place(self) -> Place:
        """Latitude and longitude in radians."""
        return self.lat_deg * DEGREE, self.lon_deg * DEGREE


class Source(Model):
    """Source of the numbers of a block."""

    text: str = Field(min_length=1, max_length=2000)
    synthetic: Flag = Field(
        default=False, description="true where the block is drawn or generated, not surveyed"
    )
    note: Text = ""


class ReferencePoint(_Located):
    """Point at which the airport's local frame touches the ellipsoid."""


class MagneticVariation(Model):
    """Angle from true north to magnetic north at the reference point."""

    east_deg: Number = Field(ge=-180.0, le=180.0, description="negative is west")
    epoch: Number = Field(ge=1900.0, le=2100.0, description="the year for which it holds")


class RunwayThreshold(_Located):
    """One end of a runway: where its pavement begins on the centre line."""

    ident: RunwayIdent
    elevation_ft: AltitudeFt
    displaced_threshold_ft: Number = Field(default=0.0, ge=0.0, le=20_000.0)
    heading_magnetic_deg: Bearing | None = None


class Runway(Model):
    """A strip of pavement that is used in both directions."""

    ends: tuple[RunwayThreshold, RunwayThreshold]
    width_ft: Number = Field(gt=0.0, le=1000.0)
    surface: Text = ""
    hold_distance_m: Number = Field(
        gt=0.0, le=1000.0, description="of the holding positions from the centre line"
    )

    @property
    def name(self) -> str:
        """Name such as ``01/19``."""
        return "/".join(end.ident for end in self.ends)


class Node(_Located):
    """A named point of the taxiways."""

    name: str = Field(min_length=1, max_length=40)
    kind: Literal["junction", "hold", "runway", "stand"] = "junction"


class Edge(Model):
    """A straight piece of a taxiway, used in both directions."""

    nodes: tuple[str, str]
    taxiway: TaxiwayName
    width_m: Number = Field(gt=0.0, le=500.0)


class Taxiways(Model):
    """The graph on which aircraft taxi and vehicles drive."""

    nodes: tuple[Node, ...] = Field(default=(), max_length=MOST_PARTS)
    edges: tuple[Edge, ...] = Field(default=(), max_length=MOST_PARTS)


class HoldShort(Model):
    """A node of the taxiways where traffic holds short of a runway."""

    node: str
    runway: str = Field(description="name of the whole runway, such as 01/19")
    taxiway: TaxiwayName
    side: TaxiwayName | None = Field(
        default=None, description="of the runway, where the taxiway has a hold on both"
    )

    @property
    def position(self) -> str:
        """The taxiway, and the side where it needs one: ``A``, or ``J_north``."""
        return f"{self.taxiway}_{self.side}" if self.side else self.taxiway


class Tower(_Located):
    """The control tower."""

    height_m: Number = Field(gt=0.0, le=1000.0, description="of the cab, above the ground")


class Building(Model):
    """A block on the ground."""

    name: Text
    footprint: Polygon
    height_m: Number = Field(gt=0.0, le=1000.0)


class Water(Model):
    """A river, a lake or the sea, as far as it can be seen."""

    name: Text
    outline: Polygon


class Frequency(Model):
    """A radio frequency and the unit that answers on it."""

    role: Role
    frequency_khz: Count = Field(ge=30_000, le=400_000)
    name: Text = ""


class Camera(_Located):
    """A fixed camera that watches the airport."""

    name: TaxiwayName
    height_m: Number = Field(gt=0.0, le=1000.0, description="above the ground")
    azimuth_deg: Bearing
    elevation_deg: Number = Field(ge=-90.0, le=90.0, description="negative looks down")
    horizontal_fov_deg: FieldOfView


class Airport(Model):
    """One ``airports/*.json``."""

    icao: str = Field(pattern=r"^[A-Z0-9-]{2,10}$")
    name: Text
    reference: ReferencePoint
    elevation_ft: AltitudeFt = Field(description="of the highest point of the runways")
    magnetic_variation: MagneticVariation
    runways: tuple[Runway, ...] = Field(min_length=1, max_length=50)
    taxiways: Taxiways = Taxiways()
    holds: tuple[HoldShort, ...] = Field(default=(), max_length=MOST_PARTS)
    tower: Tower | None = None
    buildings: tuple[Building, ...] = Field(default=(), max_length=MOST_PARTS)
    water: tuple[Water, ...] = Field(default=(), max_length=MOST_PARTS)
    frequencies: tuple[Frequency, ...] = Field(default=(), max_length=500)
    cameras: tuple[Camera, ...] = Field(default=(), max_length=500)
    sources: dict[Block, Source]

    @pydantic.model_validator(mode="after")
    def _is_in_one_place(self) -> Self:
        located: list[_Located] = [end for runway in self.runways for end in runway.ends]
        located += [*self.taxiways.nodes, *self.cameras, *([self.tower] if self.tower else [])]
        points = [(one.lat_deg, one.lon_deg) for one in located]
        points += [point for building in self.buildings for point in building.footprint]
        points += [point for water in self.water for point in water.outline]
        for lat_deg, lon_deg in points:
            place = lat_deg * DEGREE, lon_deg * DEGREE
            if not are_within_m(FARTHEST_M, self.reference.place, place):
                raise ValueError(
                    f"{lat_deg}, {lon_deg} is not near the reference point; expected at most "
                    f"{FARTHEST_M / 1000.0:.0f} km"
                )
        return self

    @pydantic.model_validator(mode="after")
    def _is_consistent(self) -> Self:
        edges, holds = self.taxiways.edges, self.holds
        nodes = [node.name for node in self.taxiways.nodes]
        used = [node for edge in edges for node in edge.nodes]
        runways = {runway.name for runway in self.runways}
        ends = [end.ident for runway in self.runways for end in runway.ends]
        _refuse_repeated("runway end", ends)
        _refuse_repeated("node", nodes)
        _refuse_repeated("hold", [f"{hold.runway} {hold.position}" for hold in holds])
        _refuse_repeated("camera", [camera.name for camera in self.cameras])
        _refuse_unknown("node", [*used, *(hold.node for hold in holds)], set(nodes))
        _refuse_unknown("runway", [hold.runway for hold in holds], runways)
        _refuse_unknown(
            "taxiway", [hold.taxiway for hold in holds], {edge.taxiway for edge in edges}
        )
        empty = (None, (), Taxiways())
        blocks = (block for block in get_args(Block) if getattr(self, block) not in empty)
        if bare := sorted(set(blocks) - set(self.sources)):
            raise ValueError(
                f"sources does not say where the numbers of {', '.join(bare)} are from"
            )
        return self


def load_airport(name: str, files: Mapping[str, Any] = MappingProxyType({})) -> Airport:
    """Return the airport of that ICAO location indicator, in upper or lower case.

    Parameters
    ----------
    files
        JSON objects by their names, of airports that do not ship with AIRHILT.

    Raises
    ------
    ScenarioError
        There is none, or its file is wrong: the message names the file, the place in it and
        what was expected.
    """
    if name in files:
        return validated(Airport, files[name], name)
    return read_airport(library.find("airports", name.lower()))


def read_airport(path: Path) -> Airport:
    """Read an airport from a file.

    Raises
    ------
    ScenarioError
        The file is wrong.
    """
    return validated(Airport, documents.read(path), str(path))


def _refuse_repeated(what: str, names: Sequence[str]) -> None:
    if repeated := sorted(name for name, count in Counter(names).items() if count > 1):
        raise ValueError(f"there is more than one {what} named {', '.join(repeated)}")


def _refuse_unknown(what: str, names: Sequence[str], known: set[str]) -> None:
    for name in names:
        if name not in known:
            raise ValueError(f"no {what} named {name!r}{library.nearest(name, sorted(known))}")
