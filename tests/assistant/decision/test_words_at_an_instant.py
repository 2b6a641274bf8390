"""What was said of runways, and the rungs of the AIRHILT paper, at one instant."""

from __future__ import annotations

from typing import Any

import pytest

from airfield import SOUTHEAST
from airhilt.assistant.decision.findings import (
    NotReadBack,
    Obstruction,
    OpposedClearances,
    RecipientUnclear,
    RunwayMisread,
)
from airhilt.assistant.decision.guard import call_of
from airhilt.assistant.decision.paper_ladder import Ladder, PaperConfig
from airhilt.assistant.decision.threats import Threat
from airhilt.assistant.decision.visual_tracks import VisualTracks
from airhilt.messages import Severity, TransmissionOpened
from decisions import transcript
from instants import Field, arrival, at, landed, report, seen

CLEARED = "American one two three, runway zero one, cleared to land."
WRONG = "Cleared to land runway one niner, American one two three."


def said(field: Field, *rules: str) -> list[Threat]:
    return [each for each in field.threats(20.0) if each.rule in rules]


# --- what does not agree ----------------------------------------------------------------------


def test_a_wrong_readback_matters_while_another_uses_the_runway() -> None:
    quiet = Field(arrival("AAL123", 300.0)).hears(10.0, CLEARED).hears(15.0, WRONG)
    assert said(quiet, "readback_mismatch") == []
    field = Field(arrival("AAL123", 300.0), report("DAL456", 800.0))
    (told,) = said(field.hears(10.0, CLEARED).hears(15.0, WRONG), "readback_mismatch")
    assert (told.severity, told.kind, told.runway) == (
        Severity.CAUTION, "readback_mismatch", "19",
    )  # fmt: skip
    assert (told.parties, told.traffic) == (("AAL123",), ("AAL123", "DAL456"))
    assert (told.sources, told.radio_ids) == (("radio", "adsb"), ("at 10", "at 15"))
    assert isinstance(told.finding, RunwayMisread)
    assert told.finding.traffic == "DAL456"


def test_a_readback_by_another_concerns_both() -> None:
    field = Field(arrival("AAL123", 300.0), report("OPS1", 800.0, category="C2"))
    field.hears(10.0, CLEARED).hears(15.0, "Cleared to land runway zero one, Delta four five six.")
    (told,) = said(field, "recipient_ambiguity")
    assert told.parties == ("DAL456", "AAL123")
    assert told.traffic == ("DAL456", "AAL123", "OPS1")


@pytest.mark.parametrize(
    ("who", "is_active"),
    [
        (report("DAL456", 800.0), True),
        (report("DAL456", 800.0, 100.0, 5.0, turned_deg=-90.0), False),  # Before it.
        (arrival("DAL456", 50.0), True),
        (arrival("DAL456", 50.0, axis=SOUTHEAST), True),  # The runways cross.
        (report("DAL456", 800.0, 300.0), False),
    ],
)
def test_a_runway_is_active_by_who_is_on_it_or_uses_it_or_one_that_crosses_it(
    who: Any, is_active: bool
) -> None:
    field = Field(who).hears(10.0, CLEARED).hears(15.0, WRONG)
    assert bool(said(field, "readback_mismatch")) is is_active


def test_a_runway_is_active_by_a_clearance_on_to_it_too() -> None:
    for runway, is_active in (("zero one", True), ("one five", False)):
        field = Field().hears(5.0, f"Ops one, cross runway {runway}.")
        field.hears(10.0, CLEARED).hears(15.0, WRONG)
        assert bool(said(field, "readback_mismatch")) is is_active


def test_without_a_runway_any_that_is_active_counts() -> None:
    field = Field(report("DAL456", 300.0, axis=SOUTHEAST))
    field.hears(10.0, "American one two three, go around.")
    field.hears(15.0, "Going around, Ops one.")
    (told,) = said(field, "recipient_ambiguity")
    assert (told.strip.name, told.runway) == ("15/33", "15")


def test_who_does_not_read_back_to_hold_is_told_with_who_uses_the_runway() -> None:
    field = Field(arrival("AAL123", 100.0))
    opened = TransmissionOpened(id="at 10", frequency_khz=119_100, t_tx_ns=at(8.0))
    field.situation.clearances.take_opening(opened)
    field.hears(10.0, "Delta four five six, hold short runway zero one.")
    (told,) = said(field, "readback_missing")
    assert isinstance(told.finding, NotReadBack)
    assert (told.finding.callsign, told.finding.traffic) == ("DAL456", "AAL123")
    assert (told.finding.given.action, told.finding.given.runway) == ("hold_short", "01")
    assert (told.parties, told.traffic, told.runway) == (("DAL456",), ("DAL456", "AAL123"), "01")
    assert (told.severity, told.kind) == (Severity.CAUTION, "readback_mismatch")
    assert told.radio_ids == ("at 10",)
    alone = Field()
    alone.situation.clearances.take_opening(opened)
    alone.hears(10.0, "Delta four five six, hold short runway zero one.")
    assert alone.threats(20.0) == []


