"""Single steps of a decision, each against what follows from geometry, kinematics or symmetry."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from airfield import FIELD, NORTH, charted, degrees
from airhilt.assistant.decision.aerodrome import Aerodrome, Vector
from airhilt.assistant.decision.clarifications import Clarifications
from airhilt.assistant.decision.findings import NotReadBack
from airhilt.assistant.decision.guard import Doubt
from airhilt.assistant.decision.line_of_sight import GroundFix, PictureGeometry
from airhilt.assistant.decision.mobiles import Mobile
from airhilt.assistant.decision.occupancy import velocity_of
from airhilt.assistant.decision.runway import advice
from airhilt.assistant.decision.tcas_tracks import IntruderTrack
from airhilt.assistant.decision.tracks import Track
from airhilt.assistant.decision.visual_tracks import Observation
from airhilt.messages import (
    AdsbReport,
    AirportBriefing,
    CancelTakeoff,
    GoAround,
    HoldPosition,
    Severity,
    TcasReply,
)
from airhilt.phraseology import Instruction
from airhilt.units import FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS
from decisions import transcript
from instants import AERODROME
from projected import TRUCK, Body, Camera, standing


def report(**given: Any) -> AdsbReport:
    usual = {
        "icao24": "a1b2c3", "callsign": "AAL123", "t_adsb_in_ns": 0, "t_adsb_out_ns": 0,
        "latitude_deg": 38.85, "longitude_deg": -77.04, "altitude_ft": 4000.0,
        "ground_speed_kt": 140.0, "track_deg": NORTH.course_deg, "vertical_rate_fpm": 0.0,
        "nacp": 9, "nacv": 2, "receiver": "centre", "on_ground": False,
    }  # fmt: skip
    return AdsbReport.model_validate(usual | given)


# --- the field ------------------------------------------------------------------------------


@pytest.mark.parametrize("longitude_deg", [-77.04, 13.5, 179.999])
def test_the_local_frame_of_an_airport_begins_in_the_middle_of_its_thresholds(
    longitude_deg: float,
) -> None:
    """Also where the runways lie on both sides of the 180th meridian."""
    east_deg, north_deg = 0.02, 0.01
    ends = [(50.0, longitude_deg), (50.0 + north_deg, longitude_deg + east_deg)]
    first, second = ((latitude, math.remainder(longitude, 360.0)) for latitude, longitude in ends)
    runways = [
        charted(NORTH).model_copy(update={"ident": ident, "threshold": begin, "end": end})
        for ident, begin, end in (("05", first, second), ("23", second, first))
    ]
    given = {"icao": "XFLD", "elevation_ft": 0.0, "runways": tuple(runways)}
    field = Aerodrome(AirportBriefing.model_validate(given))
    middle = (50.0 + north_deg / 2.0, math.remainder(longitude_deg + east_deg / 2.0, 360.0))
    assert field.locate(*middle) == pytest.approx((0.0, 0.0), abs=0.1)


# --- calls ----------------------------------------------------------------------------------


def test_a_callsign_may_be_asked_about_again_after_a_whole_minute() -> None:
    questions = Clarifications("s")

    def asked(t_s: float) -> int:
        said = Instruction("cross", "01")
        t_ns = round(t_s * SECOND_NS)
        heard = transcript(f"at {t_s}", 119_100, t_ns, t_ns, "")
        doubt = Doubt("AAL123", "runway", 0.5, said, heard, is_answered=True)
        return len(list(questions.ask(t_ns, doubt, "DAL456")))

    assert [asked(t_s) for t_s in (10.0, 69.999, 70.0)] == [1, 0, 1]


# --- what is seen ---------------------------------------------------------------------------


def test_two_fixes_together_are_weighed_by_their_covariances() -> None:
    rng = np.random.default_rng(4)
    spreads = [spread @ spread.T for spread in rng.normal(size=(2, 2, 2)) * 5.0]
    points = rng.normal(size=(2, 2)) * 10.0
    first, second = (
        GroundFix(Vector(*point), spread[0, 0], spread[1, 1], spread[0, 1])
        for point, spread in zip(points, spreads, strict=True)
    )
    merged = first.merged(second)
    weights = [np.linalg.inv(spread) for spread in spreads]
    together = np.linalg.inv(sum(weights))
    assert merged.point == pytest.approx(
        together @ sum(weight @ point for weight, point in zip(weights, points, strict=True))
    )
    assert (merged.east_m2, merged.north_m2, merged.both_m2) == pytest.approx(
        (together[0, 0], together[1, 1], together[0, 1])
    )


def velocity_after(
    seconds: float, speed: float, error_px: float = 0.0, seed: int = 1, stops_s: float = math.inf
) -> Vector:
    """Return the measured velocity of a truck that drives 0.6 east and 0.8 north."""

    def drives(t_s: float) -> tuple[tuple[float, float, float], float]:
        way_m = speed * min(t_s, stops_s)
        return (0.6 * way_m, 80.0 + 0.8 * way_m, 0.0), 0.0

    camera = Camera(
        "c", FIELD, standing((0.0, 0.0, 30.0), 0.0, -20.0), [Body("truck", *TRUCK, drives)],
        error_px=error_px, seed=seed,
    )  # fmt: skip
    pictures = [camera.detections(k * SECOND_NS // 8) for k in range(round(8 * seconds) + 1)]
    observations = [
        Observation.of(each.t_frame_ns, PictureGeometry(each.view), each.detections[0].box, 0.9)
        for each in pictures
    ]
    seen = SimpleNamespace(
        tracks=(SimpleNamespace(last=observations[-1], observations=observations),)
    )
    return velocity_of(cast(Any, seen), AERODROME)


@pytest.mark.parametrize(("seconds", "share"), [(2.0, 1.0), (1.0, 1.0), (0.875, 0.0), (0.0, 0.0)])
def test_what_drives_has_its_velocity_once_it_was_seen_for_a_second(
    seconds: float, share: float
) -> None:
    velocity = velocity_after(seconds, 10.0)
    assert velocity == pytest.approx((6.0 * share, 8.0 * share), abs=0.5 * share)


def test_what_stands_seldom_has_a_velocity_by_the_errors_of_its_boxes() -> None:
    """Its errors are more than two standard deviations together in one of e squared cases."""
    measured = [velocity_after(2.0, 0.0, 1.0, seed) for seed in range(40)]
    assert sum(each != (0.0, 0.0) for each in measured) <= 12
    assert velocity_after(2.0, 10.0, 1.0) == pytest.approx((6.0, 8.0), abs=1.5)


def test_what_creeps_with_four_times_the_error_of_its_speed_has_a_velocity() -> None:
    measured = [velocity_after(2.0, 0.5, 1.0, seed) for seed in range(40)]
    assert sum(each != (0.0, 0.0) for each in measured) >= 35


def test_what_stopped_more_than_two_seconds_ago_stands() -> None:
    assert velocity_after(4.5, 10.0, stops_s=2.0) == pytest.approx((0.0, 0.0), abs=0.1)


# --- in the air -----------------------------------------------------------------------------


def test_a_track_has_the_last_callsign_that_was_reported() -> None:
    track = Track.of(report(callsign=None), 4000.0, 0)
    assert track.callsign == "a1b2c3"
    for t_ns, callsign in enumerate(("AAL123", None, "AAL124"), start=1):
        track.update(report(callsign=callsign, t_adsb_in_ns=t_ns), 4000.0)
        assert track.callsign == (callsign or "AAL123")


@pytest.mark.parametrize(("mode", "step_ft"), [("S", 25), ("C", 100)])
def test_the_track_of_an_intruder_comes_to_its_altitude_and_its_climb(
    mode: str, step_ft: int
) -> None:
    """It climbs steadily with 1,500 ft/min; replies have steps of 25 ft, or of 100 ft in Mode C."""

    def reply(t_s: int) -> TcasReply:
        altitude_ft = 8000.0 + 25.0 * t_s
        return TcasReply.model_validate(
            {
                "t_ns": t_s * SECOND_NS, "callsign": "AAL123", "own_icao24": "a1b2c3",
                "icao24": "a0c172" if mode == "S" else None, "mode": mode,
                "range_m": 20_000.0 - 100.0 * t_s, "bearing_deg": 0.0,
                "altitude_ft": step_ft * round(altitude_ft / step_ft), "has_tcas": False,
                "on_ground": False,
            }
        )  # fmt: skip

    track = IntruderTrack.of(reply(0))
    for t_s in range(1, 60):
        assert track.misfit(reply(t_s)) is not None  # It is taken for the same aircraft.
        track.update(reply(t_s))
    now = track.vertical(59 * SECOND_NS)
    assert now.altitude_m / FOOT == pytest.approx(8000.0 + 25.0 * 59, abs=100.0)
    assert now.rate_m_s / FOOT_PER_MINUTE == pytest.approx(1500.0, rel=0.4)


# --- at a runway ----------------------------------------------------------------------------


@pytest.mark.parametrize("speed_m_s", [5.0, 10.0, 20.0])
@pytest.mark.parametrize("share", [0.9, 1.1])
def test_who_can_stop_short_of_the_pavement_with_firm_braking_is_told_to(
    speed_m_s: float, share: float
) -> None:
    """Braking with 2.5 m/s2 takes v^2 / 5 m."""
    (strip,) = (strip for strip in AERODROME.strips if strip.name == "01/19")
    along_m, across_m = 700.0, -(22.5 + share * speed_m_s**2 / 5.0)
    latitude_deg, longitude_deg = degrees(NORTH.local(along_m, across_m))
    given = report(
        altitude_ft=None, on_ground=True, ground_speed_kt=speed_m_s / KNOT, emitter_category="C2",
        track_deg=NORTH.course_deg + 90.0,
    )  # fmt: skip
    mobile = Mobile.of(given, AERODROME.locate(latitude_deg, longitude_deg))
    threat = SimpleNamespace(strip=strip, runway="01", finding=None, kind="runway_conflict")
    nobody = SimpleNamespace(use=lambda _: None)
    told = advice(mobile, cast(Any, threat), Severity.WARNING, cast(Any, nobody), cast(Any, None))
    assert told == (HoldPosition(runway="01") if share > 1.0 else None)


URGENT = NotReadBack("DAL456", Instruction("hold_short", "01"), "AAL123")
GO_AROUND, CANCEL = GoAround(runway="01"), CancelTakeoff(runway="01")


@pytest.mark.parametrize(
    ("kind", "severity", "threat", "time_s", "told"),
    [
        ("arrival", Severity.WARNING, {}, 60.0, GO_AROUND),
        ("arrival", Severity.CAUTION, {}, 20.0, None),
        ("arrival", Severity.CAUTION, {"kind": "readback_mismatch"}, 34.9, GO_AROUND),
        ("arrival", Severity.CAUTION, {"kind": "readback_mismatch"}, 35.1, None),
        ("arrival", Severity.CAUTION, {"finding": URGENT}, 60.0, GO_AROUND),
        ("departure", Severity.WARNING, {}, 0.0, CANCEL),
        ("departure", Severity.CAUTION, {}, 0.0, None),
        ("departure", Severity.CAUTION, {"kind": "readback_mismatch"}, 0.0, None),
        ("departure", Severity.CAUTION, {"finding": URGENT}, 0.0, CANCEL),
        ("rollout", Severity.WARNING, {}, 0.0, None),
    ],
)
def test_who_uses_a_runway_is_told_to_go_around_or_to_stop_only_when_it_is_urgent(
    kind: str, severity: Severity, threat: dict[str, Any], time_s: float, told: Any
) -> None:
    use = SimpleNamespace(
        kind=kind, direction=SimpleNamespace(ident="01"), time_to_threshold_s=lambda _: time_s
    )
    mobile = SimpleNamespace(t_ns=0, on_ground=kind != "arrival")
    given = SimpleNamespace(**({"finding": None, "kind": "runway_conflict"} | threat))
    situation = SimpleNamespace(use=lambda _: use)
    config = SimpleNamespace(caution_s=35.0)
    found = advice(*(cast(Any, each) for each in (mobile, given, severity, situation, config)))
    assert found == told
    mobile.on_ground = False
    found = advice(*(cast(Any, each) for each in (mobile, given, severity, situation, config)))
    assert found == (told if kind == "arrival" else None)
