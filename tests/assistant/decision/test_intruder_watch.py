"""The watch for what only cameras show by itself: whom it looks at, and what it tells when."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import pytest

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.approach import Approach
from airhilt.assistant.decision.escalation import AGAIN_S, Escalation
from airhilt.assistant.decision.intruders import IntruderConfig, IntruderWatch, _Encounter, _Ongoing
from airhilt.assistant.decision.line_of_sight import Ray
from airhilt.assistant.decision.manoeuvres import RESPONSE_S
from airhilt.assistant.decision.visual_tracks import VisualTracks
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.relative_motion import Minima
from airhilt.messages import AdsbReport, Climb, GoAround, Severity
from airhilt.units import DEGREE, FOOT, KNOT, SECOND_NS
from projected import AIRLINER, Body, Camera, Place, still

FRAME = LocalFrame((38.9 * DEGREE, -77.0 * DEGREE))
MINIMA = Minima(1200.0, 450.0 * FOOT)
HEIGHT_M = 1000.0
CLOSING_M_S = 130.0


def ahead(contact_s: float, closing_m_s: float = CLOSING_M_S, right_m: float = 0.0) -> Body:
    """Return an airliner that a camera at the origin, which looks north, meets at a time."""

    def at(t_s: float) -> tuple[Place, float]:
        return (right_m, closing_m_s * (contact_s - t_s), HEIGHT_M), 0.0

    return replace(still("airplane", (0.0, 0.0, 0.0), AIRLINER), at=at)


def nose(*bodies: Body, height_m: float = HEIGHT_M, carrier: str | None = "AAL123") -> Camera:
    return Camera(
        f"nose of {carrier}", FRAME, lambda _: ((0.0, 0.0, height_m), (0.0, 0.0, 0.0)),
        list(bodies), carrier, width_px=1280, height_px=720, error_px=0.0, smallest_px=0.0,
    )  # fmt: skip


def report(callsign: str, north_m: float = 0.0, *, on_ground: bool = False) -> AdsbReport:
    """Return the report of one that stands, or flies, north of the camera."""
    latitude, longitude = FRAME.to_place(0.0, north_m)
    given = {
        "icao24": f"{callsign.encode().hex()[-6:]}", "callsign": callsign, "t_adsb_in_ns": 0,
        "t_adsb_out_ns": 0, "latitude_deg": latitude / DEGREE, "longitude_deg": longitude / DEGREE,
        "altitude_ft": None if on_ground else HEIGHT_M / FOOT,
        "ground_speed_kt": CLOSING_M_S / KNOT if north_m else 0.0, "track_deg": 180.0,
        "vertical_rate_fpm": 0.0, "nacp": 9, "nacv": 2, "receiver": "centre",
        "on_ground": on_ground, "emitter_category": "A3",
    }  # fmt: skip
    return AdsbReport.model_validate(given)


class Watch:
    """A watch for intruders with what some cameras and receivers give it."""

    def __init__(
        self, *cameras: Camera, reports: Sequence[AdsbReport] = (), runway: str | None = None
    ) -> None:
        self.sight = VisualTracks()
        self._cameras = cameras
        for each in reports:
            self.sight.take_report(each, 0)
        self.watch = IntruderWatch(IntruderConfig(), self.sight, lambda _: runway, lambda: MINIMA)

    def sees(self, from_s: float, to_s: float) -> Watch:
        """Take eight pictures a second of each camera."""
        for step in range(round(8 * from_s), round(8 * to_s) + 1):
            for camera in self._cameras:
                found = camera.detections(step * SECOND_NS // 8)
                self.sight.take_detections(found, step * SECOND_NS // 8)
        return self

    def told(self, *times_s: float) -> list[Alert]:
        """Return what is told at some times."""
        return [alert for t_s in times_s for alert in self.watch.judge(round(t_s * SECOND_NS))]


# --- whom it looks at -------------------------------------------------------------------------


def test_one_camera_on_a_mast_does_not_hide_what_another_shows_in_the_air() -> None:
    mast = nose(ahead(22.0), carrier=None)
    assert Watch(mast).sees(0.0, 2.0).told(2.0, 2.5) == []
    (told,) = Watch(mast, nose(ahead(22.0))).sees(0.0, 2.0).told(2.0, 2.5)
    assert told.traffic == ("AAL123", "unidentified")


def test_one_that_is_known_does_not_hide_another_that_is_not() -> None:
    known = ahead(22.0, right_m=0.0)
    reports = [report("AAL123"), report("DAL456", 22.0 * CLOSING_M_S)]
    assert Watch(nose(known), reports=reports).sees(0.0, 2.0).told(2.0, 2.5) == []
    unknown = replace(
        known, at=lambda t_s: ((-8.0 * (24.0 - t_s), 130.0 * (24.0 - t_s), 1000.0), 0.0)
    )
    (told,) = Watch(nose(known, unknown), reports=reports).sees(0.0, 2.0).told(2.0, 2.5)
    assert told.traffic == ("AAL123", "unidentified")


def test_a_carrier_that_reports_that_it_is_on_the_ground_meets_nobody() -> None:
    seen = Watch(nose(ahead(22.0)), reports=[report("AAL123", on_ground=True)]).sees(0.0, 2.0)
    assert seen.told(2.0, 2.5) == []


# --- how long it lasts ------------------------------------------------------------------------


def encounter(*, azimuth_deg: float = 0.0, carrier: str = "AAL123", **changed: Any) -> _Encounter:
    """Return one in 20 s with something of 0.01 rad, in a direction."""
    azimuth = azimuth_deg * DEGREE
    last = SimpleNamespace(t_ns=5 * SECOND_NS, ray=Ray(math.sin(azimuth), math.cos(azimuth), 0.0))
    seen = Approach(0.05, 0.0, 0.0, (0.0, 0.0), 0.0, 0.01)._replace(**changed)
    return _Encounter(
        carrier, cast(Any, SimpleNamespace(last=last, label="airplane")), seen, Severity.CAUTION
    )


@pytest.mark.parametrize(
    ("changed", "minimum_m", "past_s"),
    [
        ({}, 0.0, 25.0),
        ({}, 1200.0, 25.0 + 30.0),  # The smallest, of 8 m, is 800 m away: it draws apart 40 m/s.
        ({"size_rad": 0.02}, 1200.0, 25.0 + 60.0),
        ({"closing_error": 0.005}, 0.0, 5.0 + 25.0),
        ({"closing": 0.02}, 1200.0, 5.0 + 50.0 + 75.0),
        ({"closing": 0.01}, 0.0, 5.0 + 90.0),  # No longer time is believed.
        ({"closing": 0.01}, 1200.0, 5.0 + 180.0),
        ({"closing_error": 1.0}, 1200.0, 5.0 + 180.0),
        ({"closing_error": 1.0}, 790.0, 5.0 + 90.0 * (1.0 + 790.0 / 800.0)),
    ],
)
def test_two_are_past_each_other_at_the_latest_time_by_the_errors_within_three_minutes(
    changed: dict[str, Any], minimum_m: float, past_s: float
) -> None:
    past_ns = encounter(**changed).past_ns(Minima(minimum_m, 100.0))
    assert past_ns / SECOND_NS == pytest.approx(past_s)


@pytest.mark.parametrize(
    ("azimuth_deg", "carrier", "is_same"),
    [
        (3.9, "AAL123", True), (-3.9, "AAL123", True), (4.1, "AAL123", False),
        (-4.1, "AAL123", False), (0.0, "DAL456", False),
    ],
)  # fmt: skip
def test_a_new_track_within_4_degrees_of_one_before_is_the_same(
    azimuth_deg: float, carrier: str, is_same: bool
) -> None:
    known = _Ongoing(encounter(), Escalation("intruder-1"))
    assert known.is_of(encounter(azimuth_deg=azimuth_deg, carrier=carrier)) is is_same
    assert not known.is_of(encounter(azimuth_deg=90.0))
    assert known.is_of(known.encounter._replace(severity=None))


# --- what is told -----------------------------------------------------------------------------


def test_a_crew_is_told_what_to_do_with_the_warning_and_not_before() -> None:
    seen = Watch(nose(ahead(32.0)), reports=[report("AAL123")]).sees(0.0, 3.0)
    caution, warning = seen.told(3.0, 3.5, 8.5, 9.0)
    assert (caution.severity, caution.recommendations) == (Severity.CAUTION, {})
    assert warning.severity is Severity.WARNING
    assert isinstance(warning.recommendations["AAL123"], Climb)
    assert (caution.revision, warning.revision) == (0, 1)
    assert caution.id == warning.id == "intruder-1"


def test_a_sense_is_reversed_once_there_was_time_to_respond_for_what_comes_after_the_crew() -> None:
    def climbs(t_s: float) -> tuple[Place, float]:
        above_m = 4.0 * max(t_s - 2.5, 0.0)
        return (0.0, CLOSING_M_S * (22.0 - t_s), HEIGHT_M + above_m), 0.0

    seen = Watch(nose(replace(ahead(22.0), at=climbs)), reports=[report("AAL123")]).sees(0.0, 1.5)
    told = [
        (t_s, alert.recommendations["AAL123"].sense)
        for t_s in (step / 2 for step in range(4, 30))
        for alert in seen.sees(t_s - 0.375, t_s).told(t_s)
        if alert.recommendations
    ]
    (first_s, first), (again_s, again), *more = told
    assert (first, again, more) == ("climb", "descend", [])
    assert RESPONSE_S <= again_s - first_s < AGAIN_S


def test_who_is_on_final_is_told_to_go_around() -> None:
    (warning,) = Watch(nose(ahead(22.0)), runway="01").sees(0.0, 2.0).told(2.0, 2.5)
    assert warning.recommendations == {"AAL123": GoAround(runway="01")}


def test_the_time_to_contact_is_that_of_the_moment_at_which_it_is_told() -> None:
    for t_s in (2.5, 6.5):
        (told,) = Watch(nose(ahead(22.0))).sees(0.0, 2.0).told(2.0, t_s)
        contact_s = told.evidence.time_to_closest_approach_s
        assert contact_s == pytest.approx(22.0 - t_s, abs=0.5)
        assert told.finding.contact_s == contact_s


def test_two_that_come_nearer_are_two_alerts_of_which_the_more_urgent_is_the_first() -> None:
    near = replace(
        still("airplane", (0.0, 0.0, 0.0), AIRLINER),
        at=lambda t_s: ((-10.0 * (22.0 - t_s), 130.0 * (22.0 - t_s), 1000.0), 0.0),
    )
    told = Watch(nose(ahead(45.0), near)).sees(0.0, 4.0).told(4.0, 4.5)
    assert [(each.id, each.severity) for each in told] == [
        ("intruder-1", Severity.WARNING), ("intruder-2", Severity.CAUTION),
    ]  # fmt: skip


def test_who_was_never_told_of_is_forgotten_after_10_s_and_who_was_20_s_after_it_is_past() -> None:
    seen = Watch(nose(ahead(22.0))).sees(0.0, 2.0)
    assert seen.told(2.0) == []
    seen.sight.forget(13 * SECOND_NS)
    assert seen.told(13.0, 22.9) == []
    assert seen.watch.has_conflict
    assert seen.told(23.0) == []
    assert not seen.watch.has_conflict
    seen = Watch(nose(ahead(22.0))).sees(0.0, 2.0)
    assert [alert.active for alert in seen.told(2.0, 2.5)] == [True]
    seen.sight.forget(13 * SECOND_NS)
    past_s = seen.watch._ongoing[0].past_ns / SECOND_NS
    assert 22.0 < past_s <= 2.0 + 180.0
    assert seen.told(13.0, past_s - 0.1, past_s, past_s + 19.9) == []
    (over,) = seen.told(past_s + 20.0)
    assert (over.active, over.severity, over.recommendations) == (False, Severity.INFO, {})
    assert (over.id, over.revision) == ("intruder-1", 1)
    assert not seen.watch.has_conflict


def test_for_all_that_come_nearer_the_time_at_which_they_are_past_is_estimated_anew() -> None:
    """Even while none of them is a matter any more."""
    other = replace(
        ahead(22.0), at=lambda t_s: ((10.0 * (22.0 - t_s), 130.0 * (22.0 - t_s), 1000.0), 0.0)
    )
    seen = Watch(nose(ahead(22.0), other)).sees(0.0, 2.0)
    assert len(seen.told(2.0, 2.5)) == 2
    before = [each.past_ns for each in seen.watch._ongoing]
    seen.watch._grade = lambda *_: None
    seen.sees(2.125, 4.0).told(4.0)
    for each, past_ns in zip(seen.watch._ongoing, before, strict=True):
        assert each.past_ns != past_ns
