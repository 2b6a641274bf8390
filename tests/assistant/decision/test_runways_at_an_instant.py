"""Runways at one instant: who is where, and what is wrong, from reports and calls alone."""

from __future__ import annotations

import math
from typing import Any

import pytest

from airfield import NORTH, SOUTHEAST
from airhilt.assistant.decision.findings import Obstruction
from airhilt.assistant.decision.flight_path import _time_abeam_s
from airhilt.assistant.decision.threats import Outlook, RunwayConfig, Snapshot
from airhilt.messages import AdsbReport, Severity
from instants import CONFIG, Field, aloft, arrival, at, crossing_m, landed, report, runway, seen

CORE_M = 76.0 - 1.25 * 30.0
"""Where the area begins in which one with NACp 9 is certain to be, from the centre line, in m."""

# --- who is there -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("callsign", "category", "is_vehicle"),
    [("OPS1", "A3", True), ("OPS1", None, True), ("N1", "C2", True), ("N1", None, False),
     ("AAL123", "A3", False)],
)  # fmt: skip
def test_a_vehicle_is_known_by_the_roster_or_by_its_category(
    callsign: str, category: str | None, is_vehicle: bool
) -> None:
    field = Field(report(callsign, 500.0, category=category))
    assert field.mobile(callsign).is_vehicle is is_vehicle
    assert field.situation.is_vehicle(callsign) is (callsign == "OPS1")


def test_all_who_are_expected_or_have_reported_are_known() -> None:
    field = Field(report("ZZZ9", 500.0), report(None, 600.0, icao24="abcdef"))
    assert field.situation.callsigns == ["AAL123", "DAL456", "OPS1", "ZZZ9", "abcdef"]


@pytest.mark.parametrize(
    ("speed_m_s", "height_m", "silent_s", "is_known"),
    [
        (1.4, None, 30.0, True), (1.4, None, 30.1, False), (1.6, None, 15.0, True),
        (1.6, None, 15.1, False), (70.0, 50.0, 15.0, True), (1.4, 50.0, 15.1, False),
    ],
)  # fmt: skip
def test_who_is_silent_is_forgotten_and_who_stands_later(
    speed_m_s: float, height_m: float | None, silent_s: float, is_known: bool
) -> None:
    field = Field(
        report("AAL123", 500.0, 0.0, speed_m_s, height_m=height_m, rate_fpm=-300.0),
        report("DAL456", 300.0, 0.0, t_s=silent_s),
    )
    strip, _ = runway("01")
    field.situation.forget(at(silent_s))
    known = field.situation.mobile("AAL123") is not None
    on_it = {each.mobile.callsign for each in field.situation.obstacles(strip)}
    assert known is is_known
    assert on_it == {"DAL456", *(["AAL123"] if known and height_m is None else [])}
    assert bool(field.situation.uses) is (known and height_m is not None)


def test_an_older_report_changes_nothing_but_that_somebody_was_heard() -> None:
    field = Field(report("AAL123", 500.0, t_s=10.0))
    before = field.mobile("AAL123").point
    field.situation.take_report(report("AAL123", 900.0, t_s=9.9), at(20.0))
    assert field.mobile("AAL123").point == before
    field.situation.forget(at(50.0))
    assert field.situation.mobile("AAL123") is not None
    field.situation.take_report(report("AAL123", 900.0, t_s=10.0), at(20.0))
    assert field.mobile("AAL123").point != before


@pytest.mark.parametrize(
    ("across_m", "turned_deg", "is_obstacle", "is_inside"),
    [
        (0.0, 0.0, True, True),
        (CORE_M - 1.0, 90.0, True, True),
        (CORE_M + 1.0, -90.0, True, False),
        (CORE_M + 1.0, 90.0, False, False),
        (500.0, -90.0, True, False),
        (500.0, 0.0, False, False),
    ],
)
def test_an_obstacle_is_on_a_runway_or_has_it_straight_ahead(
    across_m: float, turned_deg: float, is_obstacle: bool, is_inside: bool
) -> None:
    field = Field(report("OPS1", 500.0, across_m, 5.0, turned_deg=turned_deg))
    strip, _ = runway("01")
    found = list(field.situation.obstacles(strip))
    assert [each.is_inside for each in found] == ([is_inside] if is_obstacle else [])
    field.situation.take_report(report("OPS1", 500.0, 500.0, 5.0, t_s=1.0), at(1.0))
    assert list(field.situation.obstacles(strip)) == []


