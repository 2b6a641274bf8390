"""Items of the judge and instructions of the parser as facts that can be compared.

A fact has a kind of the judge's vocabulary, its values, and the part that it plays: in effect
now, conditional, expected, or information. All values count: a fact with another one is another.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from airhilt.phraseology import Call, Instruction, tokens

HPA_PER_INHG = 33.8639
"""A conventional inch of mercury (ICAO Annex 5, table 3-3)."""


@dataclass(frozen=True, slots=True)
class Fact:
    """One thing that a call says."""

    kind: str
    status: str
    values: frozenset[tuple[str, Any]] = frozenset()


# --- of the judge -----------------------------------------------------------------------------


def _nothing(_: Mapping[str, Any]) -> dict[str, Any]:
    return {}


def _named(slot: str) -> Callable[[Mapping[str, Any]], dict[str, Any]]:
    return lambda item: {slot: item["value"]}


def _words(item: Mapping[str, Any]) -> dict[str, Any]:
    return {"words": _tokens(item["value"])}


def _altitude(item: Mapping[str, Any]) -> dict[str, Any]:
    manner = item["manner"]
    return {
        "altitude_ft": _feet(item["value"], item["unit"]),
        "sense": manner if manner in ("climb", "descend") else None,
        "bound": _bound(manner),
    }


def _crossing(item: Mapping[str, Any]) -> dict[str, Any]:
    value = item["value"]
    return {
        "words": _tokens(value["fix"]),
        "bound": _bound(value["relation"]),
        "altitude_ft": _feet(value["altitude"], item["unit"]),
        "speed_kt": value.get("speed_kt"),
    }


def _frequency(item: Mapping[str, Any]) -> dict[str, Any]:
    value, manner = item["value"], item["manner"]
    is_monitored = True if manner == "monitor" else None
    if isinstance(value, str):
        return {"unit": value, "is_monitored": is_monitored}
    if not isinstance(value, dict):
        return {"frequency_khz": value, "is_monitored": is_monitored}
    if fraction := value.get("fraction"):
        return {"frequency_khz": 121_000 + int(fraction) * 100, "is_monitored": is_monitored}
    return {"unit": value["unit"], "is_monitored": is_monitored}


def _approach(item: Mapping[str, Any]) -> dict[str, Any]:
    value = item["value"] or {}
    return {name: value.get(name) for name in ("type", "runway", "variant")}


def _taxi(item: Mapping[str, Any]) -> dict[str, Any]:
    value = item["value"]
    to = value.get("to") or ""
    runway = to.removeprefix("runway ") if to.startswith("runway ") else None
    place = None if runway or not to else _tokens(to.removeprefix("the "))
    return {"runway": runway, "words": place, "via": value.get("via", "")}


def _altimeter(item: Mapping[str, Any]) -> dict[str, Any]:
    value = item["value"]
    return {"hpa": round(value * HPA_PER_INHG if item["unit"] == "inHg" else value, 1)}


def _wind(item: Mapping[str, Any]) -> dict[str, Any]:
    value = item["value"]
    if value == "calm":
        return {"direction_deg": None, "speed_kt": 0.0, "gust_kt": None}
    return {name: value.get(name) for name in ("direction_deg", "speed_kt", "gust_kt")}


def _in_circuit(item: dict[str, Any]) -> dict[str, Any]:
    """Return what an item of the kind "circuit" says by its manner: "left base", "short approach".

    Who is given the side of the circuit alone ("left traffic") enters it on its downwind leg.
    """
    manner = (item["manner"] or "").replace("_", " ").replace(" hand", "")
    manner += " traffic" if manner in ("left", "right") else ""
    if manner == "short approach":
        return {**item, "kind": "short_approach"}
    leg = manner.removeprefix("extended ").removeprefix("extend ")
    side = leg.split()[0] if leg.startswith(("left ", "right ")) else None
    leg = leg.removeprefix("left ").removeprefix("right ")
    leg = "downwind" if side and leg in ("traffic", "closed traffic") else leg
    kind = "extend" if "extend" in manner else "join" if leg in LEGS else "circuit"
    return {**item, "kind": kind, "value": {"runway": item["value"], "leg": leg, "turn": side}}


LEGS = ("downwind", "base", "final", "crosswind", "upwind", "straight in")
VALUES: dict[str, Callable[[Mapping[str, Any]], dict[str, Any]]] = {
    "altitude": _altitude,
    "crossing_restriction": _crossing,
    "climb_via": _words,
    "descend_via": _words,
    "vertical_rate": lambda item: {"rate": item["value"], "bound": _bound(item["manner"])},
    "heading": lambda item: {"heading_deg": item["value"], "turn": item["manner"]},
    "turn_by": lambda item: {"degrees": item["value"], "turn": item["manner"]},
    "present_heading": _nothing,
    "runway_heading": _nothing,
    "direct": lambda item: {"words": _tokens(item["value"]), "turn": item["manner"]},
    "own_navigation": _nothing,
    "hold": lambda item: {"words": _tokens(item["value"]), "turn": item["manner"]},
    "speed": lambda item: {"speed_kt": item["value"], "bound": _bound(item["manner"])},
    "named_speed": _words,
    "resume_speed": _words,
    "no_speed_restrictions": _nothing,
    "mach": lambda item: {"mach": item["value"], "bound": _bound(item["manner"])},
    "approach": _approach,
    "circle": _named("runway"),
    "cancel_approach": _nothing,
    "missed_approach": _nothing,
    "go_around": _nothing,
    "takeoff": _named("runway"),
    "cancel_takeoff": _nothing,
    "cancel_landing": _nothing,
    "wildlife": _named("runway"),
    "wildlife_gone": _named("runway"),
    "stop": _nothing,
    "landing": _named("runway"),
    "option": _named("runway"),
    "touch_and_go": _named("runway"),
    "stop_and_go": _named("runway"),
    "low_approach": _named("runway"),
    "line_up_and_wait": _named("runway"),
    "continue_approach": _named("runway"),
    "follow": _nothing,
    "hold_short": _named("point"),
    "hold_position": _nothing,
    "cross_runway": _named("runway"),
    "taxi": _taxi,
    "continue_taxi": _nothing,
    "backtrack": _named("runway"),
    "vacate_runway": lambda item: {"point": item["value"], "turn": item["manner"]},
    "give_way": _nothing,
    "pushback": _nothing,
    "startup": _nothing,
    "frequency": _frequency,
    "squawk": _named("code"),
    "ident": _nothing,
    "altimeter": _altimeter,
    "wind": _wind,
    "visual_separation": _nothing,
    "standby": _nothing,
    "report": _words,
    "orbit": lambda item: {"turn": item["manner"]},
    "short_approach": _nothing,
    "extend": lambda item: {"leg": item["value"]["leg"]},
    "join": lambda item: item["value"],
}
"""Values of the kinds in scope. What a parser may leave out is not among them, such as the words
of a condition, the limit of a level, and whom to follow."""
INFORMATION = ("altimeter", "wind")
"""Kinds of information in scope."""
WILDLIFE = ("wildlife", "wildlife_gone")
"""Kinds that are to be read whoever tells of them: a pilot's report too."""
TURNS = frozenset({"heading", "turn_by", "runway_heading", "direct"})
"""Kinds that wait for the take-off that is cleared in the same call."""
CLEARANCES = frozenset(
    {"takeoff", "landing", "option", "touch_and_go", "stop_and_go", "low_approach", "approach",
     "line_up_and_wait", "cross_runway", "taxi",
     "continue_taxi", "backtrack", "pushback", "startup", "proceed"}
)  # fmt: skip
"""Kinds that need a clearance."""


