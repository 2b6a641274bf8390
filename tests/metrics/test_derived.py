"""Metrics that are worked out from others: columns of a sweep, of a run and of a person."""

from __future__ import annotations

from typing import Any

import pytest

from airhilt.metrics.derived import DERIVED, DERIVED_OF_PEOPLE

RUN = {each.name: each.value for each in DERIVED}
PERSON = {each.name: each.value for each in DERIVED_OF_PEOPLE}
BOTH = ["AAL123", "OPS1"]


def of(name: str, **summary: Any) -> Any:
    return RUN[name](summary)


def conflict(name: str, **summary: Any) -> Any:
    return of(name, conflict_actors=BOTH, **summary)


def test_a_run_is_nominal_if_its_scenario_declares_no_conflict() -> None:
    assert of("nominal", conflict_actors=[]) is True
    assert of("nominal", conflict_actors=BOTH) is False
    assert of("nominal") is None


WARNINGS = [
    # first warning, begin and end of the window, lead: warned, in time
    (30.0, 40.0, 60.0, 20.0, True, True),
    (40.0, 30.0, 60.0, 12.5, True, True),
    (40.0, 30.0, 60.0, 12.4, True, False),
    (60.0, 30.0, 60.0, -5.0, True, False),
    (60.1, 30.0, 60.0, -5.1, False, False),
    (None, 30.0, 60.0, None, False, False),
    (40.0, 30.0, None, 20.0, True, True),
    (40.0, 30.0, None, None, True, False),
    (40.0, None, None, None, True, True),
    (None, None, None, None, False, False),
]
"""12.5 s is the time to act of FAA AC 90-48D."""


@pytest.mark.parametrize(("told_s", "begin_s", "end_s", "lead_s", "warned", "in_time"),
                         WARNINGS)  # fmt: skip
def test_a_conflict_is_warned_of_before_its_window_closes_and_in_time_12_5_s_before_it_is_closest(
    told_s: float | None, begin_s: float | None, end_s: float | None, lead_s: float | None,
    warned: bool, in_time: bool,
) -> None:  # fmt: skip
    given = {
        "t_first_warning_s": told_s, "t_window_s": begin_s, "t_conflict_end_s": end_s,
        "lead_before_closest_approach_s": lead_s,
    }  # fmt: skip
    assert conflict("warned", **given) is warned
    assert conflict("warned_in_time", **given) is in_time
    for name in ("warned", "warned_in_time"):
        assert of(name, conflict_actors=[], **given) is None
        assert of(name, **given) is None


@pytest.mark.parametrize(
    ("happened", "is_lost"),
    [
        ({"loss_of_separation": True}, True),
        ({"loss_of_separation": False, "nmac": False, "collision": False}, False),
        ({"runway_incursion_category": "B"}, True),
        ({"runway_incursion_category": "C"}, False),
    ],
)
def test_lost_is_what_an_assistant_is_there_to_prevent(
    happened: dict[str, Any], is_lost: bool
) -> None:
    assert of("lost", **happened) is is_lost


def test_advisories_are_counted_by_their_severity() -> None:
    given = {
        "advisories": [{"severity": each} for each in ("INFO", "CAUTION", "WARNING", "CAUTION")]
    }
    counts = {name: of(name, **given) for name in ("advisories", "cautions", "warnings")}
    assert counts == {"advisories": 4, "cautions": 2, "warnings": 1}
    assert of("severity_max", **given) == "WARNING"
    assert of("severity_max", advisories=[{"severity": "ADVISORY"}, {"severity": "INFO"}]) == (
        "ADVISORY"
    )
    assert of("severity_max") is None
    assert [of(name) for name in counts] == [0, 0, 0]


def test_what_happened_often_is_counted() -> None:
    assert of("incursions", runway_incursions=[{}, {}]) == 2
    assert of("actors_ended", ended_actors=[{}]) == 1
    assert of("inputs_dropped", inputs_dropped={"asr": 2, "vision": 3}) == 5
    assert of("messages_dropped", messages_dropped={"too_large": 1, "too_many": 4}) == 5
    for name in ("incursions", "actors_ended", "inputs_dropped", "messages_dropped"):
        assert of(name) == 0


def test_the_first_detection_is_that_of_an_actor_of_the_conflict() -> None:
    detections = [
        {"t_s": 5.0, "actor": "DEER1", "range_m": 100.0, "size_px": 9.0},
        {"t_s": 9.0, "actor": "OPS1", "range_m": 300.0, "size_px": 12.0},
        {"t_s": 8.0, "actor": "OPS1", "range_m": 400.0, "size_px": 11.0},
        {"t_s": 8.0, "actor": "AAL123", "range_m": 500.0, "size_px": 10.0},
    ]
    names = ("first_detection_t_s", "first_detection_range_m", "first_detection_size_px")
    given = {"vision": {"first_detections": detections}}
    assert [conflict(name, **given) for name in names] == [8.0, 500.0, 10.0]
    assert [of(name, conflict_actors=[], **given) for name in names] == [5.0, 100.0, 9.0]
    assert [of(name, **given) for name in names] == [5.0, 100.0, 9.0]
    nothing: list[dict[str, Any]] = [{}, {"vision": None}, {"vision": {"first_detections": []}}]
    for none in nothing:
        assert [conflict(name, **none) for name in names] == [None] * 3


def test_the_times_of_equipment_are_the_earliest() -> None:
    equipment = [
        {"t_first_warning_s": 12.0, "t_first_action_s": None},
        {"t_first_warning_s": 11, "t_first_action_s": 20.0},
        {},
    ]
    assert of("equipment_t_first_warning_s", equipment=equipment) == 11.0
    assert of("equipment_t_first_action_s", equipment=equipment) == 20.0
    assert of("equipment_t_first_warning_s") is None
    assert of("equipment_t_first_warning_s", equipment=[{}]) is None


def test_the_reactions_of_a_person_are_counted_by_what_is_known_of_them() -> None:
    reactions = [
        {"reaction_time_s": 0.0, "t_seen_s": 1.0, "t_heard_s": 1.5, "followed": True},
        {"reaction_time_s": None, "t_seen_s": 2.0, "t_heard_s": None, "followed": False},
        {"t_seen_s": 0.0, "followed": None},
        {"followed": False},
    ]
    person = {"reactions": reactions, "workload": {"isa_mean": 2.5}}
    assert {name: value(person) for name, value in PERSON.items()} == {
        "isa_mean": 2.5, "reaction_times": 1, "advisories_seen": 3, "advisories_heard": 1,
        "followed": 1, "not_followed": 2,
    }  # fmt: skip
    assert PERSON["isa_mean"]({"workload": None, "reactions": []}) is None
