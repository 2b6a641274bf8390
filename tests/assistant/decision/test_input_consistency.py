"""Reports that contradict each other, and what alerts say of it, at both sides of each limit."""

from __future__ import annotations

from typing import Any

import pytest

from airfield import FIELD
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.input_checks import InputChecks, is_possible
from airhilt.geodesy.wgs84 import displaced
from airhilt.messages import AdsbReport, CameraInfo, Detections, Evidence, Severity, Transcript
from airhilt.units import DEGREE, KNOT, SECOND_NS
from projected import Camera, standing


def at(t_s: float) -> int:
    return round(t_s * SECOND_NS)


def report(
    north_m: float = 0.0, *, t_s: float = 0.0, altitude_ft: float | None = 3000.0,
    icao24: str = "a1b2c3", callsign: str | None = "AAL123", **given: Any,
) -> AdsbReport:  # fmt: skip
    latitude, longitude = displaced((50.0 * DEGREE, 8.0 * DEGREE), north_m, 0.0)
    usual = {
        "icao24": icao24, "callsign": callsign, "t_adsb_in_ns": at(t_s), "t_adsb_out_ns": at(t_s),
        "latitude_deg": latitude / DEGREE, "longitude_deg": longitude / DEGREE,
        "altitude_ft": altitude_ft, "on_ground": altitude_ft is None, "ground_speed_kt": 100.0,
        "track_deg": 0.0, "vertical_rate_fpm": 0.0, "nacp": 9, "nacv": 2, "receiver": "field",
    }  # fmt: skip
    return AdsbReport.model_validate(usual | given)


ROOM_M = 100.0 + 30.0 + 30.0
"""What two positions of NACp 9 may differ by without a flight, in m."""