# --- what a clearance is used for -------------------------------------------------------------

LAND = "American one two three, runway zero one, cleared to land."
TAKE_OFF = "American one two three, runway zero one, cleared for takeoff."
LINE_UP = "American one two three, runway zero one, line up and wait."


@pytest.mark.parametrize(("across_m", "is_used"), [(70.0, False), (80.0, True)])
def test_a_landing_is_over_outside_the_protected_areas(across_m: float, is_used: bool) -> None:
    field = Field(*landed("AAL123", 1500.0, 8.0)).hears(0.0, LAND)
    assert field.mobile("AAL123").landed
    field.situation.take_report(report("AAL123", 1500.0, across_m, 8.0, t_s=9.0), at(9.0))
    assert field.mobile("AAL123").landed is not is_used
    assert field.in_force() == ([] if is_used else [("AAL123", "cleared_to_land")])


@pytest.mark.parametrize(("text", "is_used"), [(LAND, False), (TAKE_OFF, True), (LINE_UP, True)])
def test_a_takeoff_is_over_in_the_air(text: str, is_used: bool) -> None:
    field = Field(report("AAL123", 100.0)).hears(0.0, text)
    assert len(field.in_force()) == 1
    field.situation.take_report(report("AAL123", 900.0, 0.0, 60.0, t_s=1.0), at(1.0))
    assert len(field.in_force()) == 1
    field.situation.take_report(
        report("AAL123", 1500.0, 0.0, 75.0, height_m=20.0, rate_fpm=1500.0, t_s=2.0), at(2.0)
    )
    assert (field.in_force() == []) is is_used


@pytest.mark.parametrize(
    ("who", "where", "runways"),
    [
        ("Tower, ", "runway one five", ["15/33"]),
        ("Delta four five six, ", "runway zero one", ["01/19"]),
        ("Delta four five six, ", "the runway", ["15/33"]),  # It is on final for it.
        ("American one two three, ", "the runway", ["01/19", "15/33"]),
    ],
)
def test_animals_are_on_the_runway_that_is_named_or_used_or_on_any(
    who: str, where: str, runways: list[str]
) -> None:
    field = Field(arrival("DAL456", 50.0, axis=SOUTHEAST)).hears(10.0, f"{who}deer on {where}.")

    def reported(t_s: float) -> list[str]:
        return [
            strip.name
            for strip in field.situation.aerodrome.strips
            if field.situation.wildlife_report(strip, at(t_s)) is not None
        ]

    assert reported(10.0) == reported(130.0) == runways
    assert reported(130.1) == []
    field.hears(20.0, "Tower, the deer are gone from runway one five.")
    assert reported(21.0) == [name for name in runways if name != "15/33"]


# --- how long until somebody is there ---------------------------------------------------------


def to_point(field: Field, callsign: str, along_m: float, t_s: float = 0.0) -> float | None:
    use = field.use(callsign)
    snapshot = Snapshot(field.situation, at(t_s))
    return snapshot.time_to_point_s(use, use.direction.point(along_m))


def test_an_arrival_is_anywhere_once_it_is_at_the_threshold() -> None:
    field = Field(arrival("AAL123", 50.0))
    for along_m in (0.0, 2000.0):
        assert to_point(field, "AAL123", along_m) == pytest.approx(50.0, rel=1e-3)
        assert to_point(field, "AAL123", along_m, 10.0) == pytest.approx(40.0, rel=1e-3)


