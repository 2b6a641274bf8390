"""One aircraft by its reports: how it moves, and to which level it is expected to fly."""

from __future__ import annotations

import math
from typing import Any

import pytest

from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.wgs84 import offset_m
from airhilt.messages import AdsbReport
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS


def report(t_s: float = 0.0, **given: Any) -> AdsbReport:
    t_ns = round(t_s * SECOND_NS)
    usual = {
        "t_ns": t_ns, "icao24": "a1b2c3", "callsign": "AAL123", "latitude_deg": 38.9,
        "longitude_deg": -77.0, "altitude_ft": 31_000.0, "ground_speed_kt": 480.0,
        "track_deg": 30.0, "vertical_rate_fpm": 0.0, "nacp": 9, "nacv": 2, "receiver": "all",
        "t_adsb_in_ns": t_ns, "t_adsb_out_ns": t_ns,
    }  # fmt: skip
    return AdsbReport.model_validate(usual | given)


def track(**given: Any) -> Track:
    first = report(**given)
    return Track.of(first, given.get("altitude_ft", 31_000.0), first.t_adsb_in_ns)


def test_a_velocity_is_the_mean_of_the_reports_of_about_a_second() -> None:
    """What does not change stays; of what changes suddenly, 0.4 counts in the first report."""
    found = track(vertical_rate_fpm=600.0)
    before = (found.velocity_north_m_s, found.velocity_east_m_s, found.vertical_rate_m_s)
    found.update(report(1.0, vertical_rate_fpm=600.0), 31_010.0)
    after = (found.velocity_north_m_s, found.velocity_east_m_s, found.vertical_rate_m_s)
    assert after == pytest.approx(before)
    found.update(report(1.5, track_deg=210.0, vertical_rate_fpm=-600.0), 31_010.0)
    turned = (found.velocity_north_m_s, found.velocity_east_m_s, found.vertical_rate_m_s)
    assert turned == pytest.approx([0.2 * each for each in before])
    for step in range(20):
        found.update(report(2.0 + step / 2.0, track_deg=210.0, vertical_rate_fpm=-600.0), 31_010.0)
    turned = (found.velocity_north_m_s, found.velocity_east_m_s, found.vertical_rate_m_s)
    assert turned == pytest.approx([-each for each in before], rel=1e-3)


def test_the_newest_position_counts_and_an_older_report_nothing() -> None:
    found = track()
    found.update(report(2.0, latitude_deg=39.0, longitude_deg=-76.0, callsign=None), 32_000.0)
    assert (found.t_ns, found.callsign) == (2 * SECOND_NS, "AAL123")
    found.update(report(1.9, latitude_deg=40.0, callsign="DAL456", ground_speed_kt=0.0), 30_000.0)
    assert (found.latitude_rad, found.longitude_rad) == (39.0 * DEGREE, -76.0 * DEGREE)
    assert (found.altitude_m, found.callsign) == (pytest.approx(32_000.0 * FOOT), "AAL123")
    assert math.hypot(found.velocity_north_m_s, found.velocity_east_m_s) == pytest.approx(
        480.0 * KNOT
    )
    found.update(report(2.0, callsign="DAL456"), 30_000.0)
    assert found.callsign == "DAL456"


def test_it_is_carried_on_with_its_velocity_and_its_climb_and_keeps_what_is_known() -> None:
    found = track(vertical_rate_fpm=1200.0)
    found.clear(33_000.0 * FOOT, 5, "readback")
    found.in_distress = True
    later = found.at(30 * SECOND_NS)
    north_m, east_m = offset_m(
        (found.latitude_rad, found.longitude_rad), (later.latitude_rad, later.longitude_rad)
    )
    flown_m = 4.0 * 1852.0
    assert math.hypot(north_m, east_m) == pytest.approx(flown_m, rel=2e-3)
    assert math.atan2(east_m, north_m) / DEGREE == pytest.approx(30.0, abs=0.1)
    assert later.altitude_m == pytest.approx(31_600.0 * FOOT)
    assert later.t_ns == 30 * SECOND_NS
    kept = ("icao24", "callsign", "cleared_m", "cleared_ns", "cleared_id", "in_distress",
            "descent_ns", "descent_id", "velocity_north_m_s", "velocity_east_m_s",
            "vertical_rate_m_s")  # fmt: skip
    assert [getattr(later, name) for name in kept] == [getattr(found, name) for name in kept]


@pytest.mark.parametrize(("rate_fpm", "is_steep"), [(0.0, False), (-7000.0, True)])
def test_an_emergency_descent_is_one_of_5_000_ft_min_to_10_000_ft_until_it_is_seen(
    rate_fpm: float, is_steep: bool
) -> None:
    found = track(vertical_rate_fpm=rate_fpm)
    found.clear(33_000.0 * FOOT, 0, "readback")
    found.announce_descent(0, "mayday")
    assert found.radio_id == "mayday"
    expected_fpm = -7000.0 if is_steep else -5000.0
    assert found.profile().rate_m_s == pytest.approx(expected_fpm * FOOT_PER_MINUTE)
    assert found.at(600 * SECOND_NS).altitude_m == pytest.approx(10_000.0 * FOOT)
    for t_s, is_expected in ((29.9, True), (30.0, False)):
        found.t_ns = round(t_s * SECOND_NS)
        assert (found.radio_id == "mayday") is is_expected
