"""Distances over the ellipsoid: the cheap answers are those of the geodesic."""

from __future__ import annotations

import math
from itertools import product

import pytest

from airhilt.geodesy.wgs84 import are_within_m, distance_m, onward
from airhilt.units import DEGREE


@pytest.mark.parametrize("latitude_deg", [-89.0, -60.0, 0.0, 38.9, 75.0])
def test_places_are_within_a_limit_if_the_geodesic_is(latitude_deg: float) -> None:
    place = (latitude_deg * DEGREE, math.pi - 1e-5)  # On the other side of it is -pi.
    lengths_m, azimuths_deg = (1.0, 500.0, 40_000.0, 3_000_000.0), (0.0, 45.0, 90.0, 200.0, 315.0)
    for length_m, azimuth_deg in product(lengths_m, azimuths_deg):
        other = onward(place, azimuth_deg * DEGREE, length_m)
        geodesic_m = distance_m(place, other)
        for factor in (0.5, 0.999, 1.001, 2.0):
            is_within = are_within_m(factor * geodesic_m, place, other)
            assert is_within == (factor > 1.0), (length_m, azimuth_deg)