@pytest.mark.parametrize(
    ("ahead_m", "time_s"),
    [(-31.0, None), (-29.0, 0.0), (400.0, 10.0), (544.0, 13.6), (545.0, math.inf)],
)
def test_a_landing_comes_as_far_as_it_brakes_and_100_m(
    ahead_m: float, time_s: float | None
) -> None:
    """From 40 m/s at 1.8 m/s2 that is 444.4 m and 100 m."""
    field = Field(*landed("AAL123", 600.0, 40.0))
    found = to_point(field, "AAL123", 600.0 + ahead_m)
    assert found == (None if time_s is None else pytest.approx(time_s, abs=1e-2))


def test_who_has_left_the_ground_comes_to_nothing_on_it() -> None:
    field = Field(report("AAL123", 900.0, 0.0, 80.0, height_m=20.0, rate_fpm=1500.0))
    assert to_point(field, "AAL123", 1500.0) is None


# --- somebody on the runway -------------------------------------------------------------------

CROSS = "Ops one, cross runway zero one."


def crosses(speed_m_s: float = 10.0, across_m: float = 0.0) -> AdsbReport:
    """Return the report of a vehicle on the runway that drives to the left."""
    return report("OPS1", 800.0, across_m, speed_m_s, turned_deg=-90.0, category="C2")


@pytest.mark.parametrize(
    ("to_go_s", "severity"), [(34.9, "WARNING"), (35.1, "CAUTION"), (59.9, "CAUTION"), (60.2, None)]
)
def test_who_stands_on_a_runway_is_in_the_way_of_an_arrival(
    to_go_s: float, severity: str | None
) -> None:
    told = Field(arrival("AAL123", to_go_s), crosses(0.0)).obstructions()
    assert told == ([("AAL123", "on", "OPS1", severity)] if severity else [])


@pytest.mark.parametrize(
    ("to_go_s", "speed_m_s", "is_cleared", "severity"),
    [
        # At 10 m/s it is off the certain part of the area after 3.85 s, and 8 s more are wanted.
        (11.9, 10.0, True, "INFO"), (11.8, 10.0, True, "WARNING"), (30.0, 10.0, False, "WARNING"),
        (36.0, 10.0, False, "INFO"), (36.0, 1.6, False, "INFO"), (36.0, 1.3, True, "CAUTION"),
        (8.1, 400.0, True, "INFO"), (8.0, 400.0, True, "WARNING"),
    ],
)  # fmt: skip
def test_who_is_across_in_time_is_in_nobodys_way_if_cleared_or_early(
    to_go_s: float, speed_m_s: float, is_cleared: bool, severity: str
) -> None:
    field = Field(arrival("AAL123", to_go_s), crosses(speed_m_s))
    if is_cleared:
        field.hears(0.0, CROSS)
    assert field.obstructions() == [("AAL123", "on", "OPS1", severity)]


def test_the_time_until_it_is_off_runs_on_since_its_report() -> None:
    field = Field(arrival("AAL123", 20.0), crosses(1.9)).hears(0.0, CROSS)  # Off after 20.3 s.
    assert [each for *_, each in field.obstructions()] == ["WARNING"]
    field.situation.take_report(arrival("AAL123", 16.0, t_s=12.0), at(12.0))
    assert [each for *_, each in field.obstructions(12.0)] == ["WARNING"]
    field.situation.take_report(arrival("AAL123", 16.5, t_s=12.0), at(12.0))
    assert [each for *_, each in field.obstructions(12.0)] == ["INFO"]


def test_who_was_sent_on_to_a_runway_stays_there() -> None:
    field = Field(arrival("AAL123", 36.0), crosses(10.0))
    field.hears(0.0, "Ops one, proceed on runway zero one.")
    assert field.obstructions() == [("AAL123", "on", "OPS1", "CAUTION")]


@pytest.mark.parametrize(
    ("speed_m_s", "before_m", "is_told"),
    [
        (8.0, 7.8, True), (8.0, 8.2, False),  # 8 m at 4 m/s2.
        (2.1, 0.4, True), (2.1, 0.7, False),
        (1.9, -15.0, False),
    ],
)  # fmt: skip
def test_who_cannot_stop_short_any_more_is_about_to_enter(
    speed_m_s: float, before_m: float, is_told: bool
) -> None:
    """Even if it is farther away than it reports: by two thirds of 30 m."""
    place = crosses(speed_m_s, 76.0 - 0.67 * 30.0 + before_m)
    told = Field(arrival("AAL123", 20.0), place).obstructions()
    assert told == ([("AAL123", "entering", "OPS1", "CAUTION")] if is_told else [])


