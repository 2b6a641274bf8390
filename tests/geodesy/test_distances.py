"""Distances over the ellipsoid: the cheap answers are those of the geodesic."""

from __future__ import annotations

import math

import pytest

from airhilt.geodesy.wgs84 import are_within_m, distance_m, onward
from airhilt.units import DEGREE


@pytest.mark.parametrize("latitude_deg", [-89.0, -60.0, 0.0, 38.9, 75.0])
@pytest.mark.parametrize("length_m", [1.0, 500.0, 40_000.0, 3_000_000.0])
@pytest.mark.parametrize("azimuth_deg", [0.0, 45.0, 90.0, 200.0, 315.0])
def test_places_are_within_a_limit_if_the_geodesic_is(
    latitude_deg: float, length_m: float, azimuth_deg: float
) -> None:
    place = (latitude_deg * DEGREE, math.pi - 1e-5)  # On the other side of it is -pi.
    other = onward(place, azimuth_deg * DEGREE, length_m)
    length_m = distance_m(place, other)
    for factor in (0.5, 0.999, 1.001, 2.0):
        assert are_within_m(factor * length_m, place, other) == (factor > 1.0)
