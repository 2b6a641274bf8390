"""Site of a scenario, and its positions on the WGS84 ellipsoid."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from airhilt.errors import ScenarioError
from airhilt.geodesy.positions import (
    GeodeticPosition,
    HoldShortPosition,
    NodePosition,
    Position,
    RelativePosition,
    RunwayPosition,
)
from airhilt.geodesy.wgs84 import Place, azimuth, beside, onward
from airhilt.scenario.models import EnRouteScene, Scenario
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE
from airhilt.world.surface.runway import RunwayEnd

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Layout


FIELD = ("field", "airport", "aerodrome", "airfield", "overhead")
"""Words for the airport."""


@dataclass(frozen=True)
class FixedSite:
    """Fixed place on the ground or in the air, with the attributes of a moving one."""

    latitude_rad: float
    longitude_rad: float
    altitude_m: float = 0.0
    velocity_north_m_s: float = 0.0
    velocity_east_m_s: float = 0.0


@dataclass(frozen=True)
class ScenarioSite:
    """Centre and ground elevation of a scenario, and its airport if it has one."""

    centre: GeodeticPosition
    ground_m: float
    layout: Layout | None = None
    fixes: Mapping[str, Position] = field(default_factory=dict)
    """Named places of the scenario."""

    @classmethod
    def of(cls, scenario: Scenario) -> ScenarioSite:
        """Return the site of a scenario.

        Raises
        ------
        ScenarioError
            There is no such airport.
        """
        scene = scenario.scene
        if isinstance(scene, EnRouteScene):
            return cls(scene.centre, scene.terrain_elevation_ft * FOOT, fixes=scenario.fixes)
        # Not at the top: scenarios without an airport start without the libraries behind it.
        from airhilt.world.surface.layout import load_layout

        layout = load_layout(scene.airport, scenario.files)
        latitude, longitude = layout.local_frame.to_place(0.0, 0.0)
        centre = GeodeticPosition(
            type="geodetic", lat_deg=latitude / DEGREE, lon_deg=longitude / DEGREE
        )
        return cls(centre, layout.elevation_m, layout, scenario.fixes)

    @property
    def airport(self) -> Layout:
        """Layout of the airport.

        Raises
        ------
        ScenarioError
            The scenario takes place en route.
        """
        if self.layout is None:
            raise ScenarioError(
                "there is no runway or taxiway here: the scene is en route; expected a scene of "
                "type 'airport'"
            )
        return self.layout

    @property
    def variation_deg(self) -> float | None:
        """Magnetic variation in degrees, positive east; None en route, where none is given."""
        return None if self.layout is None else self.layout.airport.magnetic_variation.east_deg

    def runway(self, ident: str) -> RunwayEnd:
        """Return a direction of a runway, at the height of the flat ground.

        Raises
        ------
        ScenarioError
            There is no airport, or no such runway.
        """
        return replace(self.airport.runway(ident), elevation_m=self.ground_m)

    def fix(self, name: str) -> Place | None:
        """Return the place of a fix, the threshold of a runway, or the airport; None if unknown.

        The airport is known by its location indicator, its name, and as the field.
        """
        words = _words(name)
        for known, position in self.fixes.items():
            if _words(known) == words:
                return self.place(position)
        if self.layout is None:
            return None
        if words.startswith("runway "):
            try:
                return self.runway(words.removeprefix("runway ").upper()).threshold
            except ScenarioError:
                return None
        airport = self.layout.airport
        if words in (*FIELD, _words(airport.icao), _words(airport.name)):
            return self.place(self.centre)
        return None

    def place(self, position: Position) -> Place:
        """Return a position as latitude and longitude in radians.

        Raises
        ------
        ScenarioError
            It refers to a runway, a hold-short position or a node that does not exist.
        """
        match position:
            case GeodeticPosition():
                return position.lat_deg * DEGREE, position.lon_deg * DEGREE
            case RelativePosition():
                centre = (self.centre.lat_deg * DEGREE, self.centre.lon_deg * DEGREE)
                bearing = position.bearing_deg * DEGREE
                there = onward(centre, bearing, position.distance_nm * NAUTICAL_MILE)
                if position.distance_nm:
                    # At the far end the azimuth differs from that at which the geodesic began.
                    bearing = azimuth(there, centre) + math.pi
                return beside(there, bearing, position.offset_nm * NAUTICAL_MILE)
            case RunwayPosition():
                end = self.airport.runway(position.runway)
                course = azimuth(end.threshold, end.end)
                there = onward(end.threshold, course, position.along_m)
                return beside(there, course, position.offset_m)
            case HoldShortPosition():
                return self.airport.hold(position.runway, position.taxiway).place
            case NodePosition():
                return self.airport.node(position.node)


def _words(name: str) -> str:
    """Return a name in lower case, without its article and without what is no letter or digit."""
    words = re.findall(r"[a-z0-9]+", name.lower())
    return " ".join(words[1:] if words[:1] == ["the"] else words)
