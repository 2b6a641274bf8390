"""TCAS II as an assistant: when it speaks, to whom, and which way it sends them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from airhilt.assistant.wording.engines.template import Template
from airhilt.cosim.equipment import equipment_worker
from airhilt.engine_families import ASSISTANTS
from airhilt.errors import AirhiltError
from airhilt.messages import Climb, MaintainLevel
from interrogation import Jet, Meeting

ONE = Jet("AAL1", "aaaaa1", 90.0, 450.0, 35_000.0)
OTHER = Jet("DAL2", "aaaaa2", 270.0, 450.0, 35_000.0)


def meeting(one: Jet, other: Jet, engine: str = "tcas", **how: Any) -> Meeting:
    return Meeting(ASSISTANTS.create(engine), (replace(one), replace(other)), **how)


CLIMBS = replace(OTHER, altitude_ft=35_000.0 - 2000.0 / 60.0 * 130.0, rate_fpm=2000.0)
SLOW = replace(ONE, speed_kt=370.0)
LOW = (
    replace(ONE, speed_kt=150.0, altitude_ft=3000.0),
    replace(OTHER, track_deg=0.0, speed_kt=150.0, altitude_ft=3000.0),
)
TABLE = {
    "head-on": (ONE, OTHER, 48.0, 35.0),
    "crossing": (ONE, replace(OTHER, track_deg=0.0), 49.0, 36.0),
    "overtaking by 80 kt": (SLOW, replace(OTHER, track_deg=90.0), 87.0, 70.0),
    "climbing through": (ONE, CLIMBS, 48.0, 34.0),
    "low crossing": (*LOW, 32.0, 22.0),
}
"""Seconds before the closest approach of TA and RA by NASA's TCAS3D (DAIDALUS 2.0.2)."""


@pytest.mark.parametrize("name", TABLE)
def test_it_speaks_when_the_published_algorithm_does(name: str) -> None:
    one, other, traffic_s, resolution_s = TABLE[name]
    flown = meeting(one, other, begin_s=-130.0).fly()
    assert flown.first_s("CAUTION") == pytest.approx(traffic_s, abs=2.0)
    assert flown.first_s("WARNING") == pytest.approx(resolution_s, abs=2.0)


@pytest.mark.parametrize("name", TABLE)
def test_the_errors_of_its_ranges_move_that_by_seconds(name: str) -> None:
    one, other, traffic_s, resolution_s = TABLE[name]
    flown = meeting(one, other, noise_m=15.24, seed=3).fly()
    assert flown.first_s("CAUTION") == pytest.approx(traffic_s, abs=8.0)
    assert flown.first_s("WARNING") == pytest.approx(resolution_s, abs=8.0)


def test_the_miss_distance_filter_holds_a_resolution_back_and_not_the_traffic_advisory() -> None:
    passes = replace(OTHER, offset_nm=3.0)
    assert meeting(ONE, passes).fly().first_s("WARNING") is not None
    filtered = meeting(ONE, passes, "tcas:hmd").fly()
    assert filtered.first_s("CAUTION") == pytest.approx(45.0, abs=2.0)
    assert filtered.first_s("WARNING") is None


def test_two_that_have_it_are_sent_opposite_ways_and_pass_with_the_separation_aimed_at() -> None:
    flown = meeting(ONE, OTHER, noise_m=15.24, obeys=lambda _: True).fly()
    first = {
        alert.recipients[0]: alert.recommendations[alert.recipients[0]]
        for _, alert in reversed(flown.told)
        if alert.recommendations
    }
    senses = {each.sense for each in first.values() if isinstance(each, Climb)}
    assert senses == {"climb", "descend"}
    assert flown.least_ft > 600.0


def test_it_gives_room_against_one_that_does_not_have_it() -> None:
    unequipped = replace(OTHER, has_tcas=False)
    flown = meeting(ONE, unequipped, obeys=lambda _: True).fly()
    assert {alert.recipients for _, alert in flown.told} == {("AAL1",)}
    assert flown.least_ft > 500.0


def test_it_does_not_cross_the_other_one_if_it_need_not() -> None:
    above = replace(ONE, altitude_ft=35_300.0)
    flown = meeting(above, replace(OTHER, has_tcas=False)).fly()
    assert "climb, climb" in flown.notes("AAL1")


def test_a_climb_towards_traffic_above_is_levelled_off() -> None:
    climbs = replace(ONE, altitude_ft=34_000.0 - 2200.0 / 60.0 * 95.0, rate_fpm=2200.0)
    flown = meeting(climbs, replace(OTHER, has_tcas=False), obeys=lambda _: True).fly()
    recommended = [alert.recommendations["AAL1"] for alert in flown.to("AAL1")
                   if alert.recommendations]  # fmt: skip
    assert isinstance(recommended[0], MaintainLevel)
    assert recommended[0].altitude_ft < 34_900.0
    assert flown.notes("AAL1")[1] == "level off, level off"


