"""Mobiles and targets on and near a runway: what each number says, at both sides of its limits."""

from __future__ import annotations

import math
from typing import Any

import pytest

from airfield import ELEVATION_M, NORTH, degrees
from airhilt.assistant.decision.aerodrome import (
    Vector,
    opposite,
    way_through,
)
from airhilt.assistant.decision.mobiles import (
    Mobile,
    use_of,
)
from airhilt.assistant.decision.surface_traffic import SurfaceTraffic, Target
from airhilt.assistant.decision.tracks import Track
from airhilt.messages import SurfaceTrack
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, SECOND_NS
from instants import AERODROME, report, runway, surface_track

COURSE = NORTH.course_deg * DEGREE
STRIP, DIRECTION = runway("01")


def at(along_m: float, across_m: float = 0.0) -> Vector:
    return AERODROME.locate(*degrees(NORTH.local(along_m, across_m)))


def mobile(
    along_m: float = 0.0, across_m: float = 0.0, height_m: float | None = None,
    speed_m_s: float = 60.0, **given: Any,
) -> Mobile:  # fmt: skip
    said = report("AAL123", along_m, across_m, speed_m_s, height_m=height_m, **given)
    return Mobile.of(said, AERODROME.locate(said.latitude_deg, said.longitude_deg))


def kind(*place: float | None, **given: Any) -> str | None:
    use = use_of(mobile(*place, **given), (STRIP,))  # type: ignore[arg-type]
    return None if use is None else use.kind


# --- in the air ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("along_m", "across_m", "height_m", "rate_fpm", "expected"),
    [
        (-3000.0, 0.0, 160.0, -700.0, "arrival"),
        (-9250.0, 0.0, 490.0, -700.0, "arrival"),
        (-9270.0, 0.0, 490.0, -700.0, None),  # 5 NM of final.
        (-3000.0, 355.0, 160.0, -700.0, "arrival"),  # 120 m, and 8 % of the distance.
        (-3000.0, 365.0, 160.0, -700.0, None),
        (-3000.0, -355.0, 160.0, -700.0, "arrival"),
        (-3000.0, -365.0, 160.0, -700.0, None),
        (500.0, 119.0, 20.0, -700.0, "arrival"),
        (500.0, 121.0, 20.0, -700.0, None),
        (-3000.0, 0.0, 405.0, -700.0, "arrival"),  # 150 m above a path of 5 degrees.
        (-3000.0, 0.0, 420.0, -700.0, None),
        (500.0, 0.0, 149.95, -700.0, "arrival"),
        (500.0, 0.0, 150.05, -700.0, None),
        (-3000.0, 0.0, 160.0, -101.0, "arrival"),
        (-3000.0, 0.0, 160.0, -99.0, None),  # It neither descends nor is low.
        (-300.0, 0.0, 59.0, 0.0, "arrival"),
        (-300.0, 0.0, 61.0, 0.0, None),
        (2090.0, 0.0, 20.0, -700.0, "arrival"),
        (2110.0, 0.0, 20.0, -700.0, None),  # Past the end.
        (1500.0, 0.0, 100.0, 201.0, "departure"),
        (1500.0, 0.0, 59.0, 199.0, "arrival"),
        (1500.0, 0.0, 299.0, 1500.0, "departure"),
        (1500.0, 0.0, 301.0, 1500.0, None),
        (2100.0 + 3690.0, 0.0, 250.0, 1500.0, "departure"),
        (2100.0 + 3720.0, 0.0, 250.0, 1500.0, None),  # 2 NM past it.
        (-3690.0, 0.0, 250.0, 1500.0, "departure"),
        (-3720.0, 0.0, 250.0, 1500.0, None),
    ],
)
def test_in_the_air_it_uses_a_runway_by_where_it_is_and_how_it_climbs(
    along_m: float, across_m: float, height_m: float, rate_fpm: float, expected: str | None
) -> None:
    assert kind(along_m, across_m, height_m, rate_fpm=rate_fpm) == expected


@pytest.mark.parametrize(("off_deg", "expected"), [(14.9, "arrival"), (-14.9, "arrival"),
                                                   (15.1, None), (-15.1, None)])  # fmt: skip
def test_it_flies_along_the_runway_within_15_degrees(off_deg: float, expected: str | None) -> None:
    assert kind(-3000.0, 0.0, 160.0, rate_fpm=-700.0, turned_deg=off_deg) == expected


# --- on the ground ------------------------------------------------------------------------------


def test_who_has_landed_rolls_out_until_it_is_in_the_air_again() -> None:
    lands = mobile(300.0, 0.0, 5.0)
    lands.update(report("AAL123", 400.0, 0.0, 60.0, t_s=1.0), at(400.0))
    assert lands.landed
    use = use_of(lands, (STRIP,))
    assert use is not None
    assert use.kind == "rollout"
    lands.update(report("AAL123", 900.0, 0.0, 60.0, height_m=5.0, t_s=2.0), at(900.0))
    assert not lands.landed


