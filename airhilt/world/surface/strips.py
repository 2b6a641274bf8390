"""Runways with the areas around them that their holding positions protect."""

from __future__ import annotations

import math
from dataclasses import dataclass

from shapely import LineString, Polygon

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import distance_and_azimuth, onward
from airhilt.units import FOOT
from airhilt.world.surface import path as lines
from airhilt.world.surface.airport import Runway, RunwayThreshold
from airhilt.world.surface.runway import RunwayEnd

STRIP_BEYOND_END_M = 60.0
"""Length of a runway strip beyond the end of the runway, in m (ICAO Annex 14 volume I, 3.4.2)."""


@dataclass(frozen=True)
class RunwayStrip:
    """A runway with the area around it that its holding positions protect."""

    name: str
    """Name such as ``01/19``."""
    ends: tuple[RunwayEnd, RunwayEnd]
    """Its two directions, in the order of the name."""
    pavement: Polygon
    protected_area: Polygon
    centreline: LineString
    """Shapes in local metres. The protected area reaches to the holding positions on both sides and
    60 m beyond both ends of the pavement: ICAO Doc 9870, Manual on the Prevention of Runway
    Incursions, 1.1, counts an incursion within the area protected by the holding positions."""
    hold_distance_m: float
    """Distance of the holding positions from the centre line: FAA AC 150/5300-13B, runway design
    standards matrix (appendix G), 250 ft for approach categories C and D; ICAO Annex 14 volume I,
    table 3-2, 90 m for code number 4 with precision approaches."""

    start: lines.Local
    along: lines.Local
    """Begin of the centre line, and the unit vector to its end."""
    pavement_m: float
    """Length of the centre line."""

    def protects(self, point: lines.Local, margin_m: float = 0.0) -> bool:
        """Return whether a point, in local metres, lies in the protected area or near it.

        Parameters
        ----------
        margin_m
            Distance along and beside the runway by which the area is larger.
        """
        east_m, north_m = point[0] - self.start[0], point[1] - self.start[1]
        along_m = east_m * self.along[0] + north_m * self.along[1]
        aside_m = east_m * self.along[1] - north_m * self.along[0]
        beyond_m = STRIP_BEYOND_END_M + margin_m
        return (
            abs(aside_m) < self.hold_distance_m + margin_m
            and -beyond_m < along_m < self.pavement_m + beyond_m
        )


def runway_strip(runway: Runway, local_frame: LocalFrame) -> RunwayStrip:
    """Return a runway of an airport's file with the area around it, in local metres."""
    low, high = runway.ends
    a, b = local_frame.to_local(low.place), local_frame.to_local(high.place)
    width_m = runway.width_ft * FOOT
    pavement_m = math.dist(a, b)
    beyond = STRIP_BEYOND_END_M / pavement_m
    centreline = LineString([a, b])
    longer = LineString([lines.between(a, b, -beyond), lines.between(a, b, 1.0 + beyond)])
    return RunwayStrip(
        name=runway.name,
        ends=(_runway_end(low, high, width_m), _runway_end(high, low, width_m)),
        pavement=_band(centreline, width_m / 2.0),
        protected_area=_band(longer, runway.hold_distance_m),
        centreline=centreline,
        hold_distance_m=runway.hold_distance_m,
        start=a,
        along=lines.unit(a, b),
        pavement_m=pavement_m,
    )


def _runway_end(here: RunwayThreshold, there: RunwayThreshold, width_m: float) -> RunwayEnd:
    length_m, course_rad = distance_and_azimuth(here.place, there.place)
    displaced_m = here.displaced_threshold_ft * FOOT
    slope = (there.elevation_ft - here.elevation_ft) * FOOT / length_m
    return RunwayEnd(
        ident=here.ident,
        start=here.place,
        threshold=onward(here.place, course_rad, displaced_m),
        end=there.place,
        elevation_m=here.elevation_ft * FOOT + slope * displaced_m,
        width_m=width_m,
        length_m=length_m,
        displaced_m=displaced_m,
        course_rad=course_rad,
    )


def _band(line: LineString, half_width_m: float) -> Polygon:
    band = line.buffer(half_width_m, cap_style="flat")
    assert isinstance(band, Polygon)
    return band