@pytest.mark.parametrize(("before_m", "enters"), [(7.9, True), (8.1, False)])
def test_it_has_entered_once_it_has_come_that_far_and_could_surely_not_stop(
    before_m: float, enters: bool
) -> None:
    """76 m from the centre less 30 m of error; 38.5 m from it is where it is surely inside."""
    across_m = 76.0 - 30.0 + before_m
    field = Field(arrival("AAL123", 20.0), crosses(8.0, across_m))
    inside_s = (across_m - CORE_M) / 8.0
    for t_s in (0.0, inside_s - 0.1, inside_s + 0.1):
        told = ("on", "WARNING") if enters and t_s > inside_s else ("entering", "CAUTION")
        assert field.obstructions(t_s) == [("AAL123", told[0], "OPS1", told[1])]


@pytest.mark.parametrize(
    ("across_m", "t_s", "is_told", "is_told_of_who_holds"),
    [(62.0, 0.0, True, False), (53.0, 0.0, True, True), (70.0, 1.0, True, False),
     (53.9, 2.0, True, True), (54.1, 2.0, True, False)],
)  # fmt: skip
def test_who_was_told_to_hold_short_may_err_by_all_of_30_m_and_stop(
    across_m: float, t_s: float, is_told: bool, is_told_of_who_holds: bool
) -> None:
    field = Field(arrival("AAL123", 20.0), crosses(8.0, across_m))
    assert bool(field.obstructions(t_s)) is is_told
    field.hears(0.0, "Ops one, hold short runway zero one.")
    assert bool(field.obstructions(t_s)) is is_told_of_who_holds


@pytest.mark.parametrize(
    ("to_go_s", "t_s", "is_told"),
    [(50.0, 0.0, True), (31.0, 0.0, False), (29.0, 0.0, True), (50.0, 9.0, True)],
)
def test_one_that_nobody_sees_may_be_on_the_runway_for_30_s(
    to_go_s: float, t_s: float, is_told: bool
) -> None:
    field = Field(arrival("AAL123", to_go_s)).hears(t_s, "Ops one, proceed on runway zero one.")
    assert field.obstructions(t_s) == [("AAL123", "cleared on to", "OPS1", "CAUTION")]
    (threat,) = field.threats(t_s)
    assert (threat.parties, threat.rule) == (("AAL123", "OPS1"), "cleared_on")
    assert (threat.sources, threat.radio_ids) == (("adsb", "radio"), (f"at {t_s:g}",))
    field = Field(arrival("AAL123", to_go_s)).hears(t_s, CROSS)
    told = field.obstructions(t_s)
    assert bool(told) is (to_go_s - t_s < 30.0)


def test_reported_animals_are_in_the_way_of_who_comes_and_not_of_who_has_been_there() -> None:
    deer = "Tower, deer on runway zero one."
    for comes, severity in (
        ((arrival("AAL123", 30.0),), "WARNING"),
        ((arrival("AAL123", 50.0),), "CAUTION"),
        ((arrival("AAL123", 61.0),), None),
        ((report("AAL123", 300.0, 0.0, 40.0),), "WARNING"),
        (landed("AAL123", 600.0, 40.0), None),
        ((report("AAL123", 900.0, 0.0, 80.0, height_m=20.0, rate_fpm=1500.0),), None),
    ):
        field = Field(*comes).hears(0.0, deer)
        told = field.obstructions()
        assert told == ([("AAL123", "reported on", "wildlife", severity)] if severity else [])
        for each in field.threats():
            assert (each.parties, each.traffic) == (("AAL123",), ("AAL123", "wildlife"))
            assert (each.sources, each.radio_ids) == (("adsb", "radio"), ("at 0",))


