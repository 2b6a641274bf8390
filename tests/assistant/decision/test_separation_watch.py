"""The watch over separation by itself: when it tells whom what, and when it is over."""

from __future__ import annotations

from typing import Any

import pytest

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.guard import ConfidenceGuard
from airhilt.assistant.decision.loss_prediction import SeparationConfig
from airhilt.assistant.decision.separation import SeparationWatch
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.messages import AdsbReport, Briefing, Climb, Severity
from airhilt.units import DEGREE, KNOT, NAUTICAL_MILE, SECOND_NS

FRAME = LocalFrame((38.9 * DEGREE, -77.0 * DEGREE))
MINIMUM_M = 5.0 * NAUTICAL_MILE
SPEED_M_S = 200.0


def report(
    icao24: str, north_m: float, north_m_s: float, *, t_s: float = 0.0, east_m: float = 0.0,
    altitude_ft: float | None = 35_000.0, rate_fpm: float = 0.0,
) -> AdsbReport:  # fmt: skip
    latitude, longitude = FRAME.to_place(east_m, north_m)
    return AdsbReport.model_validate(
        {
            "icao24": icao24, "callsign": icao24.upper(), "latitude_deg": latitude / DEGREE,
            "longitude_deg": longitude / DEGREE, "altitude_ft": altitude_ft,
            "ground_speed_kt": abs(north_m_s) / KNOT, "track_deg": 0.0 if north_m_s > 0 else 180.0,
            "vertical_rate_fpm": rate_fpm, "nacp": 9, "nacv": 2, "receiver": "all",
            "t_adsb_in_ns": round(t_s * SECOND_NS), "t_adsb_out_ns": 0,
            "on_ground": altitude_ft is None,
        }
    )  # fmt: skip


class Sky:
    """Two aircraft that meet head-on at 400 m/s together, and lose separation at a time."""

    def __init__(self, lost_s: float = 170.0, config: SeparationConfig | None = None) -> None:
        self.watch = SeparationWatch(config or SeparationConfig(), ConfidenceGuard())
        self._apart_m = MINIMUM_M + 2.0 * SPEED_M_S * lost_s
        self.told: list[tuple[float, Alert]] = []

    def flies(
        self, from_s: int, to_s: int, *, reports: bool = True, second_ft: float = 35_000.0,
        first_ft: float | None = 35_000.0, speed_m_s: float = SPEED_M_S,
    ) -> Sky:  # fmt: skip
        """Go on for some seconds, with a report a second, or without any."""
        for t_s in range(from_s, to_s):
            if reports:
                for each in (
                    report("a00001", speed_m_s * t_s, SPEED_M_S, t_s=t_s, altitude_ft=first_ft),
                    report(
                        "a00002", self._apart_m - speed_m_s * t_s, -SPEED_M_S, t_s=t_s,
                        altitude_ft=second_ft,
                    ),
                ):  # fmt: skip
                    self.watch.take_report(each, t_s * SECOND_NS)
            self.told += [(t_s, alert) for alert in self.watch.judge(t_s * SECOND_NS)]
        return self

    def severities(self) -> list[tuple[float, str]]:
        return [(t_s, alert.severity.value) for t_s, alert in self.told]


def test_it_is_told_once_a_severity_has_held_for_a_second() -> None:
    sky = Sky(169.7).flies(0, 120)
    rises = {severity: t_s for t_s, severity in reversed(sky.severities())}
    assert rises == {"ADVISORY": 1, "CAUTION": 51, "WARNING": 111}
    assert {alert.id for _, alert in sky.told} == {"separation-1"}
    assert [alert.revision for _, alert in sky.told] == list(range(len(sky.told)))
    assert {alert.traffic for _, alert in sky.told} == {("A00001", "A00002")}
    for t_s, alert in sky.told:
        assert alert.evidence.time_to_loss_s == pytest.approx(169.7 - t_s, abs=0.5)
        assert alert.finding.time_to_loss_s == alert.evidence.time_to_loss_s


