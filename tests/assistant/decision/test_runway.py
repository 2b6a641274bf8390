"""Conflicts on runways: told in time, to those concerned, and never in normal traffic."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airfield import (
    NORTH,
    SOUTHEAST,
    Airfield,
    Axis,
    Mover,
    drives,
    goes_around,
    lands,
    lines_up_and_goes,
    stands,
    takes_off,
)
from airhilt.assistant.decision.aerodrome import Aerodrome
from airhilt.assistant.decision.engines.reference import ReferenceConfig
from airhilt.assistant.decision.escalation import Escalation
from airhilt.assistant.decision.mobiles import is_on_pavement
from airhilt.assistant.decision.threats import PAPER_TIME_TO_GO_S, RunwayConfig
from airhilt.cosim.briefing import briefing_of
from airhilt.messages import AirportBriefing, Severity
from airhilt.sim import Input
from airhilt.surveillance.receivers import Receiver
from airhilt.world.loading import load
from airhilt.world.site import ScenarioSite
from breadth import mostly_slow
from decisions import reference

SEEDS = mostly_slow(range(3), 0)


def arrival(
    at_s: int, axis: Axis = NORTH, callsign: str = "AAL123", seed: int = 1, **how: Any
) -> Mover:
    return Mover(callsign, axis, lands(at_s, **how), seed=seed)


def departure(
    rolls_at_s: int, axis: Axis = NORTH, callsign: str = "DAL456", seed: int = 1, **how: Any
) -> Mover:
    return Mover(callsign, axis, takes_off(rolls_at_s, **how), seed=seed)


def vehicle(spot: Callable[..., Any], seed: int = 1, **how: Any) -> Mover:
    return Mover("OPS1", NORTH, spot, 90.0, "C2", seed, **how)


# --- normal traffic -------------------------------------------------------------------------


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("seconds", "movers"),
    {
        "a landing after another has left": (
            200, lambda s: [arrival(30, seed=s), arrival(107, callsign="DAL456", seed=s)],
        ),
        "a departure before an arrival at 5 NM": (
            180, lambda s: [
                arrival(132, seed=s),
                Mover("DAL456", NORTH, lines_up_and_goes(5, 45), 90.0, seed=s),
            ],
        ),
        "one lines up behind the landing and goes when it has left": (
            200, lambda s: [
                arrival(40, seed=s),
                Mover("DAL456", NORTH, lines_up_and_goes(45, 125), 90.0, seed=s),
            ],
        ),
        "an aircraft and a vehicle hold short": (
            130, lambda s: [
                arrival(90, seed=s),
                Mover("DAL456", NORTH, stands(40, -100), 90.0, seed=s),
                vehicle(stands(800, -82), seed=s),
            ],
        ),
        "a vehicle on the parallel taxiway": (
            130, lambda s: [
                arrival(60, seed=s),
                replace(vehicle(lambda t: (100 + 8 * t, -125.0, None), seed=s), heading_deg=0.0),
            ],
        ),
        "a vehicle crosses long before": (
            150, lambda s: [arrival(120, seed=s), vehicle(drives(5), seed=s)],
        ),
        "a vehicle crosses behind the landing": (
            150, lambda s: [arrival(60, seed=s), vehicle(drives(70), seed=s)],
        ),
        "a departure on the crossing runway, long gone": (
            150, lambda s: [arrival(110, seed=s), departure(25, SOUTHEAST, seed=s)],
        ),
        "a go-around": (
            150, lambda s: [
                Mover("AAL123", NORTH, goes_around(100, 4000.0), seed=s),
                vehicle(stands(800, -82), seed=s),
            ],
        ),
    }.values(),
    ids=itertools.count(),
)  # fmt: skip
def test_normal_traffic_is_quiet(seconds: int, movers: Callable[..., Any], seed: int) -> None:
    assert Airfield(movers(seed)).run(seconds).told == []


# --- a runway is occupied: step (b) ---------------------------------------------------------


@pytest.mark.parametrize("seed", SEEDS)
def test_an_occupied_runway_is_a_caution_at_60_s_and_a_warning_to_go_around_at_35_s(
    seed: int,
) -> None:
    field = Airfield([arrival(100, seed=seed), vehicle(stands(800), seed=seed)]).run(130)
    caution_s, _ = field.first("CAUTION")
    warning_s, warning = field.first("WARNING")
    assert 100 - caution_s == pytest.approx(60.0, abs=4.0)
    assert 100 - warning_s == pytest.approx(35.0, abs=4.0)
    assert set(field.advice("AAL123")) == {("go_around", "01")}
    assert field.advice("OPS1") == []
    assert warning.recipients == ("AAL123", "OPS1", "ATC")
    assert warning.traffic == ("AAL123", "OPS1")
    assert warning.evidence.runway == "01"
    assert warning.evidence.time_to_go_s == pytest.approx(100 - warning_s, abs=2.0)
    assert warning.evidence.sources == ("adsb",)


def test_it_is_one_alert_in_plain_words_whose_severity_only_rises_and_that_ends() -> None:
    """It is told again to those who do not do as told, once there was time to."""
    field = Airfield([arrival(100), vehicle(stands(800))]).run(150)
    for callsign, words in (
        ("AAL123", "AAL123 go around. OPS1 is on runway 01, "),
        ("OPS1", "OPS1 AAL123 on final for runway 01, "),
        ("ATC", "AAL123, OPS1 is on runway 01, "),
    ):
        told = field.to(callsign)
        assert told[1].message.startswith(words)
        *told_again, over = told[1:]
        assert told[0].severity == "CAUTION"
        assert {each.severity for each in told_again} == {"WARNING"}
        assert (len(told_again) > 1) is (callsign != "OPS1")  # Nothing was recommended to that one.
        assert over.severity == "INFO"
        assert [advisory.active for advisory in told] == [True] * (len(told) - 1) + [False]
        revisions = [advisory.revision for advisory in told]
        assert revisions == sorted(set(revisions))
        assert len({advisory.id for advisory in told}) == 1
    assert field.to("ATC")[1].message.endswith("; AAL123 go around")


def test_it_ends_soon_after_the_arrival_has_gone_around() -> None:
    movers = [Mover("AAL123", NORTH, goes_around(100, 1800.0)), vehicle(stands(800))]
    field = Airfield(movers).run(130)
    over_s, over = field.told[-1]
    assert (over.active, over.severity, over.recommendation) == (False, "INFO", None)
    assert over_s == pytest.approx(100 - 1800 / 70 + 5.0, abs=4.0)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_vehicle_that_drives_on_to_the_runway_is_told_to_hold_and_then_the_arrival_to_go_around(
    seed: int,
) -> None:
    field = Airfield([arrival(90, seed=seed), vehicle(drives(38, to_m=0.0), seed=seed)]).run(110)
    first_s, first = field.first("CAUTION")
    crosses_hold_line_s = 38 + (250 - 76) / 8
    reaches_pavement_s = 38 + (250 - 23) / 8
    assert crosses_hold_line_s - 4.0 < first_s < reaches_pavement_s
    assert "is about to enter runway 01" in first.message
    assert field.advice("OPS1")[0] == ("hold_position", "01")
    assert set(field.advice("AAL123")) == {("go_around", "01")}
    assert first_s < field.first("WARNING")[0] < reaches_pavement_s + 3.0


def test_the_better_the_position_the_earlier_an_entry_is_foreseen() -> None:
    def told_s(nacp: int) -> float:
        movers = [arrival(90), vehicle(drives(38, to_m=0.0), nacp=nacp)]
        return Airfield(movers).run(100).first("CAUTION")[0]

    assert told_s(11) < told_s(10) < told_s(9)
    assert told_s(11) < 38 + (250 - 76) / 8 + 1.0


def test_who_has_not_gone_when_the_arrival_is_near_holds_and_the_arrival_goes_around() -> None:
    field = Airfield([arrival(90), departure(999)]).run(80)
    assert set(field.advice("DAL456")) == {("cancel_takeoff", "01")}
    assert set(field.advice("AAL123")) == {("go_around", "01")}


def test_an_outage_does_not_clear_a_runway() -> None:
    field = Airfield([arrival(100), vehicle(stands(800))])
    report = field._report

    def silent(station: Receiver, mover: Mover, t_ns: int, step: int) -> list[Any]:
        return [] if 142 <= step <= 158 else report(station, mover, t_ns, step)

    field._report = silent
    field.run(95)
    assert all(advisory.active for advisory in field.to("ATC"))


# --- what was said: steps (a) and (c) -------------------------------------------------------


def test_a_conflict_is_the_same_once_somebody_in_it_has_sent_its_callsign() -> None:
    field = Airfield([arrival(55), Mover("DAL456", NORTH, stands(50))])
    lands, hear = field.movers[0], field._report

    def report(station: Receiver, mover: Mover, t_ns: int, step: int) -> list[Input]:
        heard = hear(station, mover, t_ns, step)
        if mover is not lands or step >= 10:
            return heard
        return [replace(each, payload=each.payload.replace(b'"AAL123"', b"null")) for each in heard]

    field._report = report
    told = field.run(20).to("ATC")
    assert [(each.id, each.revision, each.active) for each in told] == [
        ("decision-runway-1", 0, True),
        ("decision-runway-1", 1, True),
    ]
    assert [set(each.traffic) for each in told] == [
        {lands.icao24, "DAL456"},
        {"AAL123", "DAL456"},
    ]
    assert len(field.to("AAL123")) == 1


# --- beside the runways ---------------------------------------------------------------------


def test_without_an_airport_runways_are_of_no_concern() -> None:
    field = Airfield([arrival(100), vehicle(stands(800))])
    field._step = lambda t_ns, inputs, step=field._step: step(  # type: ignore[misc]
        t_ns, [item for item in inputs if item.key != "briefing"]
    )
    assert field.run(110).told == []


def test_the_times_to_go_are_a_matter_of_configuration() -> None:
    config = ReferenceConfig(runways=RunwayConfig(warning_s=PAPER_TIME_TO_GO_S))
    field = Airfield([arrival(100), vehicle(stands(800))], worker=reference(config))
    assert 100 - field.run(110).first("WARNING")[0] == pytest.approx(8.0, abs=3.0)


def test_before_a_displaced_threshold_there_is_a_runway_that_others_cross() -> None:
    """At Schiphol, 18L crosses 09/27 before its threshold: a takeoff begins there."""
    scenario = load("s01a_misaddressed_takeoff")
    airport = briefing_of(scenario, ScenarioSite.of(scenario)).airport
    aerodrome = Aerodrome(cast(AirportBriefing, airport))
    strip, other = aerodrome.strip_of("18L"), aerodrome.strip_of("27")
    assert strip is not None
    assert other is not None
    point = aerodrome.crossing(strip, other)
    direction = next(each for each in strip.directions if each.ident == "18L")
    assert point is not None
    assert direction.along_m(point) == pytest.approx(391.0 - 575.0, abs=3.0)
    assert is_on_pavement(direction, -direction.displaced_m, 0.0)
    assert not is_on_pavement(direction, -direction.displaced_m - 900.0, 0.0)


@given(st.lists(st.sampled_from([None, *Severity]), min_size=1, max_size=40))
def test_a_severity_that_is_told_only_rises(levels: list[Any]) -> None:
    escalation, told = Escalation("one"), []
    for second, level in enumerate(levels):
        if level is None:
            escalation.is_over(second * 10**9, 1e9)
        elif escalation.rises(level, second * 10**9, 1.0):
            told.append(escalation.severity.rank)
    assert told == sorted(set(told))
