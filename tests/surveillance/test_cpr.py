"""Compact position reporting: encoded and decoded, a position is where it was."""

from __future__ import annotations

import math

import pytest
from geographiclib.geodesic import Geodesic
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from airhilt.surveillance import cpr

thoroughly = settings(deadline=None, max_examples=500)

latitudes = st.floats(-90.0, 90.0) | st.floats(-90.0, -83.0) | st.floats(83.0, 90.0)
longitudes = st.floats(-180.0, 180.0) | st.floats(179.9, 180.0) | st.floats(-180.0, -179.9)
bearings = st.floats(0.0, 360.0)


def off_m(one: tuple[float, float], other: tuple[float, float]) -> float:
    return float(Geodesic.WGS84.Inverse(*one, *other)["s12"])


def resolution_m(latitude_deg: float) -> float:
    """Longitude zones are as much as 360 degrees wide next to a pole, so 17 bits are coarser."""
    return 6.0 if abs(latitude_deg) < 84.0 else 11.0


@thoroughly
@given(latitudes, longitudes, st.booleans())
@example(90.0, 0.0, False)
@example(-90.0, 0.0, True)
@example(0.0, 180.0, True)
@example(0.0, -180.0, False)
@example(87.0, 179.99999, True)
def test_a_position_decoded_near_itself_is_where_it_was(
    latitude: float, longitude: float, odd: bool
) -> None:
    encoded = cpr.encode(latitude, longitude, odd)
    assert 0 <= encoded.latitude < 2**17
    assert 0 <= encoded.longitude < 2**17
    decoded = cpr.decode_local(encoded, (latitude, longitude))
    assert off_m(decoded, (latitude, longitude)) < resolution_m(latitude)
    assert -180.0 <= decoded[1] <= 180.0


@pytest.mark.parametrize("odd", [False, True])
def test_on_the_edge_of_a_zone_rounding_does_not_move_a_position_to_the_next(odd: bool) -> None:
    zone_deg = 360.0 / (60 - int(odd))
    for index in range(-14, 15):
        edge = index * zone_deg
        for latitude in (math.nextafter(edge, -91.0), edge, math.nextafter(edge, 91.0)):
            for longitude in (edge, 180.0, -180.0):
                encoded = cpr.encode(latitude, longitude, odd)
                decoded = cpr.decode_local(encoded, (latitude, longitude))
                assert off_m(decoded, (latitude, longitude)) < resolution_m(latitude)


@thoroughly
@given(st.floats(-70.0, 70.0), longitudes, st.booleans(), bearings, st.floats(0.0, 270_000.0))
def test_a_reference_within_145_nm_is_near_enough(
    latitude: float, longitude: float, odd: bool, bearing: float, distance_m: float
) -> None:
    away = Geodesic.WGS84.Direct(latitude, longitude, bearing, distance_m)
    encoded = cpr.encode(latitude, longitude, odd)
    decoded = cpr.decode_local(encoded, (away["lat2"], away["lon2"]))
    assert off_m(decoded, (latitude, longitude)) < resolution_m(latitude)


@thoroughly
@given(latitudes, longitudes, st.booleans())
@example(0.0, 180.0, True)
@example(0.0, -180.0, False)
@example(89.9, 179.99999, True)
def test_an_even_and_an_odd_position_need_no_reference(
    latitude: float, longitude: float, newest_is_odd: bool
) -> None:
    even, odd = (cpr.encode(latitude, longitude, odd) for odd in (False, True))
    decoded = cpr.decode_global(even, odd, newest_is_odd)
    if decoded is None:
        near = {cpr.longitude_zones(abs(latitude) + step) for step in (-1e-4, 1e-4)}
        assert len(near) == 2 or abs(latitude) > 90.0 - 1e-4
        return
    assert off_m(decoded, (latitude, longitude)) < resolution_m(latitude)


@thoroughly
@given(st.floats(-80.0, 80.0), longitudes, bearings, st.floats(0.0, 3_000.0), st.booleans())
def test_a_pair_that_was_sent_on_the_move_gives_the_newest_position(
    latitude: float, longitude: float, bearing: float, distance_m: float, newest_is_odd: bool
) -> None:
    moved = Geodesic.WGS84.Direct(latitude, longitude, bearing, distance_m)
    newest = (moved["lat2"], moved["lon2"])
    first = cpr.encode(latitude, longitude, not newest_is_odd)
    second = cpr.encode(*newest, newest_is_odd)
    even, odd = (first, second) if newest_is_odd else (second, first)
    decoded = cpr.decode_global(even, odd, newest_is_odd)
    zones = [cpr.longitude_zones(lat) for lat in (latitude, newest[0])]
    assume(zones[0] == zones[1] and decoded is not None)
    assert decoded is not None
    assert off_m(decoded, newest) < resolution_m(latitude)


def test_longitude_zones_are_those_of_the_table_in_do_260b(subtests: pytest.Subtests) -> None:
    for boundary_deg, zones_below in [
        (10.47047130, 59),
        (14.82817437, 58),
        (23.54504487, 55),
        (36.85025108, 48),
        (45.54626723, 42),
        (54.27817472, 35),
        (60.0, None),
        (65.31845310, 25),
        (75.42056257, 15),
        (82.13956981, 8),
        (85.75541621, 4),
        (86.53536998, 3),
        (87.0, 2),
    ]:
        with subtests.test(str((boundary_deg, zones_below))):
            step = 1e-6
            below, above = (cpr.longitude_zones(boundary_deg + s) for s in (-step, step))
            if zones_below is None:
                assert below == above == 29
            else:
                assert (below, above) == (zones_below, zones_below - 1)