def test_one_that_is_not_known_does_not_hide_another_that_was_sent_there() -> None:
    field = Field(arrival("AAL123", 40.0), crosses(0.0))
    field.hears(-2.0, "Ops one, proceed on runway zero one.")
    field.hears(0.0, "Delta four five six, proceed on runway zero one.")
    assert field.obstructions() == [
        ("AAL123", "on", "OPS1", "CAUTION"),
        ("AAL123", "cleared on to", "DAL456", "CAUTION"),
    ]


def test_who_takes_off_may_do_so_though_it_was_sent_on_to_the_runway_before() -> None:
    field = Field(arrival("AAL123", 34.0), report("DAL456", 500.0, 0.0, 30.0))
    field.hears(0.0, "Delta four five six, proceed on runway zero one.")
    told = [each for each in field.obstructions() if each[0] == "AAL123"]
    assert told == [("AAL123", "on", "DAL456", "INFO")]


def test_what_is_in_doubt_excuses_nobody_and_takes_nothing_away() -> None:
    field = Field(arrival("AAL123", 30.0), crosses(10.0))
    field.hears(0.0, "Ops one, cross? runway zero one.")
    assert field.obstructions() == [("AAL123", "on", "OPS1", "WARNING")]
    sent = [("AAL123", "cleared on to", "OPS1", "CAUTION")]
    unseen = Field(arrival("AAL123", 40.0)).hears(-6.0, "Ops one, proceed? onto runway zero one.")
    assert unseen.obstructions() == sent
    unseen.hears(-3.0, "Ops one, hold? short? of runway zero one.")
    assert unseen.obstructions() == sent
    assert unseen.hears(0.0, "Ops one, hold short of runway zero one.").obstructions() == []
    deer = [("AAL123", "reported on", "wildlife", "WARNING")]
    seen_there = Field(arrival("AAL123", 30.0)).hears(-6.0, "Tower, deer on runway zero one.")
    seen_there.hears(-3.0, "Tower, the deer are gone? from runway zero one.")
    assert seen_there.obstructions() == deer
    assert seen_there.hears(0.0, "Tower, the deer are gone from runway zero one.").threats() == []


# --- what only cameras show -------------------------------------------------------------------


@pytest.mark.parametrize(
    ("how", "expected"),
    [
        ({}, ("unidentified on", "truck", ("AAL123", "unidentified"))),
        ({"label": "deer", "is_animal": True}, ("animal on", "deer", ("AAL123", "wildlife"))),
        ({"label": "airplane"}, ("unidentified on", "airplane", ("AAL123", "unidentified"))),
    ],
)
def test_what_is_seen_on_a_runway_is_in_the_way(
    how: dict[str, Any], expected: tuple[str, str, tuple[str, ...]]
) -> None:
    field = seen(Field(arrival("AAL123", 30.0)), **how)
    (told,) = field.threats()
    assert isinstance(told.finding, Obstruction)
    assert (told.finding.how, told.finding.what, told.traffic) == expected
    assert (told.severity, told.sources) == (Severity.WARNING, ("vision", "adsb"))
    assert (told.parties, told.rule, told.shares) == (("AAL123",), "occupancy", {})
    assert seen(Field(arrival("AAL123", 61.0)), **how).threats() == []


def test_behind_who_uses_the_runway_it_is_in_nobodys_way() -> None:
    rolls = report("AAL123", 900.0, 0.0, 40.0)
    assert seen(Field(rolls)).threats() == []
    assert seen(Field(rolls), along_m=1200.0).threats() != []


@pytest.mark.parametrize(
    ("label", "calls", "named"),
    [
        ("truck", ["Ops one, proceed on runway zero one."], "OPS1"),
        ("truck", ["Ops one, proceed on runway one five."], None),
        ("airplane", ["Ops one, proceed on runway zero one."], None),
        ("airplane", ["Delta four five six, cross runway zero one."], "DAL456"),
        ("truck", ["Delta four five six, cross runway zero one."], None),
        ("truck", ["Delta four five six, cross runway zero one.",
                   "Ops one, proceed on runway zero one."], "OPS1"),
        ("deer", ["Ops one, proceed on runway zero one."], None),
    ],
)  # fmt: skip
def test_it_is_the_only_one_of_its_kind_that_was_sent_there(
    label: str, calls: list[str], named: str | None
) -> None:
    field = seen(Field(arrival("AAL123", 30.0)), label=label, is_animal=label == "deer")
    for number, text in enumerate(calls):
        field.hears(number - 3.0, text)
    found = [each for each in field.threats() if "vision" in each.sources]
    assert [each.parties for each in found] == [("AAL123", *([named] if named else []))]
    assert ("radio" in found[0].sources) is (named is not None)
    assert found[0].radio_ids == ((f"at {len(calls) - 4:g}",) if named else ())


