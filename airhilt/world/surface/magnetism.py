"""Magnetic variation from the World Magnetic Model."""

from __future__ import annotations

import math

from airhilt.errors import ScenarioError
from airhilt.geodesy.wgs84 import Place, distance_and_azimuth
from airhilt.units import DEGREE
from airhilt.world.surface.airport import MagneticVariation, Runway, RunwayThreshold, Source

MODEL = "WMM_2025"
FIRST_YEAR, LAST_YEAR = 2025.0, 2030.0
"""First and last year for which the coefficients hold."""
SOURCE = Source(
    text="World Magnetic Model 2025 (NOAA/NCEI and British Geological Survey), by pygeomag"
)


def magnetic_variation(place: Place, year: float) -> MagneticVariation:
    """Return the variation at a place on the ground, rounded to a hundredth of a degree.

    The model's own uncertainty is about 0.3 to 0.5 degrees at the latitudes of most airports
    (The US/UK World Magnetic Model for 2025-2030, section 3).

    Raises
    ------
    ScenarioError
        The model does not cover the year.
    """
    from pygeomag import GeoMag

    if not FIRST_YEAR <= year <= LAST_YEAR:
        raise ScenarioError(
            f"no magnetic variation for {year}: the World Magnetic Model covers "
            f"{FIRST_YEAR:.0f} to {LAST_YEAR:.0f}; state the variation itself"
        )
    model = GeoMag(coefficients_file=f"wmm/{MODEL}.COF")
    found = model.calculate(glat=place[0] / DEGREE, glon=place[1] / DEGREE, alt=0.0, time=year)
    return MagneticVariation(east_deg=round(found.d, 2), epoch=year)


def with_magnetic_headings(runway: Runway, variation: MagneticVariation) -> Runway:
    """Return a runway with the headings that its coordinates and the variation give."""
    low, high = runway.ends
    ends = _with_heading(low, high, variation), _with_heading(high, low, variation)
    return runway.model_copy(update={"ends": ends})


def _with_heading(
    here: RunwayThreshold, there: RunwayThreshold, variation: MagneticVariation
) -> RunwayThreshold:
    true_deg = math.degrees(distance_and_azimuth(here.place, there.place)[1])
    magnetic_deg = round((true_deg - variation.east_deg) % 360.0, 1) % 360.0
    return here.model_copy(update={"heading_magnetic_deg": magnetic_deg})
