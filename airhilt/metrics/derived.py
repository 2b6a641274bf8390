"""Metrics of a run, or of a person at a seat, that are worked out from others in its summary."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from airhilt.messages import Severity
from airhilt.metrics.outcome import INFRINGEMENTS, SERIOUS
from airhilt.world.flight.guard import ENVELOPE_EXCEEDED, GROUND_CONTACT

Json = Mapping[str, Any]

TIME_TO_ACT_S = 12.5
"""Time from when a pilot sees other traffic until the aircraft has answered, in s: FAA AC 90-48D,
table of recognition and reaction times, with all of its parts."""


@dataclass(frozen=True)
class Derived:
    """A metric that is worked out from the content of ``summary.json``, or of a person there."""

    name: str
    type: Literal["string", "bool", "int64", "float64"]
    description: str
    value: Callable[[Json], Any]


def _nominal(summary: Json) -> bool | None:
    actors = summary.get("conflict_actors")
    return None if actors is None else not actors


def _warned(summary: Json) -> bool | None:
    if _nominal(summary) is not False:
        return None
    warning_s, end_s = summary.get("t_first_warning_s"), summary.get("t_conflict_end_s")
    return warning_s is not None and (end_s is None or warning_s <= end_s)


def _warned_in_time(summary: Json) -> bool | None:
    was_warned = _warned(summary)
    if not was_warned or summary.get("t_window_s") is None:
        return was_warned
    lead_s = summary.get("lead_before_closest_approach_s")
    return lead_s is not None and bool(lead_s >= TIME_TO_ACT_S)


def _missed(summary: Json) -> bool | None:
    outcome = summary.get("conflict_outcome")
    is_none = outcome in (None, "no_conflict") or _nominal(summary)
    return None if is_none else outcome == "missed"


def _lost(summary: Json) -> bool:
    happened = any(summary.get(name) for name in INFRINGEMENTS)
    ends = (summary.get("ended_actors") or {}).values()
    crashed = any(cause.startswith((GROUND_CONTACT, ENVELOPE_EXCEEDED)) for cause in ends)
    return happened or crashed or summary.get("runway_incursion_category") in SERIOUS


def _severities(summary: Json) -> list[Severity]:
    return [Severity(each["severity"]) for each in summary.get("advisories") or ()]


def _severity_max(summary: Json) -> str | None:
    highest = max(_severities(summary), key=lambda each: each.rank, default=None)
    return None if highest is None else highest.value


def _number_of(name: str) -> Callable[[Json], int]:
    return lambda summary: len(summary.get(name) or ())


def _sum_of(name: str) -> Callable[[Json], int]:
    return lambda summary: sum((summary.get(name) or {}).values())


def _first_detection(field: str) -> Callable[[Json], float | None]:
    def value(summary: Json) -> float | None:
        actors = summary.get("conflict_actors")
        found = [
            each
            for each in (summary.get("vision") or {}).get("first_detections") or ()
            if not actors or each["actor"] in actors
        ]
        first = min(found, key=lambda each: (each["t_s"], each["actor"]), default=None)
        return None if first is None else float(first[field])

    return value


def _earliest_of_equipment(field: str) -> Callable[[Json], float | None]:
    def value(summary: Json) -> float | None:
        times = [each.get(field) for each in summary.get("equipment") or ()]
        return min((float(each) for each in times if each is not None), default=None)

    return value


def _reactions_with(field: str) -> Callable[[Json], int]:
    return lambda person: sum(each.get(field) is not None for each in person["reactions"])


def _reactions_that(*, followed: bool) -> Callable[[Json], int]:
    return lambda person: sum(each.get("followed") is followed for each in person["reactions"])


DERIVED = (
    Derived("nominal", "bool", "the scenario declares no conflict", _nominal),
    Derived(
        "warned",
        "bool",
        "somebody was warned of the conflict before its window closed; null if the scenario "
        "declares none",
        _warned,
    ),
    Derived(
        "warned_in_time",
        "bool",
        f"somebody was warned, and at least {TIME_TO_ACT_S} s before the closest approach, or so "
        "early that the conflict window never opened; null if the scenario declares no conflict",
        _warned_in_time,
    ),
    Derived(
        "missed",
        "bool",
        "nobody was warned before the conflict window closed, and it opened or the pair came to "
        "harm; null if no conflict came about",
        _missed,
    ),
    Derived(
        "lost",
        "bool",
        "any two lost separation, came to an NMAC, collided, or came to a runway incursion of "
        "category A or B or an accident; or an aircraft hit the ground or exceeded its envelope",
        _lost,
    ),
    Derived(
        "severity_max",
        "string",
        "highest severity of any advisory; null: no advisory",
        _severity_max,
    ),
    Derived("advisories", "int64", "advisories of any severity", _number_of("advisories")),
    Derived(
        "cautions",
        "int64",
        "advisories whose highest severity is CAUTION",
        lambda summary: _severities(summary).count(Severity.CAUTION),
    ),
    Derived(
        "warnings",
        "int64",
        "advisories whose highest severity is WARNING",
        lambda summary: _severities(summary).count(Severity.WARNING),
    ),
    Derived(
        "incursions", "int64", "runway incursions of any category", _number_of("runway_incursions")
    ),
    Derived(
        "first_detection_t_s",
        "float64",
        "first detection by any camera of an actor of the conflict (t_vision); of any actor if "
        "the scenario declares no conflict",
        _first_detection("t_s"),
    ),
    Derived(
        "first_detection_range_m",
        "float64",
        "range of that detection from its camera",
        _first_detection("range_m"),
    ),
    Derived(
        "first_detection_size_px",
        "float64",
        "longest side of the true box of that detection",
        _first_detection("size_px"),
    ),
    Derived(
        "equipment_t_first_warning_s",
        "float64",
        "first alert of any equipment of the world, of CAUTION or above, about the conflict",
        _earliest_of_equipment("t_first_warning_s"),
    ),
    Derived(
        "equipment_t_first_action_s",
        "float64",
        "first of these that told somebody what to do",
        _earliest_of_equipment("t_first_action_s"),
    ),
    Derived(
        "inputs_dropped",
        "int64",
        "inputs that a newer one replaced before a worker could take them, of all workers",
        _sum_of("inputs_dropped"),
    ),
    Derived(
        "steps_missed",
        "int64",
        "steps of workers without a result for an input, such as a call about which a service has "
        "failed",
        _sum_of("steps_missed"),
    ),
    Derived(
        "messages_dropped",
        "int64",
        "messages of programs without grants that did not count: too large, too many, or lost on "
        "the way",
        _sum_of("messages_dropped"),
    ),
    Derived(
        "actors_ended", "int64", "actors that ended before the run did", _number_of("ended_actors")
    ),
)
"""The derived metrics, in the order of their columns."""
DERIVED_OF_PEOPLE = (
    Derived(
        "isa_mean",
        "float64",
        "mean of the ISA ratings; null: none was given",
        lambda person: (person.get("workload") or {}).get("isa_mean"),
    ),
    Derived(
        "reaction_times",
        "int64",
        "reaction times that were measured, of which reaction_time_s is the median",
        _reactions_with("reaction_time_s"),
    ),
    Derived(
        "advisories_seen",
        "int64",
        "revisions of advisories that the page of the seat drew",
        _reactions_with("t_seen_s"),
    ),
    Derived(
        "advisories_heard",
        "int64",
        "revisions of advisories that were audible at the seat",
        _reactions_with("t_heard_s"),
    ),
    Derived(
        "followed",
        "int64",
        "revisions of advisories whose recommendation the person followed in time",
        _reactions_that(followed=True),
    ),
    Derived(
        "not_followed",
        "int64",
        "revisions of advisories whose recommendation the person did not follow in time",
        _reactions_that(followed=False),
    ),
)
"""The derived metrics of a person at a seat, in the order of their columns."""