def facts_of_items(items: list[dict[str, Any]]) -> Iterator[tuple[Fact, str]]:
    """Yield the facts of the items in scope, each with its status in the judge's words."""
    is_on_ground = any(item["kind"] == "takeoff" and item["begins"] is None for item in items)
    for item in items:
        if item["kind"] == "rejected_takeoff":
            yield Fact("cancel_takeoff", "now"), item["status"]
            yield Fact("stop", "now"), item["status"]
        if item["kind"] == "hold_position":  # "Stop, hold position" orders one thing.
            yield Fact("stop", "now"), "report"
        if item["kind"] == "state":  # "Report speed" and "say speed" ask for one thing.
            yield _fact("report", "now", _words(item)), "report"
            yield _fact("say", "now", _asked(item["value"])), "report"
        if item["kind"] == "expedite":
            yield Fact("expedite", "now"), "report"
        item = _in_circuit(item) if item["kind"] == "circuit" else item
        read = VALUES.get(item["kind"])
        if read is None:
            continue
        status = item["status"]
        if item["kind"] in WILDLIFE:
            yield _fact(item["kind"], "now", read(item)), "information"
            continue
        said = "now" if status in ("readback", "report", "request", "withdrawn") else status
        if status == "information" and item["kind"] not in INFORMATION:
            continue
        if item["kind"] in INFORMATION:
            if status == "request":
                continue
            said = "information"
        elif item["begins"] == "expected":
            said = "expected"
        elif item["begins"] and said != "expected":
            said = "conditional"
        elif is_on_ground and item["kind"] in TURNS and said == "now":
            said = "conditional"  # Nobody turns to a heading before the take-off.
        yield _fact(item["kind"], said, read(item)), status


