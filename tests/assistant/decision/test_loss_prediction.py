"""Predicted losses of separation: when, how near, and where a tower sees to it."""

from __future__ import annotations

from typing import Any

import pytest

from airfield import BRIEFING
from airhilt.assistant.decision.aerodrome import TrafficZone
from airhilt.assistant.decision.loss_prediction import (
    Prediction,
    SeparationConfig,
    SeparationStandard,
    predict,
)
from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.wgs84 import displaced
from airhilt.messages import Severity
from airhilt.units import FOOT

RULES = SeparationStandard(horizontal_m=9260.0, vertical_m=300.0, vertical_tolerance_ft=0.0)
CENTRE = (0.7, 0.1)


def track(
    icao24: str, north_m: float, east_m: float, altitude_m: float = 3000.0,
    velocity: tuple[float, float] = (0.0, 0.0), up_m_s: float = 0.0,
) -> Track:  # fmt: skip
    place = displaced(CENTRE, north_m, east_m, altitude_m)
    return Track(icao24, icao24.upper(), 0, *place, altitude_m, *velocity, up_m_s)


def predicted(first: Track, second: Track, **how: Any) -> Prediction:
    given = {"config": RULES, "zone": None, "is_on_ground": False, "is_told": False} | how
    return predict(first, second, **given)


def head_on(apart_m: float, aside_m: float = 0.0, up_m: float = 0.0) -> tuple[Track, Track]:
    """Two that near each other at 200 m/s."""
    return (
        track("a1", 0.0, 0.0, velocity=(100.0, 0.0)),
        track("b2", apart_m, aside_m, 3000.0 + up_m, velocity=(-100.0, 0.0)),
    )


@pytest.mark.parametrize(
    ("time_s", "severity"),
    [
        (None, None), (0.0, "WARNING"), (60.0, "WARNING"), (60.1, "CAUTION"), (120.0, "CAUTION"),
        (120.1, "ADVISORY"), (180.0, "ADVISORY"), (180.1, None),
    ],
)  # fmt: skip
def test_the_nearer_a_loss_the_graver_it_is(time_s: float | None, severity: str | None) -> None:
    """Two minutes are the look-ahead of short-term conflict alert (EUROCONTROL-GUID-159)."""
    assert SeparationConfig().severity_of(time_s) == (severity and Severity(severity))


@pytest.mark.parametrize(
    ("aside_m", "up_m", "loss_s"),
    [
        (0.0, 0.0, 100.0),
        (0.0, 299.0, 100.0),
        (0.0, -299.0, 100.0),
        (0.0, 301.0, None),
        (0.0, -301.0, None),
        (5556.0, 0.0, (29_260.0 - 7408.0) / 200.0),  # 3, 4 and 5: of 9,260 m are left 7,408 m.
        (9300.0, 0.0, None),
        (-9300.0, 0.0, None),
    ],
)
def test_separation_is_lost_where_both_distances_fall_below_the_minima(
    aside_m: float, up_m: float, loss_s: float | None
) -> None:
    found = predicted(*head_on(29_260.0, aside_m, up_m))
    expected = None if loss_s is None else pytest.approx(loss_s, rel=0.01)
    assert found.time_to_loss_s == expected
    assert found.time_to_closest_approach_s == pytest.approx(146.3, rel=0.01)
    assert found.horizontal_m == pytest.approx(abs(aside_m), abs=60.0)
    assert found.vertical_m == pytest.approx(abs(up_m))


def test_once_a_caution_was_told_the_two_must_pass_by_180_m_more() -> None:
    passing = head_on(20_000.0, 9350.0)
    assert predicted(*passing).time_to_loss_s is None
    assert predicted(*passing, is_told=True).time_to_loss_s is not None
    assert predicted(*head_on(20_000.0, 9500.0), is_told=True).time_to_loss_s is None


@pytest.mark.parametrize(
    ("apart_m", "aside_m", "speed_m_s", "is_over"),
    [
        (9200.0, 0.0, -100.0, False),  # They draw apart, from within the minimum.
        (9320.0, 0.0, -100.0, True),
        (9320.0, 0.0, 100.0, False),
        (20_000.0, 9400.0, 100.0, False),  # They pass with little room.
        (-20_000.0, 9400.0, 100.0, True),
        (44_200.0, 9400.0, 100.0, False),  # A turn would lead one to the other in 180 s.
        (44_400.0, 9400.0, 100.0, True),
        (9320.0, 0.0, 0.0, True),
        (9200.0, 0.0, 0.0, False),
    ],
)
def test_it_is_over_once_they_are_past_each_other_or_too_far_apart(
    apart_m: float, aside_m: float, speed_m_s: float, is_over: bool
) -> None:
    """The two are to stay 9,260 m apart, and 200 m/s are 36 km in three minutes."""
    two = (
        track("a1", 0.0, 0.0, velocity=(speed_m_s, 0.0)),
        track("b2", apart_m, aside_m, velocity=(-speed_m_s, 0.0)),
    )
    assert predicted(*two).is_over is is_over
    assert predicted(*two, is_on_ground=True).is_over


# --- where a tower sees to it ---------------------------------------------------------------

ZONE = TrafficZone(*CENTRE, ceiling_m=1000.0)


@pytest.mark.parametrize(
    ("north_m", "east_m", "above_ft", "is_in"),
    [
        (0.0, 0.0, 2499.5, True), (0.0, 0.0, 2500.5, False), (0.0, 0.0, -10.0, True),
        (9250.0, 0.0, 2000.0, True), (9270.0, 0.0, 2000.0, False),
        (0.0, -9250.0, 2000.0, True), (0.0, 9270.0, 2000.0, False),
    ],
)  # fmt: skip
def test_the_zone_of_a_tower_reaches_2_500_ft_up_and_5_nm_around(
    north_m: float, east_m: float, above_ft: float, is_in: bool
) -> None:
    """As class D does (FAA AIM, 3-2-5)."""
    assert BRIEFING.airport is not None
    zone = TrafficZone.of(BRIEFING.airport)
    assert zone is not None
    altitude_m = (BRIEFING.airport.elevation_ft + above_ft) * FOOT
    place = displaced((zone.latitude_rad, zone.longitude_rad), north_m, east_m, 0.0)
    flies = Track("a1", "A1", 0, *place, altitude_m, 0.0, 0.0, 0.0)
    assert zone.contains(flies) is is_in
    assert TrafficZone.of(BRIEFING.airport.model_copy(update={"runways": ()})) is None


def test_two_that_would_lose_separation_in_the_zone_are() -> None:
    one = track("a1", -15_000.0, 0.0, 500.0, (100.0, 0.0))
    other = track("b2", 15_000.0, 0.0, 500.0, (-100.0, 0.0))
    assert predicted(one, other).time_to_loss_s == pytest.approx(103.7, abs=0.5)
    assert predicted(one, other, zone=ZONE).is_over


def test_a_prediction_rests_on_the_words_too_if_a_level_was_read_back() -> None:
    one, other = head_on(20_000.0)
    assert predicted(one, other).evidence().shares == {"adsb": 1.0}
    one.vertical_rate_m_s = 10.0
    one.clear(4000.0, 0, "call-1")
    evidence = predicted(one, other).evidence()
    assert (evidence.sources, evidence.radio_ids) == (("adsb", "radio"), ("call-1",))
    assert evidence.shares == {}
    assert evidence.tracks == ("a1", "b2")
