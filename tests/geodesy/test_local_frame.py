"""The local frame and the geodesics of the ellipsoid agree."""

from __future__ import annotations

import math

import pytest
from geographiclib.geodesic import Geodesic
from hypothesis import given
from hypothesis import strategies as st

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import distance_and_azimuth, onward

latitudes = st.floats(-80.0, 80.0)
longitudes = st.floats(-180.0, 180.0)
bearings = st.floats(0.0, 360.0)


@given(latitudes, longitudes, st.floats(-10_000.0, 10_000.0), st.floats(-10_000.0, 10_000.0))
def test_there_and_back_is_exact_to_a_micrometre(
    latitude: float, longitude: float, east: float, north: float
) -> None:
    frame = LocalFrame((math.radians(latitude), math.radians(longitude)))
    back = frame.to_local(frame.to_place(east, north))
    assert back == pytest.approx((east, north), abs=1e-6)


@given(latitudes, longitudes, bearings, st.floats(0.0, 5000.0))
def test_a_point_lies_where_the_geodesic_from_the_origin_ends(
    latitude: float, longitude: float, bearing: float, distance: float
) -> None:
    frame = LocalFrame((math.radians(latitude), math.radians(longitude)))
    end = Geodesic.WGS84.Direct(latitude, longitude, bearing, distance)
    east, north = frame.to_local((math.radians(end["lat2"]), math.radians(end["lon2"])))
    expected = (
        distance * math.sin(math.radians(bearing)),
        distance * math.cos(math.radians(bearing)),
    )
    assert (east, north) == pytest.approx(expected, abs=0.001)


@given(
    latitudes,
    longitudes,
    st.tuples(bearings, st.floats(0.0, 5000.0)),
    st.tuples(bearings, st.floats(0.0, 5000.0)),
)
def test_distances_within_five_kilometres_are_right_to_four_parts_in_ten_million(
    latitude: float, longitude: float, first: tuple[float, float], second: tuple[float, float]
) -> None:
    frame = LocalFrame((math.radians(latitude), math.radians(longitude)))
    places = []
    for bearing, distance in (first, second):
        end = Geodesic.WGS84.Direct(latitude, longitude, bearing, distance)
        places.append((math.radians(end["lat2"]), math.radians(end["lon2"])))
    geodesic, _ = distance_and_azimuth(*places)
    flat = math.dist(*(frame.to_local(place) for place in places))
    assert flat == pytest.approx(geodesic, rel=4e-7, abs=2e-6)


@given(latitudes, bearings, st.floats(0.0, 5000.0), st.floats(-400.0, 4000.0))
def test_distances_are_true_at_the_height_of_the_frame(
    latitude: float, bearing: float, distance: float, height: float
) -> None:
    """The radius of curvature at some bearing differs from the mean one by at most 0.34 %."""
    frame = LocalFrame((math.radians(latitude), 0.0), height)
    end = Geodesic.WGS84.Direct(latitude, 0.0, bearing, distance)
    local = frame.to_local((math.radians(end["lat2"]), math.radians(end["lon2"])))
    aloft = distance * (1.0 + height / 6_371_000.0)
    assert math.hypot(*local) == pytest.approx(aloft, rel=4e-6, abs=2e-6)
    assert frame.to_local(frame.to_place(*local)) == pytest.approx(local, abs=1e-6)


@pytest.mark.parametrize("origin", [(math.pi / 2.0, 0.0), (math.nan, 0.0), (0.0, math.inf)])
def test_a_frame_has_its_origin_somewhere_on_earth(origin: tuple[float, float]) -> None:
    with pytest.raises(ValueError, match="no latitude and longitude in radians off the poles"):
        LocalFrame(origin)


def test_the_frame_goes_across_the_antimeridian() -> None:
    frame = LocalFrame((0.0, math.pi))
    assert frame.to_local((0.0, -math.pi + 0.0001))[0] == pytest.approx(637.8, abs=0.1)


@pytest.mark.parametrize("point", [(90_000.0, 90_000.0), (math.nan, 0.0), (math.inf, 0.0)])
def test_what_is_no_place_near_the_origin_is_refused(point: tuple[float, float]) -> None:
    with pytest.raises(ValueError, match="beyond the local frame"):
        LocalFrame((0.0, 0.0)).to_place(*point)


@given(latitudes, longitudes, bearings, st.floats(1.0, 20_000.0))
def test_going_onward_arrives_at_that_distance_and_azimuth(
    latitude: float, longitude: float, bearing: float, distance: float
) -> None:
    start = (math.radians(latitude), math.radians(longitude))
    length, azimuth = distance_and_azimuth(start, onward(start, math.radians(bearing), distance))
    assert length == pytest.approx(distance, abs=1e-6)
    assert math.cos(azimuth - math.radians(bearing)) == pytest.approx(1.0, abs=1e-9)