# --- of the parser ----------------------------------------------------------------------------

KIND_OF = {
    "cleared_to_land": "landing", "cleared_for_takeoff": "takeoff", "line_up": "line_up_and_wait",
    "cross": "cross_runway", "cleared_option": "option", "cleared_approach": "approach",
    "vacate": "vacate_runway", "push_back": "pushback", "start_up": "startup",
    "contact": "frequency", "monitor": "frequency", "stand_by": "standby",
    "hold_at": "hold", "cross_fix": "crossing_restriction",
}  # fmt: skip
"""Kinds of the judge by the parser's actions, where the words differ."""
TYPES = {"localizer": "LOC", "localizer back course": "LOC BC"}


def facts_of_call(call: Call) -> Iterator[tuple[Fact, float]]:
    """Yield the facts that the parser read, each with its confidence."""
    for each in call.instructions:
        status = "conditional" if each.is_conditional else "now"
        yield fact_of(each, status), each.confidence
    for each in call.expected:
        yield fact_of(each, "expected"), each.confidence
    if call.wind is not None:
        wind = call.wind
        blows = {
            "direction_deg": wind.direction_deg, "speed_kt": wind.speed_kt, "gust_kt": wind.gust_kt
        }  # fmt: skip
        yield _fact("wind", "information", blows), call.confidence
    if call.pressure_hpa is not None:
        pressure = {"hpa": round(call.pressure_hpa, 1)}
        yield _fact("altimeter", "information", pressure), call.confidence


_FREE = re.compile(r"(?:(?:at )?(?:pilot|your|own) (?:discretion|convenience)|when ready)$")
"""Conditions that leave it to the pilot when to begin."""


def also_right(call: Call) -> Iterator[Fact]:
    """Yield facts that are right beside those read, because truths differ in how they write them.

    A level at the pilot's discretion, or when ready, may be left at once, and what a clearance
    before departure says applies to the flight after it. Some truths have the status "now" for
    both, some have "conditional".
    """
    for each in call.instructions:
        is_free = each.action == "altitude" and _FREE.match(each.condition or "")
        if is_free or (each.condition == "after departure" and each.action != "heading"):
            yield fact_of(each, "now")