@pytest.mark.parametrize("apart_s", [0.0, 1.0, 5.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("share", "possible"), [(0.995, True), (1.005, False)])
def test_nobody_flies_faster_than_1022_kt_or_taxies_faster_than_200_kt(
    apart_s: float, sign: float, share: float, possible: bool
) -> None:
    """The range of the subsonic velocity squitter (DO-260B)."""
    for altitude_ft, fastest_kt in ((3000.0, 1022.0), (None, 200.0)):
        far_m = share * sign * (ROOM_M + fastest_kt * KNOT * apart_s)
        one = report(altitude_ft=altitude_ft, t_s=10.0)
        other = report(far_m, altitude_ft=altitude_ft, t_s=10.0 + apart_s)
        assert is_possible(one, other) is is_possible(other, one) is possible
    landing = report(share * sign * (ROOM_M + 1022.0 * KNOT * apart_s), altitude_ft=None,
                     t_s=10.0 + apart_s)  # fmt: skip
    assert is_possible(report(t_s=10.0), landing) is possible


@pytest.mark.parametrize(("nacp", "error_m"), [(11, 3.0), (8, 93.0), (5, 926.0)])
def test_the_errors_of_both_positions_count(nacp: int, error_m: float) -> None:
    for share, possible in ((0.99, True), (1.01, False)):
        far_m = share * (130.0 + error_m)
        assert is_possible(report(nacp=nacp), report(far_m)) is possible
        assert is_possible(report(), report(far_m, nacp=nacp)) is possible


@pytest.mark.parametrize("apart_s", [0.0, 1.0, 4.0])
def test_nobody_climbs_or_descends_faster_than_32_576_ft_min(apart_s: float) -> None:
    for sign in (1.0, -1.0):
        for share, possible in ((0.99, True), (1.01, False)):
            change_ft = share * sign * (100.0 + 32_576.0 / 60.0 * apart_s)
            one = report(altitude_ft=20_000.0, t_s=10.0)
            other = report(altitude_ft=20_000.0 + change_ft, t_s=10.0 + apart_s)
            assert is_possible(one, other) is is_possible(other, one) is possible
    assert is_possible(report(altitude_ft=None), report(altitude_ft=40_000.0))


ELSEWHERE: dict[str, Any] = {"north_m": 50_000.0, "callsign": "DAL456"}


def test_the_place_that_was_known_first_is_kept_while_reports_of_it_arrive() -> None:
    checks = InputChecks()
    assert checks.believes_report(report(), at(0.0))
    for t_s in (0.5, 6.0, 12.0):
        assert not checks.believes_report(report(t_s=t_s, **ELSEWHERE), at(t_s))
    for name in ("a1b2c3", "AAL123", "DAL456"):
        assert said(checks, 13.0, traffic=(name,)) == ("ADS-B of DAL456 inconsistent",)
    assert checks.believes_report(report(t_s=12.1, **ELSEWHERE), at(12.1))
    assert not checks.believes_report(report(t_s=12.2), at(12.2))


def test_an_older_report_that_is_possible_is_believed_and_not_compared_with() -> None:
    checks = InputChecks()
    checks.believes_report(report(1000.0, t_s=10.0), at(10.0))
    assert checks.believes_report(report(-200.0, t_s=8.0), at(10.5))
    assert checks.believes_report(report(1400.0, t_s=10.5), at(11.0))
    assert not checks.believes_report(report(8000.0, t_s=11.0, callsign=None), at(11.5))


@pytest.mark.parametrize(("t_s", "is_shared"), [(12.0, True), (12.1, False)])
def test_a_callsign_is_shared_by_two_addresses_within_12_s(t_s: float, is_shared: bool) -> None:
    checks = InputChecks()
    assert checks.believes_report(report(), at(0.0))
    assert checks.believes_report(report(90_000.0, icao24="abcdef", t_s=t_s), at(t_s))
    told = ("callsign AAL123 sent by two addresses",) if is_shared else ()
    assert said(checks, t_s, traffic=("AAL123",)) == told


# --- what alerts say --------------------------------------------------------------------------


def alert(**changed: Any) -> Alert:
    usual: dict[str, Any] = {
        "id": "a-1", "revision": 0, "kind": "runway_conflict", "severity": Severity.CAUTION,
        "recipients": ("ATC",), "traffic": ("DAL456",), "evidence": Evidence(sources=("adsb",)),
    }  # fmt: skip
    return Alert(**usual | changed)


def said(checks: InputChecks, t_s: float, **changed: Any) -> tuple[str, ...]:
    return checks.marked(alert(**changed), at(t_s)).evidence.inconsistencies


@pytest.mark.parametrize(
    ("changed", "t_s", "is_told"),
    [
        ({"traffic": ("AAL123", "DAL456")}, 61.0, True),
        ({"recipients": ("AAL123",)}, 61.0, True),
        ({"traffic": ("a1b2c3",)}, 61.0, True),
        ({"traffic": ("AAL123",)}, 61.1, False),
        ({}, 1.0, False),
    ],
)
def test_an_alert_about_whose_reports_disagree_says_so_for_a_minute(
    changed: dict[str, Any], t_s: float, is_told: bool
) -> None:
    checks = InputChecks()
    assert checks.believes_report(report(), at(0.0))
    assert not checks.believes_report(report(50_000.0, t_s=1.0), at(1.0))
    assert said(checks, t_s, **changed) == (("ADS-B of AAL123 inconsistent",) if is_told else ())


def call(t_s: float, name: str, text: str = "wind calm") -> Transcript:
    return Transcript(
        id=name, frequency_khz=119_100, t_tx_ns=at(t_s), t_end_ns=at(t_s), text=text,
        confidence=1.0, engine="text",
    )  # fmt: skip


def test_a_call_that_comes_twice_or_late_is_told_of_by_what_rests_on_the_radio() -> None:
    checks = InputChecks()
    heard = {"evidence": Evidence(sources=("adsb", "radio"))}
    first = call(20.0, "b")
    assert checks.in_order(first, at(20.0)) == (first,)
    assert checks.in_order(first, at(21.0)) == ()
    assert said(checks, 22.0, **heard) == ()
    assert checks.in_order(first.model_copy(update={"frequency_khz": 121_500}), at(21.0)) != ()
    assert checks.in_order(call(20.0, "b", "wind two knots"), at(21.0)) == ()
    assert said(checks, 22.0, **heard) == ("two transcripts of call b differ",)
    checks.in_order(call(10.0, "a"), at(23.0))
    assert said(checks, 23.0, **heard) == (
        "two transcripts of call b differ", "call a came out of order",
    )  # fmt: skip
    assert said(checks, 82.0, **heard) == ("call a came out of order",)
    assert said(checks, 23.0) == ()


def test_later_calls_are_acted_upon_again_after_one_that_came_late() -> None:
    checks = InputChecks()
    for begins_s, ids in (
        (10.0, ["10"]), (70.0, ["70"]), (40.0, ["40", "70"]), (10.5, ["10.5", "40", "70"]),
        (9.9, []),  # It is over a minute late.
    ):  # fmt: skip
        taken = checks.in_order(call(begins_s, f"{begins_s:g}"), at(80.0))
        assert [each.id for each in taken] == ids


def seen(camera: str, t_s: float) -> Detections:
    return Camera(camera, FIELD, standing((0.0, 0.0, 30.0), 0.0, 0.0), []).detections(at(t_s))


def test_pictures_are_of_a_known_camera_and_newer_than_the_last_one() -> None:
    checks = InputChecks()
    by_sight = {"evidence": Evidence(sources=("vision", "adsb"))}
    assert checks.believes_detections(seen("ghost", 0.0), at(0.0))  # None is known yet.
    checks.take_camera(
        CameraInfo(camera="c", rate_hz=8.0, width_px=640, height_px=360, horizontal_fov_deg=45.0)
    )
    assert checks.believes_detections(seen("c", 2.0), at(2.0))
    assert said(checks, 3.0, **by_sight) == ()
    assert not checks.believes_detections(seen("ghost", 3.0), at(3.0))
    for t_s in (1.9, 2.0):
        assert not checks.believes_detections(seen("c", t_s), at(4.0))
    assert said(checks, 4.0, **by_sight) == (
        "detections of unknown camera ghost not used", "a picture of camera c came out of order",
    )  # fmt: skip
    assert said(checks, 4.0) == ()
    assert checks.believes_detections(seen("c", 2.1), at(4.1))
