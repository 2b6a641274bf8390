"""The reach of radars and surface surveillance, and the validity of their replies."""

from __future__ import annotations

from typing import Any

import pytest
from geographiclib.geodesic import Geodesic

from airhilt import load
from airhilt.messages import RadarKind, RadarPlot, SurfaceTrack
from airhilt.scenario.models import Radar, SurfaceSurveillance
from airhilt.sensors import radar, surface
from airhilt.sensors.base import SensorType
from airhilt.surveillance.radar import Antenna
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE
from airhilt.world.mover import SurfaceState
from airhilt.world.site import ScenarioSite
from sensed import Acting, Body, sense

CENTRE = {"type": "from_centre", "bearing_deg": 0.0, "distance_nm": 0.0}


class Field:
    """Washington National with a radar in its middle, and one airliner in the air."""

    def __init__(self, kind: RadarKind = "terminal") -> None:
        given = load("s01b_noncompliance")
        site = Radar.model_validate({"name": "R1", "kind": kind, "position": CENTRE})
        seen = {"radars": (site,), "surface_surveillance": SurfaceSurveillance()}
        self.scenario = given.model_copy(update=seen)
        self.site = ScenarioSite.of(self.scenario)
        self.centre = self.site.place(self.site.centre)
        self.antenna = Antenna(*self.centre, self.site.ground_m + site.antenna_height_ft * FOOT)

    def state(
        self, away_m: float, height_m: float, north_m_s: float = 0.0, east_m_s: float = 0.0
    ) -> SurfaceState:
        degrees = [angle / DEGREE for angle in self.centre]
        there = Geodesic.WGS84.Direct(*degrees, 90.0, away_m)
        place = there["lat2"] * DEGREE, there["lon2"] * DEGREE
        altitude_m = self.site.ground_m + height_m
        return SurfaceState(*place, altitude_m, height_m, north_m_s, east_m_s, 0.0, 0.0)

    def at_range(self, range_nm: float, height_m: float) -> SurfaceState:
        """Return the state at a slant range from the antenna, found by bisection."""
        near_m, far_m = 0.0, 1.1 * range_nm * NAUTICAL_MILE
        while far_m - near_m > 1.0:
            middle_m = 0.5 * (near_m + far_m)
            slant_m = self.antenna.to(self.state(middle_m, height_m)).range_m
            if slant_m < range_nm * NAUTICAL_MILE:
                near_m = middle_m
            else:
                far_m = middle_m
        return self.state(near_m, height_m)

    def seen(self, sensor_type: SensorType, state: SurfaceState, seconds: float) -> list[Any]:
        """Return the plots or tracks of an airliner in a state."""
        published: list[Any] = []
        aircraft = self.scenario.actors[0]
        actors = {aircraft.callsign: Acting(aircraft, Body(state))}

        def publish(_: str, message: Any, *, raw: bytes | None = None) -> None:
            published.append(message)

        sense(sensor_type, self.scenario, self.site, actors, publish, seconds)
        return [each for each in published if isinstance(each, RadarPlot | SurfaceTrack)]


def test_radars_see_as_far_as_their_sources_say(subtests: pytest.Subtests) -> None:
    """The FAA gives 60 NM for the primary radar of the ASR-11; 120 and 250 NM are typical, and so
    are the least ranges of 0.5 and 5 NM. What
    stands in the air so near is taken for the ground by the primary radar."""
    rows: list[Any] = [
        ("terminal", 0.45, 500, False, False),
        ("terminal", 0.55, 500, False, True),
        ("en_route", 4.9, 3_000, False, False),
        ("en_route", 5.1, 3_000, False, True),
        ("terminal", 59.7, 15_000, True, True),
        ("terminal", 60.3, 15_000, False, True),
        ("terminal", 119.7, 30_000, False, True),
        ("terminal", 120.3, 30_000, False, False),
        ("en_route", 249.7, 60_000, True, True),
        ("en_route", 250.3, 60_000, False, False),
    ]
    for kind, range_nm, height_ft, has_echo, has_reply in rows:
        with subtests.test(str((kind, range_nm, height_ft, has_echo, has_reply))):
            field = Field(kind)
            plots = field.seen(radar.SENSOR, field.at_range(range_nm, height_ft * FOOT), 240.0)
            assert any(plot.kind != "secondary" for plot in plots) == has_echo
            assert any(plot.kind != "primary" for plot in plots) == has_reply


def test_over_an_airport_radar_sees_up_to_200_ft_and_transponders_are_located_in_class_d(
    subtests: pytest.Subtests,
) -> None:
    """AIM 4-5-5 gives the height of the radar, and AIM 3-2-5 that of class D airspace."""
    for height_ft, kinds in [
        (195.0, {"primary", "secondary", "combined"}),
        (205.0, {"secondary"}),
        (2_499.5, {"secondary"}),
        (2_500.5, set()),
    ]:
        with subtests.test(str((height_ft, kinds))):
            field = Field()
            tracks = field.seen(surface.SENSOR, field.state(1_000.0, height_ft * FOOT), 120.0)
            assert {track.kind for track in tracks} == kinds