def test_there_are_59_zones_at_the_equator_and_one_at_the_poles() -> None:
    assert [cpr.longitude_zones(lat) for lat in (0.0, 90.0, -90.0)] == [59, 1, 1]


def test_two_latitudes_either_side_of_a_change_of_zones_are_not_decoded_together() -> None:
    boundary = 10.4704713
    even = cpr.encode(boundary - 1e-3, 8.0, odd=False)
    odd = cpr.encode(boundary + 1e-3, 8.0, odd=True)
    assert cpr.decode_global(even, odd, newest_is_odd=True) is None


def test_the_published_example_decodes_to_where_it_is_published_to_be() -> None:
    """The 1090 Megahertz Riddle (J. Sun, 2021), chapter 5: 8D40621D58C382D690C8AC2863A7."""
    even = cpr.CprPosition(93000, 51372, odd=False)
    odd = cpr.CprPosition(74158, 50194, odd=True)
    decoded = cpr.decode_global(even, odd, newest_is_odd=False)
    assert decoded is not None
    latitude, longitude = decoded
    assert latitude == pytest.approx(52.2572, abs=1e-4)
    assert longitude == pytest.approx(3.91937, abs=1e-4)
    assert cpr.decode_local(even, (52.258, 3.918)) == pytest.approx((latitude, longitude))
    assert math.isclose(cpr.decode_local(odd, (52.258, 3.918))[0], 52.26578, abs_tol=1e-4)


# --- the surface format ---------------------------------------------------------------------


@thoroughly
@given(latitudes, longitudes, st.booleans())
@example(90.0, 0.0, False)
@example(0.0, 180.0, True)
@example(0.0, -180.0, False)
@example(87.0, 179.99999, True)
def test_a_surface_position_decoded_near_itself_is_four_times_as_exact(
    latitude: float, longitude: float, odd: bool
) -> None:
    encoded = cpr.encode(latitude, longitude, odd, surface=True)
    assert 0 <= encoded.latitude < 2**17
    assert 0 <= encoded.longitude < 2**17
    decoded = cpr.decode_local(encoded, (latitude, longitude))
    assert off_m(decoded, (latitude, longitude)) < resolution_m(latitude) / 4.0


@thoroughly
@given(st.floats(-70.0, 70.0), longitudes, st.booleans(), bearings, st.floats(0.0, 60_000.0))
def test_on_the_surface_a_reference_within_32_nm_is_near_enough(
    latitude: float, longitude: float, odd: bool, bearing: float, distance_m: float
) -> None:
    away = Geodesic.WGS84.Direct(latitude, longitude, bearing, distance_m)
    encoded = cpr.encode(latitude, longitude, odd, surface=True)
    decoded = cpr.decode_local(encoded, (away["lat2"], away["lon2"]))
    assert off_m(decoded, (latitude, longitude)) < resolution_m(latitude) / 4.0


@thoroughly
@given(st.floats(-80.0, 80.0), longitudes, bearings, st.floats(0.0, 100_000.0), st.booleans())
@example(0.0, 180.0, 90.0, 1_000.0, True)
@example(-45.0, -180.0, 270.0, 1_000.0, False)
@example(0.001, 8.0, 180.0, 50_000.0, False)
def test_a_surface_pair_is_where_it_was_if_the_receiver_is_near(
    latitude: float, longitude: float, bearing: float, distance_m: float, newest_is_odd: bool
) -> None:
    even, odd = (cpr.encode(latitude, longitude, odd, surface=True) for odd in (False, True))
    site = Geodesic.WGS84.Direct(latitude, longitude, bearing, distance_m)
    decoded = cpr.decode_global(even, odd, newest_is_odd, (site["lat2"], site["lon2"]))
    if decoded is None:
        near = {cpr.longitude_zones(abs(latitude) + step) for step in (-1e-4, 1e-4)}
        assert len(near) == 2
        return
    assert off_m(decoded, (latitude, longitude)) < resolution_m(latitude) / 4.0
    assert -180.0 <= decoded[1] <= 180.0


def test_a_surface_pair_alone_leaves_90_degrees_open() -> None:
    even, odd = (cpr.encode(38.85, -77.04, odd, surface=True) for odd in (False, True))
    there = cpr.decode_global(even, odd, True, (38.0, -78.0))
    elsewhere = cpr.decode_global(even, odd, True, (38.0, 12.0))
    assert there == pytest.approx((38.85, -77.04), abs=1e-4)
    assert elsewhere == pytest.approx((38.85, 12.96), abs=1e-4)


@pytest.mark.parametrize("place", [(44.5, -44.5), (-44.5, 44.5)])
def test_without_a_receiver_a_surface_pair_is_taken_to_be_within_45_degrees_of_0_n_0_e(
    place: tuple[float, float],
) -> None:
    even, odd = (cpr.encode(*place, odd, surface=True) for odd in (False, True))
    assert cpr.decode_global(even, odd, newest_is_odd=True) == pytest.approx(place, abs=1e-4)


def test_published_surface_messages_decode_to_where_they_are_published_to_be() -> None:
    """The messages are pyModeS's: 8C4841753AAB238733C8CD4020B1, 8C4841753A8A35323FAEBDAC702D."""
    even = cpr.CprPosition(115609, 116941, odd=False, surface=True)
    odd = cpr.CprPosition(39199, 110269, odd=True, surface=True)
    near = (51.990, 4.375)
    assert cpr.decode_global(even, odd, False, near) == pytest.approx((52.32304, 4.73047), abs=2e-5)
    assert cpr.decode_local(odd, near) == pytest.approx((52.32061, 4.73473), abs=2e-5)