@pytest.mark.parametrize(
    ("second", "is_opposed"),
    [
        ("runway one niner, cleared to land", True), ("runway one niner, line up and wait", True),
        ("runway one niner, cleared for takeoff", True), ("cross runway one niner", False),
        ("runway zero one, line up and wait", False), ("runway one five, cleared to land", False),
        ("runway one? niner?, cleared to land", False), ("cleared to land", False),
    ],
)  # fmt: skip
def test_two_are_cleared_to_use_one_runway_from_both_ends(second: str, is_opposed: bool) -> None:
    field = Field().hears(5.0, "Ops one, cross runway one five.").hears(10.0, CLEARED)
    field.hears(15.0, f"Delta four five six, {second}.")
    found = said(field, "opposed_clearances")
    if not is_opposed:
        assert found == []
        return
    (told,) = found
    assert told.finding == OpposedClearances(("AAL123", "DAL456"), ("01", "19"))
    assert (told.parties, told.traffic) == (("AAL123", "DAL456"), ("AAL123", "DAL456"))
    assert (told.radio_ids, told.sources, told.runway) == (("at 10", "at 15"), ("radio",), "01")
    assert told.key == ("clearances", "01/19", "AAL123", "DAL456")


# --- the paper --------------------------------------------------------------------------------


class Paper:
    """The paper's ladder about a field."""

    def __init__(self, field: Field, **config: Any) -> None:
        self._field = field
        self._ladder = Ladder(PaperConfig(**config), VisualTracks())

    def hears(self, end_s: float, text: str, callsigns: tuple[str, ...]) -> Paper:
        given = transcript(f"at {end_s:g}", 119_100, at(end_s - 2.0), at(end_s), text)
        self._field.situation.clearances.take(call_of(given, callsigns), given)
        return self

    def threats(self, t_s: float = 0.0) -> list[Threat]:
        return list(self._ladder.threats(self._field.situation, at(t_s)).values())

    def told(self, t_s: float = 0.0) -> list[tuple[str, str]]:
        return [(each.rule, each.severity.value) for each in self.threats(t_s)]


def test_an_arrival_has_a_warning_however_far_it_is_and_others_from_8_s() -> None:
    truck = report("OPS1", 1200.0, category="C2")
    assert Paper(Field(arrival("AAL123", 100.0), truck)).told() == [("occupancy", "WARNING")]
    for before_m, is_warned in ((319.0, True), (321.0, False)):  # At 40 m/s it comes to a stop.
        field = Field(*landed("AAL123", 1200.0 - before_m, 40.0), truck)
        assert (("occupancy", "WARNING") in Paper(field).told()) is is_warned
        field = Field(*landed("AAL123", 1200.0 - before_m, 40.0), truck)
        assert (("occupancy", "WARNING") in Paper(field, time_to_go_s=8.1).told()) is True
    assert Paper(Field(truck)).told() == []
    assert Paper(Field(report("DAL456", 300.0, 0.0, 40.0))).told() == []  # It is there itself.


@pytest.mark.parametrize(
    ("how", "expected"),
    [
        ({}, ("unidentified on", "truck", ("AAL123", "unidentified"), ("AAL123",))),
        (
            {"label": "deer", "is_animal": True},
            ("animal on", "deer", ("AAL123", "wildlife"), ("AAL123",)),
        ),
    ],
)
def test_what_occupies_the_runway_is_named(how: dict[str, Any], expected: Any) -> None:
    field = seen(Field(arrival("AAL123", 100.0)), **how)
    (told,) = Paper(field, rules=("occupancy",)).threats()
    assert isinstance(told.finding, Obstruction)
    assert (told.finding.how, told.finding.what, told.traffic, told.parties) == expected
    known = Field(arrival("AAL123", 100.0), report("OPS1", 1200.0, category="C2"))
    (told,) = Paper(known).threats()
    assert isinstance(told.finding, Obstruction)
    assert (told.finding.how, told.finding.what) == ("on", "OPS1")
    assert (told.parties, told.sources) == (("AAL123", "OPS1"), ("adsb",))


