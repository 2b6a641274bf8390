"""Collisions on a runway that SURF-A foresees at one instant, at both sides of each limit."""

from __future__ import annotations

import math
from typing import Any

import pytest

from airfield import NORTH, Airfield, Mover, lands, stands
from airhilt.assistant.decision.engines.surf_a import SurfaceAlertConfig, predicted_collisions
from airhilt.assistant.decision.raised_alerts import Hazard
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.engine_families import ASSISTANTS
from airhilt.errors import AirhiltError
from airhilt.messages import AdsbReport, CancelTakeoff, GoAround, Severity
from instants import Field, arrival, at, landed, report

CORE_M = 76.0 - 1.25 * 30.0
"""Where the area begins in which one with NACp 9 is certain to be, from the centre line, in m."""
TOUCHDOWN_S = 400.0 / 70.0
"""Time of `arrival` from the threshold to its touchdown, in s."""


def collisions(
    *reports: AdsbReport, t_s: float = 0.0, responds_from: Severity = Severity.WARNING,
    config: SurfaceAlertConfig | None = None,
) -> list[Hazard]:  # fmt: skip
    situation = Field(*reports).situation
    return list(
        predicted_collisions(situation, config or SurfaceAlertConfig(), responds_from, at(t_s))
    )


def severities(*reports: AdsbReport, **how: Any) -> list[str]:
    return [each.severity.value for each in collisions(*reports, **how)]


def truck(
    along_m: float, across_m: float = 0.0, speed_m_s: float = 0.0, turned_deg: float = -90.0
) -> AdsbReport:
    return report("OPS1", along_m, across_m, speed_m_s, turned_deg=turned_deg, category="C2")


def departure(along_m: float = 300.0, speed_m_s: float = 40.0) -> AdsbReport:
    return report("AAL123", along_m, 0.0, speed_m_s)


def rolls_s(distance_m: float, speed_m_s: float = 40.0) -> float:
    """Return the time that a departure takes for a distance at 1.8 m/s2."""
    return (math.sqrt(speed_m_s**2 + 3.6 * distance_m) - speed_m_s) / 1.8


# --- how long before --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("left_s", "severity"),
    [(30.1, None), (29.9, "CAUTION"), (15.1, "CAUTION"), (14.9, "WARNING")],
)
@pytest.mark.parametrize("along_m", [0.0, 210.0, 1000.0, 2000.0])
def test_an_arrival_is_alerted_30_and_15_s_before_it_is_there_or_touches_down(
    along_m: float, left_s: float, severity: str | None
) -> None:
    to_go_s = left_s - min(along_m / 70.0, TOUCHDOWN_S)
    found = severities(arrival("AAL123", to_go_s), truck(along_m))
    assert found == ([severity] if severity else [])
    later = severities(arrival("AAL123", to_go_s + 4.0), truck(along_m), t_s=4.0)
    assert later == found


@pytest.mark.parametrize(
    ("left_s", "severity"),
    [(30.1, None), (29.9, "CAUTION"), (15.1, "CAUTION"), (14.9, "WARNING")],
)
def test_a_departure_is_alerted_30_and_15_s_before_it_is_there(
    left_s: float, severity: str | None
) -> None:
    """From 13 m/s, with 1.8 m/s2."""
    found = severities(departure(300.0, 13.0), truck(300.0 + 13.0 * left_s + 0.9 * left_s**2))
    assert found == ([severity] if severity else [])


def test_a_landing_is_alerted_as_far_as_it_rolls() -> None:
    """From 40 m/s it stops after 444 m."""
    assert severities(*landed("AAL123", 600.0, 40.0), truck(900.0)) == ["WARNING"]
    assert severities(*landed("AAL123", 600.0, 40.0), truck(1040.0)) == ["CAUTION"]
    assert severities(*landed("AAL123", 600.0, 40.0), truck(1050.0)) == []


@pytest.mark.parametrize(("behind_m", "is_met"), [(29.0, True), (31.0, False)])
def test_who_is_30_m_behind_is_in_nobodys_way(behind_m: float, is_met: bool) -> None:
    assert bool(collisions(departure(), truck(300.0 - behind_m))) is is_met


# --- two at one place at about the same time --------------------------------------------------


@pytest.mark.parametrize(("after_s", "is_met"), [(4.9, True), (5.1, False), (-3.0, True)])
def test_who_crosses_is_met_until_5_s_after_it_has_left(after_s: float, is_met: bool) -> None:
    """At 10 m/s it is off the certain part of the area after 3.85 s."""
    reach_s = CORE_M / 10.0 + after_s
    ahead_m = 40.0 * reach_s + 0.9 * reach_s**2
    assert bool(collisions(departure(), truck(300.0 + ahead_m, 0.0, 10.0))) is is_met


@pytest.mark.parametrize(("before_s", "is_met"), [(5.1, False), (4.9, True)])
def test_who_enters_is_met_from_5_s_before_it_enters(before_s: float, is_met: bool) -> None:
    """A fast one that cannot stop short any more enters 9 s from now, and leaves 10 s from now."""
    speed_m_s = 80.0
    reach_s = 9.0 - before_s
    ahead_m = 40.0 * reach_s + 0.9 * reach_s**2
    other = truck(300.0 + ahead_m, CORE_M + 9.0 * speed_m_s, speed_m_s)
    assert bool(collisions(departure(), other)) is is_met


