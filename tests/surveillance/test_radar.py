"""Radar: geometry of lines of sight, probability of detection, codes and altitudes of replies."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any, cast

import pytest
from geographiclib.geodesic import Geodesic
from hypothesis import given
from hypothesis import strategies as st

from airhilt.geodesy.wgs84 import distance_m
from airhilt.messages import RadarInfo, RadarPlot
from airhilt.surveillance.radar import (
    RADARS,
    Antenna,
    discrete_code,
    mode_c_ft,
    plot_place,
)
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE
from airhilt.world.site import FixedSite

ANTENNA = Antenna(38.85 * DEGREE, -77.04 * DEGREE, 30.0)


def at(bearing_deg: float, distance_m: float, altitude_m: float) -> FixedSite:
    line = Geodesic.WGS84.Direct(38.85, -77.04, bearing_deg, distance_m)
    return FixedSite(line["lat2"] * DEGREE, line["lon2"] * DEGREE, altitude_m)


@given(st.floats(0.0, 359.9), st.floats(1_000.0, 400_000.0), st.floats(0.0, 15_000.0))
def test_azimuth_is_that_of_the_geodesic(bearing: float, distance: float, altitude: float) -> None:
    seen = ANTENNA.to(at(bearing, distance, altitude))
    away = abs(seen.azimuth_rad / DEGREE - bearing) % 360.0
    assert min(away, 360.0 - away) < 0.01


def test_the_round_earth_takes_a_far_target_below_the_horizontal_plane() -> None:
    assert ANTENNA.to(at(90.0, 100_000.0, 30.0)).elevation_rad < 0.0
    assert ANTENNA.to(at(90.0, 1.0, 10_000.0)).elevation_rad == pytest.approx(math.pi / 2, abs=1e-3)


def test_the_design_point_is_met() -> None:
    terminal, en_route = RADARS["terminal"], RADARS["en_route"]
    assert terminal.detection_probability(1.0, 40.0 * NAUTICAL_MILE) == pytest.approx(0.90)
    assert en_route.detection_probability(2.0, 200.0 * NAUTICAL_MILE) == pytest.approx(0.90)


@given(st.sampled_from(sorted(RADARS)), st.floats(0.001, 1000.0), st.floats(1.0, 300.0))
def test_larger_and_nearer_targets_are_detected_more_surely(
    kind: str, cross_section: float, range_nm: float
) -> None:
    radar = RADARS[kind]  # type: ignore[index]
    range_m = range_nm * NAUTICAL_MILE
    probability = radar.detection_probability(cross_section, range_m)
    assert 0.0 <= probability <= 1.0
    assert radar.detection_probability(2.0 * cross_section, range_m) >= probability
    assert radar.detection_probability(cross_section, 0.5 * range_m) >= probability
    # Sixteen times the size at twice the range: the radar equation.
    assert radar.detection_probability(16.0 * cross_section, 2.0 * range_m) == pytest.approx(
        probability, rel=1e-9, abs=1e-12
    )


def test_mode_c_is_in_steps_of_100_ft() -> None:
    assert mode_c_ft(10_668.0) == 35_000
    assert mode_c_ft(10_049.0 * FOOT) == 10_000
    assert mode_c_ft(10_051.0 * FOOT) == 10_100
    assert mode_c_ft(-120.0 * FOOT) == -100


@given(st.integers(0, 0xFFFFFF))
def test_a_code_made_from_an_address_is_discrete_and_has_no_meaning_of_its_own(
    number: int,
) -> None:
    code = discrete_code(f"{number:06x}")
    assert len(code) == 4
    assert set(code) <= set("01234567")
    assert not code.endswith("00")
    assert code not in {"1200", "7500", "7600", "7700", "2000", "7000"}


@pytest.mark.parametrize(
    ("kind", "pulses_per_s", "wavelength_m", "turns_per_min"),
    [("terminal", 1200.0, 0.107, 12.5), ("en_route", 340.0, 0.23, 5.0)],
)
def test_a_radar_sees_what_moves_by_more_than_a_doppler_filter_of_eight(
    kind: str, pulses_per_s: float, wavelength_m: float, turns_per_min: float
) -> None:
    """The filters share the speeds that a pulse rate tells apart, half a wavelength a pulse."""
    radar = RADARS[kind]  # type: ignore[index]
    expected_m_s = wavelength_m / 2.0 * pulses_per_s / 8.0
    assert radar.clutter_speed_m_s == pytest.approx(expected_m_s, rel=0.03)
    assert radar.rotation_s == pytest.approx(60.0 / turns_per_min)


def test_one_false_alarm_comes_in_a_million_cells() -> None:
    """Without an echo, what is detected is a false alarm."""
    assert RADARS["terminal"].detection_probability(0.0, 1_000.0) == pytest.approx(1e-6)


# --- the place of a plot --------------------------------------------------------------------


def place_of(range_m: float, azimuth_deg: float, mode_c_ft: float | None, antenna_m: float) -> Any:
    site = SimpleNamespace(latitude_deg=38.85, longitude_deg=-77.04, altitude_m=antenna_m)
    plot = SimpleNamespace(range_m=range_m, azimuth_deg=azimuth_deg, mode_c_ft=mode_c_ft)
    return plot_place(cast(RadarInfo, site), cast(RadarPlot, plot))


@given(st.floats(0.0, 359.9), st.floats(500.0, 200_000.0), st.floats(0.0, 40_000.0))
def test_a_plot_is_where_its_target_is(
    bearing_deg: float, distance: float, altitude_ft: float
) -> None:
    """But for the Earth's flattening: 0.4 % at most."""
    target = at(bearing_deg, distance, altitude_ft * FOOT)
    seen = ANTENNA.to(target)
    place, height_m = place_of(seen.range_m, seen.azimuth_rad / DEGREE, altitude_ft, 30.0)
    assert height_m == pytest.approx(altitude_ft * FOOT)
    there = (target.latitude_rad, target.longitude_rad)
    assert distance_m(place, there) < 0.004 * distance + 20.0


def test_the_way_along_the_ground_is_the_third_side_of_a_triangle(
    subtests: pytest.Subtests,
) -> None:
    """The antenna is at sea level, and the target 3 km above it."""
    table = [(5_000.0, 4_000.0), (3_000.0, 0.0),
                                                   (2_900.0, 0.0), (3_000.4, 49.0)]  # fmt: skip
    for slant_m, ground_m in table:
        with subtests.test(str((slant_m, ground_m))):
            place, _ = place_of(slant_m, 90.0, 3_000.0 / FOOT, 0.0)
            there = distance_m((38.85 * DEGREE, -77.04 * DEGREE), place)
            assert there == pytest.approx(ground_m, rel=0.004, abs=1.0)


def test_without_an_altitude_a_plot_is_taken_to_be_as_high_as_the_antenna() -> None:
    place, height_m = place_of(10_000.0, 45.0, None, 250.0)
    assert height_m == 250.0
    there = distance_m((38.85 * DEGREE, -77.04 * DEGREE), place)
    assert there == pytest.approx(10_000.0, rel=0.004)
    assert place[0] > 38.85 * DEGREE
    assert place[1] > -77.04 * DEGREE