def test_who_reports_by_itself_is_not_what_is_seen() -> None:
    field = seen(Field(arrival("AAL123", 30.0), report("OPS1", 0.0, 500.0, category="C2")))
    field.hears(0.0, "Ops one, proceed on runway zero one.")
    assert [each.parties for each in field.threats() if "vision" in each.sources] == [("AAL123",)]


@pytest.mark.parametrize(
    ("call", "speed_m_s", "to_go_s", "severity"),
    [
        # At 10 m/s it is off after 2 s, and 8 s more are wanted.
        (None, 10.0, 30.0, "WARNING"), (None, 10.0, 36.0, "INFO"), (None, 1.4, 36.0, "CAUTION"),
        (CROSS, 10.0, 31.0, "INFO"), (CROSS, 10.0, 9.9, "WARNING"), (CROSS, 1.4, 30.0, "WARNING"),
        ("Ops one, proceed on runway zero one.", 10.0, 36.0, "CAUTION"),
    ],
)  # fmt: skip
def test_what_is_seen_to_leave_in_time_is_in_nobodys_way_if_cleared_or_early(
    call: str | None, speed_m_s: float, to_go_s: float, severity: str
) -> None:
    field = seen(Field(arrival("AAL123", to_go_s)), speed_m_s=speed_m_s)
    if call is not None:
        field.hears(0.0, call)
    assert [each.severity for each in field.threats()] == [severity]


@pytest.mark.parametrize(
    ("weight", "is_animal", "is_told", "severity"),
    [
        (0.29, False, False, None), (0.31, False, False, "ADVISORY"),  # 0.35 and half of it.
        (0.79, False, False, "ADVISORY"), (0.81, False, False, "CAUTION"),
        (0.49, False, True, "ADVISORY"), (0.51, False, True, "CAUTION"),  # 0.15 more.
        (0.49, True, True, "ADVISORY"), (0.51, True, True, "CAUTION"),
        (0.51, True, False, "ADVISORY"),
    ],
)  # fmt: skip
def test_what_is_not_certain_is_one_hint_among_others(
    weight: float, is_animal: bool, is_told: bool, severity: str | None
) -> None:
    """0.50 of what cameras show, 0.35 for the arrival, and 0.15 if a call tells of it."""
    label = "deer" if is_animal else "truck"
    field = seen(
        Field(arrival("AAL123", 30.0)), label=label, is_animal=is_animal, is_certain=False,
        weight=weight,
    )  # fmt: skip
    if is_told:
        deer = "Tower, deer on runway zero one."
        field.hears(0.0, deer if is_animal else "Ops one, proceed on runway zero one.")
    found = field.threats(config=RunwayConfig(rules=("score",)))
    assert [each.severity for each in found] == ([] if severity is None else [severity])
    if not found:
        return
    assert found[0].sources == (("adsb", "vision", "radio") if is_told else ("adsb", "vision"))
    total = 0.5 * weight + 0.35 + 0.15 * is_told
    shares = {"vision": 0.5 * weight, "adsb": 0.35, "radio": 0.15 * is_told}
    assert found[0].shares == pytest.approx(
        {name: share / total for name, share in shares.items() if share}
    )


# --- in the air -------------------------------------------------------------------------------


def glide_m(along_m: float, to_go_s: float = 30.0) -> float:
    """Return the height of `arrival`, which touches down 400 m past the threshold."""
    return (400.0 - along_m) * 0.0524