def fact_of(said: Instruction, status: str) -> Fact:
    """Return an instruction as a fact."""
    kind, approach = _kind_of(said), said.approach or ""
    of_kinds: dict[str, dict[str, Any]] = {
        "altitude": {
            "altitude_ft": said.altitude_ft,
            "sense": None if said.sense == "maintain" else said.sense,
            "bound": said.bound,
        },
        "crossing_restriction": {
            "words": _tokens(said.position),
            "bound": said.bound,
            "altitude_ft": said.altitude_ft,
            "speed_kt": said.speed_kt,
        },
        **{kind: {"words": _tokens(said.position)} for kind in ("climb_via", "descend_via")},
        "vertical_rate": {"rate": said.rate_fpm, "bound": said.bound},
        "heading": {"heading_deg": said.heading_deg, "turn": said.turn},
        "turn_by": {"degrees": said.turn_deg, "turn": said.turn},
        "speed": {"speed_kt": said.speed_kt, "bound": said.bound},
        "named_speed": {"words": _tokens(said.named)},
        "resume_speed": {"words": _tokens(said.named)},
        "mach": {"mach": said.mach, "bound": said.bound},
        "direct": {"words": _tokens(said.position), "turn": said.turn},
        "hold": {"words": _tokens(said.position), "turn": said.turn},
        "frequency": _frequency_read(said),
        "squawk": {"code": said.squawk},
        "approach": {
            "type": TYPES.get(approach, approach.upper()),
            "runway": said.runway,
            "variant": said.variant,
        },
        "taxi": {
            "runway": said.runway,
            "words": None if said.runway else _tokens(said.position),
            "via": " ".join(said.via),
        },
        "hold_short": {"point": said.runway or said.hold_short},
        "vacate_runway": {"point": said.position, "turn": said.turn},
        "report": {"words": _tokens(said.position)},
        "orbit": {"turn": said.turn},
        "say": _asked(said.position),
        "extend": {"leg": said.position},
        "join": {"runway": said.runway, "leg": said.position, "turn": said.turn},
    }
    values = of_kinds.get(kind, {})
    if kind in VALUES and not values and VALUES[kind] is not _nothing:
        values = {"runway": said.runway}
    if kind == "report" and values["words"] == ("in", "sight"):
        values["words"] = ("traffic", "in", "sight")
    return _fact(kind, status, values)


def _kind_of(said: Instruction) -> str:
    """Return the judge's kind of an instruction."""
    if said.action == "heading" and said.position:
        if said.position in ("present heading", "runway heading"):
            return said.position.replace(" ", "_")
        return "vacate_runway"  # "Turn left at K" on the ground (FAA Order JO 7110.65, 3-10-9).
    if said.action == "speed" and said.named:
        return "named_speed"
    if said.action == "taxi" and not (said.runway or said.position or said.via):
        return "continue_taxi"
    return KIND_OF.get(said.action, said.action)


def _frequency_read(said: Instruction) -> dict[str, Any]:
    is_monitored = True if said.action == "monitor" else None
    if said.frequency_khz is not None:
        return {"frequency_khz": said.frequency_khz, "is_monitored": is_monitored}
    unit = said.position.split()[-1] if said.position else None
    return {"unit": unit, "is_monitored": is_monitored}


def _asked(words: str | None) -> dict[str, Any]:
    """Return what is to be said; an assigned value is asked for as the value is."""
    return {"words": _tokens((words or "").removeprefix("assigned "))}


def _fact(kind: str, status: str, values: Mapping[str, Any]) -> Fact:
    """Return a fact whose values are those that were said."""
    said = ((name, value) for name, value in values.items() if value not in (None, "", ()))
    return Fact(kind, status, frozenset(said))


def _tokens(words: str | None) -> tuple[str, ...]:
    return tuple(tokens(words or ""))


def _feet(value: float, unit: str) -> float:
    return value * 100.0 if unit == "FL" else float(value)


def _bound(manner: str | None) -> str | None:
    """Return a bound in the same words wherever it stands."""
    return {
        "at_or_above": "or_more", "or_above": "or_more", "or_greater": "or_more",
        "at_or_below": "or_less", "or_less": "or_less",
    }.get(manner or "")  # fmt: skip
