"""Site of a scenario, and its positions on the WGS84 ellipsoid."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
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
            return cls(scene.centre, scene.terrain_elevation_ft * FOOT)
        # Not at the top: scenarios without an airport start without the libraries behind it.
        from airhilt.world.surface.airport import load_airport
        from airhilt.world.surface.layout import Layout

        layout = Layout(load_airport(scene.airport, scenario.files))
        latitude, longitude = layout.local_frame.to_place(0.0, 0.0)
        centre = GeodeticPosition(
            type="geodetic", lat_deg=latitude / DEGREE, lon_deg=longitude / DEGREE
        )
        return cls(centre, layout.elevation_m, layout)

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