@pytest.mark.parametrize(
    ("right_m", "up_m", "is_in_path"),
    [
        (0.0, 0.0, True), (59.0, 0.0, True), (-59.0, 0.0, True), (0.0, 39.0, True),
        (0.0, -39.0, True), (0.0, -41.0, False),
        (61.0, 0.0, False), (-61.0, 0.0, False), (0.0, 41.0, False),
    ],
)  # fmt: skip
def test_an_aircraft_that_only_cameras_show_is_met_within_60_m_beside_and_40_m_above_or_below(
    right_m: float, up_m: float, is_in_path: bool
) -> None:
    """It stands still in the air; nobody knows where it goes, but a place of several counts."""
    place = (-1000.0, right_m, glide_m(-1000.0) + up_m)
    field = aloft(Field(arrival("AAL123", 30.0)), place, are_birds=False, is_located=False)
    told = [(how, what, each) for _, how, what, each in field.obstructions()]
    path = ("airborne on final for", "unidentified aircraft", "CAUTION")
    assert told == ([path] if is_in_path else [])


@pytest.mark.parametrize(
    ("right_m", "up_m", "severity"),
    [
        (0.0, 0.0, "WARNING"), (107.0, 0.0, "WARNING"), (109.0, 0.0, "CAUTION"),
        (-107.0, 0.0, "WARNING"), (0.0, 87.0, "WARNING"), (0.0, 89.0, "CAUTION"),
        (299.0, 0.0, "CAUTION"), (301.0, 0.0, None), (-301.0, 0.0, None), (299.0, 99.0, "CAUTION"),
        (299.0, 101.0, None), (299.0, -70.0, "CAUTION"),
    ],
)  # fmt: skip
def test_birds_may_stray_until_they_are_met_and_even_beside_they_are_a_caution(
    right_m: float, up_m: float, severity: str | None
) -> None:
    """1,120 m before the arrival at 70 m/s: in 16 s they stray by 48 m."""
    field = aloft(Field(arrival("AAL123", 30.0)), (-980.0, right_m, glide_m(-980.0) + up_m))
    told = [(what, each) for _, _, what, each in field.obstructions()]
    assert told == ([("birds", severity)] if severity else [])


@pytest.mark.parametrize(
    ("right_m", "right_m_s", "is_met"),
    [(400.0, -25.0, True), (400.0, 25.0, False), (-400.0, 25.0, True), (0.0, 25.0, False)],
)
def test_birds_are_where_they_fly_to_when_the_arrival_comes(
    right_m: float, right_m_s: float, is_met: bool
) -> None:
    place = (-980.0, right_m, glide_m(-980.0))
    field = aloft(Field(arrival("AAL123", 30.0)), place, right_m_s=right_m_s)
    assert ("WARNING" in [each for *_, each in field.obstructions()]) is is_met


def test_birds_are_not_taken_to_fly_straight_on_for_a_minute() -> None:
    """They would be in the path after 58.6 s, and are 336 m beside it after 25 s."""
    place = (-100.0, 586.0, glide_m(-100.0))
    field = aloft(Field(arrival("AAL123", 60.0)), place, right_m_s=-10.0)
    assert field.obstructions() == []


@pytest.mark.parametrize(
    ("up_m", "up_m_s", "is_met"),
    [(-105.0, 1.0, True), (-105.0, 0.4, False), (-105.0, 0.0, False), (105.0, -1.0, True),
     (105.0, -0.4, False), (105.0, 0.0, False), (105.0, 1.0, False), (60.0, 1.0, True)],
)  # fmt: skip
def test_birds_may_be_anywhere_between_their_height_now_and_then(
    up_m: float, up_m_s: float, is_met: bool
) -> None:
    """They are met in 17 s, in which they stray by 51 m."""
    place = (-3000.0, 0.0, glide_m(-3000.0) + up_m)
    field = aloft(Field(arrival("AAL123", 60.0)), place, up_m_s=up_m_s)
    assert ("WARNING" in [each for *_, each in field.obstructions()]) is is_met