@pytest.mark.parametrize(
    ("weight", "is_cleared", "uses", "severity"),
    [
        (0.99, False, False, None), (1.0, False, False, "ADVISORY"),
        (0.31, True, False, "ADVISORY"), (0.29, True, False, None),  # 0.50 and 0.35.
        (0.81, True, False, "CAUTION"), (0.71, False, True, "ADVISORY"),
        (0.69, False, True, None), (0.51, True, True, "CAUTION"), (0.49, True, True, "ADVISORY"),
    ],
)  # fmt: skip
def test_the_score_is_of_cameras_of_clearances_and_of_who_uses_the_runway(
    weight: float, is_cleared: bool, uses: bool, severity: str | None
) -> None:
    """W_A is that another is cleared on to the runway, W_C that another uses it."""
    field = Field(*([arrival("AAL123", 100.0)] if uses else []))
    if is_cleared:
        field.hears(0.0, "Delta four five six, runway zero one, line up and wait.")
    seen(field, weight=weight, is_certain=False)
    found = [each for each in Paper(field).threats() if each.rule == "score"]
    assert [each.severity.value for each in found] == ([severity] if severity else [])
    for told in found:
        users, cleared = ("AAL123",) * uses, ("DAL456",) * is_cleared
        assert told.parties == (*users, *cleared)
        assert told.traffic == (*users, *cleared, "unidentified")
        assert told.radio_ids == (("at 0",) if is_cleared else ())
        assert told.sources == ("vision", *(("radio",) * is_cleared), *(("adsb",) * uses))
    assert Paper(field, rules=("occupancy",)).told() == []


@pytest.mark.parametrize(("runway", "ident"), [("runway one niner", "19"), ("", "01")])
def test_a_call_that_may_be_for_either_of_two_is_a_caution_on_a_runway_in_use(
    runway: str, ident: str
) -> None:
    field = Field(arrival("AAL123", 100.0))
    names = ("N172SP", "N552SP", "AAL123")
    call = f"November two sierra papa, {runway} line up and wait."
    holds = f"November two sierra papa, hold short {runway}."
    assert Paper(Field()).hears(5.0, holds, names).threats(6.0) == []
    (told,) = Paper(field).hears(5.0, call, names).threats(6.0)
    assert told.runway == ident
    assert told.parties == ("N172SP", "N552SP")
    assert told.traffic == ("N172SP", "N552SP", "AAL123")
    assert isinstance(told.finding, RecipientUnclear)
    assert (told.severity, told.radio_ids) == (Severity.CAUTION, ("at 5",))
    assert told.rule == "recipient_ambiguity"


@pytest.mark.parametrize(
    ("second", "t_s", "is_open"),
    [
        (None, 125.0, True), (None, 125.1, False),
        ("November one seven two sierra papa, hold short runway zero one.", 10.0, False),
        ("American one two three, hold short runway zero one.", 10.0, True),
    ],
)  # fmt: skip
def test_it_is_open_for_two_minutes_or_until_one_of_them_is_named(
    second: str | None, t_s: float, is_open: bool
) -> None:
    names = ("N172SP", "N552SP", "AAL123")
    paper = Paper(Field(arrival("AAL123", 100.0)))
    paper.hears(5.0, "November two sierra papa, line up and wait.", names)
    if second is not None:
        paper.hears(8.0, second, names)
    assert bool(paper.threats(t_s)) is is_open


@pytest.mark.parametrize(
    ("words", "is_told"),
    [("hold position", True), ("cross runway zero one", True), ("taxi to the ramp", False),
     ("contact ground, hold short runway zero one", True)],
)  # fmt: skip
def test_only_what_is_about_a_runway_is_unclear(words: str, is_told: bool) -> None:
    names = ("N172SP", "N552SP", "AAL123")
    paper = Paper(Field(arrival("AAL123", 100.0)))
    assert bool(paper.hears(5.0, f"November two sierra papa, {words}.", names).threats(6.0)) is (
        is_told
    )


def test_where_a_rung_has_fired_the_score_stays_open_without_being_told() -> None:
    fired = Paper(seen(Field(arrival("AAL123", 100.0)), weight=1.0)).told()
    assert fired == [("occupancy", "WARNING"), ("score", "INFO")]
    alone = Field(arrival("AAL123", 100.0), report("OPS1", 300.0, axis=SOUTHEAST, category="C2"))
    assert Paper(seen(alone, weight=1.0, is_certain=False)).told() == [("score", "ADVISORY")]