def test_speeds_are_means_of_about_one_second_and_of_five() -> None:
    one = mobile(speed_m_s=10.0)
    one.update(report("AAL123", 5.0, 0.0, 20.0, t_s=0.5), at(5.0))
    assert one.speed_m_s == pytest.approx(0.6 * 10.0 + 0.4 * 20.0)
    assert one.slow_speed_m_s == pytest.approx(0.9 * 10.0 + 0.1 * 20.0)
    one.update(report("AAL123", 9.0, 0.0, 20.0, t_s=2.5), at(9.0))
    assert one.speed_m_s == one.slow_speed_m_s == pytest.approx(20.0)


def test_who_was_a_vehicle_once_is_one_and_keeps_its_callsign() -> None:
    one = mobile(category="C2")
    one.update(report(None, 5.0, category=None, t_s=1.0), at(5.0))
    assert (one.is_vehicle, one.callsign) == (True, "AAL123")
    other = Mobile.of(report(None, 0.0, category=None, icao24="a1b2c3"), at(0.0))
    assert (other.is_vehicle, other.callsign) == (False, "a1b2c3")
    other.update(report("AAL123", 5.0, category="C1", t_s=1.0), at(5.0))
    assert (other.is_vehicle, other.callsign) == (True, "AAL123")


# --- the field ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("ident", "other"),
    [("01", "19"), ("18", "36"), ("27R", "09L"), ("04C", "22C")],
)
def test_the_other_direction_of_a_runway_is_18_more_with_the_other_side(
    ident: str, other: str
) -> None:
    assert opposite(ident) == other


@pytest.mark.parametrize(
    ("across_m", "heading_deg", "entry_m"),
    [(100.0, 270.0, 77.5), (-100.0, 90.0, 77.5), (100.0, 90.0, 0.0), (0.0, 270.0, 0.0),
     (100.0, 300.0, 77.5 / math.cos(30.0 * DEGREE))],
)  # fmt: skip
def test_the_room_is_the_distance_straight_on_to_the_pavement(
    across_m: float, heading_deg: float, entry_m: float
) -> None:
    heading = COURSE + heading_deg * DEGREE
    assert STRIP.room_m(at(1000.0, across_m), heading) == pytest.approx(entry_m, abs=0.1)


def test_a_way_through_an_area_ends_where_it_leaves_it() -> None:
    way = STRIP.pavement_way(at(1000.0, 100.0), COURSE - math.pi / 2.0)
    assert way == pytest.approx((77.5, 122.5), abs=0.1)
    assert way_through(STRIP.core(11), at(1000.0, 400.0), COURSE) is None


# --- targets of surface surveillance ------------------------------------------------------------


def surface(t_s: float, along_m: float, speed_m_s: float = 0.0, **given: Any) -> SurfaceTrack:
    usual = {"icao24": "a1b2c3", "callsign": "AAL123"}
    return surface_track(along_m, 0.0, speed_m_s, t_s=t_s, **usual | given)


def traffic(*tracks: SurfaceTrack) -> SurfaceTraffic:
    found = SurfaceTraffic(AERODROME)
    for each in tracks:
        found.take(each)
    return found


def only(*tracks: SurfaceTrack) -> Target:
    (target,) = traffic(*tracks)
    return target


def test_a_target_keeps_its_direction_and_its_name_where_a_track_has_none() -> None:
    target = only(
        surface(0.0, 0.0, 5.0, turned_deg=30.0),
        surface(1.0, 0.0, 1.9, turned_deg=90.0, icao24=None, callsign=None),
        surface(2.0, 0.0, 5.0, turned_deg=None),
    )
    assert target.heading_rad == pytest.approx(COURSE + 30.0 * DEGREE)
    assert (target.icao24, target.callsign) == ("a1b2c3", "AAL123")
    assert only(surface(0.0, 0.0, 1.9)).heading_rad is None


def test_an_older_track_than_the_last_one_is_ignored() -> None:
    target = only(surface(2.0, 50.0), surface(1.0, 0.0), surface(2.0, 60.0))
    assert DIRECTION.along_m(target.point) == pytest.approx(60.0, abs=0.1)


@pytest.mark.parametrize(("silent_s", "is_known"), [(5.0, True), (5.1, False)])
def test_a_target_is_forgotten_after_5_s(silent_s: float, is_known: bool) -> None:
    found = traffic(surface(0.0, 0.0))
    found.forget(round(silent_s * SECOND_NS))
    assert bool(list(found)) is is_known


def test_who_was_in_the_air_has_landed_and_who_was_on_the_ground_has_taken_off() -> None:
    lands = [surface(0.0, 0.0, height_m=30.0), surface(1.0, 60.0)]
    assert only(*lands[:1]).is_aloft
    assert not only(*lands[:1]).has_taken_off  # It appeared in the air.
    assert only(*lands).has_landed
    again = [*lands, surface(2.0, 120.0, height_m=30.0)]
    assert only(*again).has_taken_off
    assert not only(*again).has_landed
    assert not only(*again, surface(3.0, 180.0)).has_taken_off