def test_crews_are_told_from_a_caution_on_and_what_to_do() -> None:
    (advisory, caution, *_, warning) = (alert for _, alert in Sky(170.0).flies(0, 120).told)
    assert advisory.recipients == ("ATC",)
    assert advisory.recommendations == {}
    assert caution.recipients == warning.recipients == ("A00001", "A00002", "ATC")
    for alert, rate_fpm in ((caution, 1500.0), (warning, 2500.0)):
        assert alert.recommendations.keys() == {"A00001", "A00002"}
        for told in alert.recommendations.values():
            assert isinstance(told, Climb)
            assert told.vertical_rate_fpm == rate_fpm


def test_without_reports_it_goes_on_from_where_they_were() -> None:
    sky = Sky(65.0).flies(0, 3).flies(3, 12, reports=False)
    assert sky.severities() == [(1, "CAUTION"), (6, "WARNING")]


def test_it_is_over_8_s_after_the_two_are_past_each_other() -> None:
    """They are 5 NM past each other after 46.3 s more."""
    sky = Sky(50.0).flies(0, 120)
    past_s = 50.0 + 2.0 * MINIMUM_M / 400.0
    (t_s, over) = sky.told[-1]
    assert t_s == pytest.approx(past_s + 8.0, abs=1.0)
    assert (over.active, over.severity, over.recommendations) == (False, Severity.INFO, {})
    assert over.recipients == ("A00001", "A00002", "ATC")
    assert (over.id, over.revision) == ("separation-1", len(sky.told) - 1)
    assert not sky.watch.has_conflict


def test_a_caution_stays_while_the_two_could_meet_again_and_is_told_again() -> None:
    sky = Sky(100.0).flies(0, 3).flies(3, 30, second_ft=37_000.0)
    assert sky.severities() == [(1, "CAUTION")]
    assert sky.watch.has_conflict
    sky.flies(30, 35)
    assert {severity for _, severity in sky.severities()} == {"CAUTION"}
    assert sky.told[-1][0] > 30
    assert sky.told[-1][1].id == "separation-1"
    again = Sky(100.0).flies(0, 3).flies(3, 9, second_ft=37_000.0).flies(9, 14)
    assert again.severities() == [(1, "CAUTION")]  # It was clear for less than 8 s.


@pytest.mark.parametrize(("silent_s", "is_known"), [(15, True), (16, False)])
def test_a_track_is_dropped_after_15_s_of_silence_unless_it_is_in_a_conflict(
    silent_s: int, is_known: bool
) -> None:
    sky = Sky(220.0).flies(0, 1).flies(silent_s, silent_s + 1, reports=False)
    assert len(list(sky.watch._tracks)) == (2 if is_known else 0)
    sky = Sky(100.0).flies(0, 3).flies(3, 40, reports=False)
    assert len(list(sky.watch._tracks)) == 2


def test_what_is_seen_while_nothing_is_told_counts_for_how_long_it_has_lasted() -> None:
    sky = Sky(100.0)
    for t_s in range(3):
        for each in (
            report("a00001", SPEED_M_S * t_s, SPEED_M_S, t_s=t_s),
            report("a00002", sky._apart_m - SPEED_M_S * t_s, -SPEED_M_S, t_s=t_s),
        ):
            sky.watch.take_report(each, t_s * SECOND_NS)
        sky.watch.observe(t_s * SECOND_NS)
    assert [alert.severity for alert in sky.watch.judge(2 * SECOND_NS)] == [Severity.CAUTION]


@pytest.mark.parametrize(
    ("given", "severity"),
    [
        ({"horizontal_separation_nm": 5.0, "vertical_separation_ft": 1000.0}, "CAUTION"),
        # 2 NM less are passed 9.3 s later.
        ({"horizontal_separation_nm": 3.0, "vertical_separation_ft": 1000.0}, "ADVISORY"),
        ({"horizontal_separation_nm": 5.0, "vertical_separation_ft": 500.0}, None),
    ],
)
def test_the_minima_are_those_of_the_briefing(given: dict[str, Any], severity: str | None) -> None:
    sky = Sky(115.0)
    sky.watch.take_briefing(Briefing(controller="Center", roster=(), airport=None, **given))
    sky.flies(0, 3, second_ft=35_500.0)
    assert [each for _, each in sky.severities()] == ([severity] if severity else [])