@pytest.mark.parametrize(
    ("along_m_s", "time_s"),
    [(0.0, 16.0), (-70.0, 8.0), (35.0, 32.0), (62.9, 1120.0 / 7.1), (63.1, None)],
)
def test_who_flies_ahead_is_met_later_and_hardly_slower_than_the_arrival_never(
    along_m_s: float, time_s: float | None
) -> None:
    field = aloft(Field(arrival("AAL123", 30.0)), (-980.0, 0.0, 70.0), along_m_s=along_m_s)
    outlook = Outlook(field.situation, CONFIG, at(0.0))
    (thing,) = field.situation.aloft
    (place,) = thing.places
    found = _time_abeam_s(outlook, field.use("AAL123"), place, along_m_s)
    assert found == (None if time_s is None else pytest.approx(time_s, rel=1e-3))


@pytest.mark.parametrize(
    ("places", "is_told"),
    [
        ([0.0, 500.0], True), ([0.0, 500.0, 500.0], True), ([0.0, *[500.0] * 3], False),
        ([0.0, 0.0, *[500.0] * 4], True), ([500.0], False), ([0.0] * 3 + [500.0] * 7, True),
    ],
)  # fmt: skip
def test_of_birds_of_unknown_distance_three_places_of_ten_must_be_in_the_path(
    places: list[float], is_told: bool
) -> None:
    spots = [(-980.0, right_m, glide_m(-980.0)) for right_m in places]
    field = aloft(Field(arrival("AAL123", 30.0)), *spots, is_located=False)
    assert [each for *_, each in field.obstructions()] == (["CAUTION"] if is_told else [])


@pytest.mark.parametrize(
    ("along_m", "height_m", "severity"),
    [(800.0, 149.0, "WARNING"), (800.0, 280.0, None), (-100.0, 50.0, None), (2110.0, 50.0, None)],
)
def test_birds_over_the_runway_are_in_the_way_of_a_departure(
    along_m: float, height_m: float, severity: str | None
) -> None:
    field = aloft(Field(report("AAL123", 300.0, 0.0, 40.0)), (along_m, 0.0, height_m))
    told = [(how, each) for _, how, _, each in field.obstructions()]
    assert told == ([("airborne over", severity)] if severity else [])


def test_birds_matter_neither_to_who_has_landed_nor_to_who_has_taken_off() -> None:
    assert aloft(Field(*landed("AAL123", 300.0, 40.0)), (800.0, 0.0, 10.0)).obstructions() == []
    climbs = report("AAL123", 500.0, 0.0, 80.0, height_m=20.0, rate_fpm=1500.0)
    assert aloft(Field(climbs), (800.0, 0.0, 30.0)).obstructions() == []


# --- two that use runways ---------------------------------------------------------------------


@pytest.mark.parametrize(
    ("first_s", "later_s", "severity"),
    [
        (30.0, 9.8, "WARNING"), (30.0, -9.8, "WARNING"), (30.0, 10.2, None), (30.0, -10.2, None),
        (35.5, 5.0, "CAUTION"), (59.5, 5.0, "CAUTION"), (60.5, 5.0, None), (45.5, -9.8, "CAUTION"),
    ],
)  # fmt: skip
def test_two_meet_at_a_crossing_within_10_s(
    first_s: float, later_s: float, severity: str | None
) -> None:
    """Both roll on from their touchdown; one of them comes to the crossing so much later."""
    pair = []
    for axis, callsign in ((NORTH, "AAL123"), (SOUTHEAST, "DAL456")):
        probe = Field(arrival(callsign, 40.0, axis=axis))
        at_s = probe.use(callsign).time_to_s(crossing_m(axis), at(0.0))
        if at_s is None:  # It stops before: it is faster then.
            pytest.skip("the landing stops before the crossing")
        wanted_s = first_s if axis is NORTH else first_s + later_s
        pair.append(arrival(callsign, 40.0 + wanted_s - at_s, axis=axis))
    told = [each for each in Field(*pair).threats() if each.rule == "meeting"]
    assert [each.severity for each in told] == ([severity] if severity else [])
    for each in told:
        assert each.parties == ("AAL123", "DAL456")
        assert each.finding.statement() == "DAL456 on crossing runway 15"