@pytest.mark.parametrize(("above_ft", "climbs"), [(99.0, False), (101.0, True)])
def test_who_is_100_ft_above_its_lowest_point_climbs(above_ft: float, climbs: bool) -> None:
    low = [surface(0.0, 0.0, height_m=90.0), surface(1.0, 0.0, height_m=60.0)]
    assert only(*low, surface(2.0, 0.0, height_m=60.0 + above_ft * FOOT)).climbs is climbs


@pytest.mark.parametrize(
    ("speeds_m_s", "is_rolling"),
    [
        ((0.0, 3.0, 5.1), True),
        ((0.0, 3.0, 4.9), False),
        ((5.0, 6.0, 7.9), False),
        ((5.0, 6.0, 8.1), True),
        ((12.0, 12.0, 12.7), False),
        ((12.9, 12.9, 12.9), True),  # 25 kt.
        ((2.0, 5.0, 5.0, 5.0, 5.0, 5.0), False),  # What was more than 4 s ago is past.
        ((5.0, 5.0, 5.0, 5.0, 8.1), True),
    ],
)
def test_a_target_rolls_if_it_is_fast_or_has_gained_3_m_s_in_4_s(
    speeds_m_s: tuple[float, ...], is_rolling: bool
) -> None:
    tracks = [surface(float(t), 0.0, speed) for t, speed in enumerate(speeds_m_s)]
    assert only(*tracks).is_rolling is is_rolling


def test_a_target_is_carried_on_by_its_speed() -> None:
    moving = only(surface(0.0, 100.0, 10.0))
    assert DIRECTION.along_m(moving.point_at(2 * SECOND_NS)) == pytest.approx(120.0, abs=0.1)
    standing = only(surface(0.0, 100.0, 1.0))
    assert standing.point_at(2 * SECOND_NS) == standing.point


# --- tracks in flight ---------------------------------------------------------------------------


def track(altitude_ft: float, rate_fpm: float, **given: Any) -> Track:
    return Track("a", "A", 100 * SECOND_NS, 0.7, -1.3, altitude_ft * FOOT, 0.0, 0.0,
                 rate_fpm * FOOT_PER_MINUTE, **given)  # fmt: skip


@pytest.mark.parametrize(
    ("altitude_ft", "rate_fpm", "cleared_ft", "target_ft", "expected_fpm"),
    [
        (10_000.0, 1000.0, 12_000.0, 12_000.0, 1000.0),
        (10_000.0, -1000.0, 8_000.0, 8_000.0, -1000.0),
        (10_000.0, 1000.0, None, None, 1000.0),
        (10_000.0, 199.0, 12_000.0, None, 0.0),  # It counts as level.
        (10_000.0, 201.0, 12_000.0, 12_000.0, 201.0),
        (10_000.0, 1000.0, 9_801.0, None, 0.0),  # Within 200 ft it levels off.
        (10_000.0, 1000.0, 9_799.0, None, 1000.0),
        (10_000.0, -1000.0, 10_199.0, None, 0.0),
        (10_000.0, -1000.0, 10_201.0, None, -1000.0),
    ],
)
def test_it_is_expected_to_level_off_where_it_was_cleared_to(
    altitude_ft: float, rate_fpm: float, cleared_ft: float | None, target_ft: float | None,
    expected_fpm: float,
) -> None:  # fmt: skip
    cleared_m = None if cleared_ft is None else cleared_ft * FOOT
    one = track(altitude_ft, rate_fpm, cleared_m=cleared_m, cleared_id="said")
    altitude_m, rate_m_s, target_m = one.profile()
    assert altitude_m == pytest.approx(altitude_ft * FOOT)
    assert rate_m_s / FOOT_PER_MINUTE == pytest.approx(expected_fpm)
    assert target_m == (None if target_ft is None else pytest.approx(target_ft * FOOT))
    assert one.radio_id == ("" if target_ft is None else "said")


@pytest.mark.parametrize(
    ("ago_s", "to_go_ft", "rate_fpm", "is_kept"),
    [
        (29.0, 2000.0, -1000.0, True),
        (31.0, 2000.0, -1000.0, False),  # It moves away from its level.
        (31.0, 2000.0, 1000.0, True),
        (31.0, 2000.0, 0.0, True),
        (31.0, 190.0, -1000.0, True),
        (31.0, -2000.0, -1000.0, True),
        (31.0, -2000.0, 1000.0, False),
    ],
)
def test_a_level_that_nobody_flies_to_is_forgotten_after_30_s(
    ago_s: float, to_go_ft: float, rate_fpm: float, is_kept: bool
) -> None:
    one = track(10_000.0, rate_fpm)
    one.clear((10_000.0 + to_go_ft) * FOOT, round((100.0 - ago_s) * SECOND_NS), "said")
    newer = report("AAL123", 0.0, height_m=10_000.0 * FOOT - ELEVATION_M, rate_fpm=rate_fpm)
    one.update(newer, 10_000.0)
    assert (one.cleared_m is not None) is is_kept