@pytest.mark.parametrize(
    ("entry_m", "speed_m_s", "is_met"),
    [(12.4, 10.0, True), (12.6, 10.0, False), (0.2, 1.4, False), (0.2, 1.6, True),
     (-5.0, 0.0, True)],
)  # fmt: skip
def test_who_cannot_stop_short_of_the_area_counts(
    entry_m: float, speed_m_s: float, is_met: bool
) -> None:
    """10 m/s are braked in 12.5 m at 4 m/s2; who stands does not enter."""
    other = truck(500.0, CORE_M + entry_m, speed_m_s)
    assert bool(collisions(departure(), other)) is is_met


@pytest.mark.parametrize(
    ("turned_deg", "speed_m_s", "ahead_m"),
    [
        (-90.0, 5.0, 0.0),  # Straight across.
        (-45.0, 5.0, 0.0 + CORE_M / 2.0),  # From the middle on: half of the way out of the area.
        (-135.0, 5.0, -CORE_M / 2.0),
        (-45.0, 1.4, 0.0),  # It stands.
        (-14.0, 1.6, 0.0),  # It moves along the runway: where it is now.
        (-166.0, 1.6, 0.0),
    ],
)  # fmt: skip
def test_who_crosses_aslant_is_met_in_the_middle_of_its_way(
    turned_deg: float, speed_m_s: float, ahead_m: float
) -> None:
    (found,) = collisions(departure(300.0, 40.0), truck(400.0, 0.0, speed_m_s, turned_deg))
    assert found.evidence.time_to_go_s == pytest.approx(rolls_s(100.0 + ahead_m), abs=0.02)


# --- who is told what -------------------------------------------------------------------------


def test_a_vehicle_and_who_has_left_the_ground_are_not_alerted() -> None:
    fast = report("OPS1", 300.0, 0.0, 40.0, category="C2")
    assert collisions(fast, truck(500.0)) == []
    climbs = report("AAL123", 300.0, 0.0, 75.0, height_m=20.0, rate_fpm=1500.0)
    assert collisions(climbs, truck(500.0)) == []
    assert collisions(departure()) == []  # It does not meet itself.


@pytest.mark.parametrize(
    ("reports", "left_s", "expected"),
    [
        ((arrival("AAL123", 20.0),), Severity.WARNING, {}),
        ((arrival("AAL123", 20.0),), Severity.CAUTION, {"AAL123": GoAround(runway="01")}),
        ((arrival("AAL123", 5.0),), Severity.WARNING, {"AAL123": GoAround(runway="01")}),
        ((departure(),), Severity.WARNING, {"AAL123": CancelTakeoff(runway="01")}),
        (landed("AAL123", 300.0, 40.0), Severity.WARNING, {}),  # It brakes already.
    ],
)
def test_a_crew_responds_from_a_severity_on(
    reports: tuple[AdsbReport, ...], left_s: Severity, expected: dict[str, Any]
) -> None:
    (found,) = collisions(*reports, truck(500.0), responds_from=left_s)
    assert found.recommendations == expected


def test_the_hazard_names_the_two_and_where_the_other_is() -> None:
    (found,) = collisions(arrival("AAL123", 5.0), truck(500.0))
    assert (found.key, found.recipients) == (("AAL123", "OPS1"), ("AAL123",))
    assert found.traffic == ("AAL123", "OPS1")
    assert found.evidence.note == "OPS1 is on runway 01"
    assert len(set(found.evidence.tracks)) == 2
    (enters,) = collisions(departure(), truck(500.0, CORE_M + 10.0, 10.0))
    assert enters.evidence.note == "OPS1 is about to enter runway 01"


# --- the engine -------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "from_severity"), [("surf_a", 1), ("surf_a:caution", 0)])
def test_the_crew_alone_is_told_what_is_there_and_goes_around_from_a_severity_on(
    name: str, from_severity: int
) -> None:
    movers = [
        Mover("AAL123", NORTH, lands(90.0)),
        Mover("OPS1", NORTH, stands(800.0), category="C2"),
    ]
    worker = DecisionWorker(ASSISTANTS.create(name), Template())
    field = Airfield(movers, worker=worker).run(95.0)
    assert {told.recipient for _, told in field.told} == {"AAL123"}
    told = [told for _, told in field.told]
    assert [each.severity for each in told] == ["CAUTION", "WARNING"]
    for number, each in enumerate(told):
        action = "go around. " if number >= from_severity else ""
        assert each.message.startswith(f"AAL123 {action}OPS1 is on runway 01")
        assert each.evidence.sources == ("adsb",)
        assert len(each.evidence.tracks) == 2


def test_thresholds_out_of_order_and_severities_without_alerts_are_refused_by_name() -> None:
    with pytest.raises(AirhiltError, match="warning_s is 15; expected at most caution_s, 10"):
        ASSISTANTS.create("surf_a", configuration={"caution_s": 10.0})
    with pytest.raises(AirhiltError, match="'surf_a:info': expected surf_a:caution or surf_a:warn"):
        ASSISTANTS.create("surf_a:info")