def test_once_there_is_room_enough_a_crew_is_told_to_level_off() -> None:
    flown = meeting(ONE, replace(OTHER, has_tcas=False), obeys=lambda _: True).fly()
    assert flown.notes("AAL1")[1:3] in (
        ["climb, climb", "level off, level off"],
        ["descend, descend", "level off, level off"],
    )
    assert flown.least_ft > 600.0


UP, DOWN = (-27.0, 38_000.0, 3000.0), (-27.0, 32_000.0, 3000.0)


@pytest.mark.parametrize(
    ("follows", "departs"),
    [
        (ONE, replace(OTHER, ordered=UP)),
        (ONE, replace(OTHER, ordered=UP, has_tcas=False)),
        (OTHER, replace(ONE, ordered=DOWN)),
    ],
    ids=["the higher address departs", "the other one has none", "the lower address departs"],
)
def test_a_sense_that_the_other_one_thwarts_is_reversed_once(follows: Jet, departs: Jet) -> None:
    """The lower address is sent up first; a controller sends the other one the same way."""
    flown = meeting(follows, departs, obeys=follows.callsign.__eq__).fly()
    sense, reversed_ = ("climb", "descend") if follows is ONE else ("descend", "climb")
    said = f"{reversed_}, {reversed_} now, {reversed_}, {reversed_} now"
    notes = flown.notes(follows.callsign)
    assert notes.count(said) == 1
    assert notes.index(f"{sense}, {sense}") < notes.index(said)
    assert f"{sense}, {sense}" not in notes[notes.index(said) :]
    assert flown.least_ft > 300.0


def test_nothing_is_reversed_while_the_advisory_in_force_keeps_the_two_apart() -> None:
    for other in (OTHER, replace(OTHER, has_tcas=False)):
        flown = meeting(ONE, other, obeys=ONE.callsign.__eq__).fly()
        assert not [note for note in flown.notes(ONE.callsign) if "now" in note]


def test_it_says_clear_of_conflict_once_they_are_past_each_other() -> None:
    flown = meeting(ONE, OTHER, obeys=lambda _: True).fly()
    for callsign in ("AAL1", "DAL2"):
        alerts = flown.to(callsign)
        assert [alert.active for alert in alerts] == [*[True] * (len(alerts) - 1), False]
        assert [alert.revision for alert in alerts] == list(range(len(alerts)))
        assert len({alert.id for alert in alerts}) == 1
    last_s = max(-before_s for before_s, alert in flown.told if not alert.active)
    assert 0.0 < last_s < 15.0


def test_the_message_is_what_the_crew_hears() -> None:
    alerts = meeting(ONE, OTHER, obeys=lambda _: True).fly().to("AAL1")
    words = [Template().message(alert, "AAL1") for alert in alerts]
    assert words[0] == "traffic, traffic"
    assert words[1] in ("climb, climb", "descend, descend")
    assert words[-1] == "clear of conflict"


@pytest.mark.parametrize(
    ("height_ft", "severities"), [(400.0, set()), (800.0, {"CAUTION"}), (1300.0, None)]
)
def test_near_the_ground_it_is_inhibited(height_ft: float, severities: set[str] | None) -> None:
    low = {"altitude_ft": 2000.0 + height_ft, "speed_kt": 150.0}
    told = meeting(replace(ONE, **low), replace(OTHER, **low), ground_ft=2000.0).fly().told  # type: ignore[arg-type]
    found = {str(alert.severity) for _, alert in told if alert.active}
    assert found == ({"CAUTION", "WARNING"} if severities is None else severities)


def test_an_intruder_on_the_ground_is_none() -> None:
    rolls = replace(OTHER, on_ground=True, altitude_ft=1200.0, speed_kt=120.0)
    assert meeting(replace(ONE, altitude_ft=2700.0, speed_kt=150.0), rolls).fly().told == []


def test_lost_replies_are_bridged() -> None:
    flown = meeting(ONE, replace(OTHER, silent_s=(-52.0, -47.0))).fly()
    assert flown.first_s("CAUTION") == pytest.approx(48.0, abs=2.0)


def test_traffic_of_mode_c_is_followed_by_range_and_altitude() -> None:
    flown = meeting(ONE, replace(OTHER, mode="C", has_tcas=False)).fly()
    assert flown.first_s("WARNING") == pytest.approx(35.0, abs=2.0)
    assert {alert.traffic for _, alert in flown.told} == {("AAL1",)}


def test_an_unknown_argument_is_refused() -> None:
    with pytest.raises(AirhiltError, match="expected tcas or tcas:hmd"):
        ASSISTANTS.create("tcas:all")


def test_as_equipment_its_alerts_come_before_its_next_cycle() -> None:
    """It works once a second (FAA, Introduction to TCAS II Version 7.1)."""
    described = equipment_worker("tcas:hmd").description
    assert (described.name, described.modality) == ("equipment-tcas", "equipment")
    assert described.latency is not None
    assert described.latency.sigma == 0.0
    assert 0.0 < described.latency.median_s < 1.0
