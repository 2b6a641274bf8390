"""The question to a language model that decides: the situation in compact JSON, and its schema.

Radio calls are given as the phraseology understands them, never in their words. So nobody can give
the model instructions by radio: a call that means nothing to the phraseology is left out.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.service_messages import AssistantRequest, RadioTurn
from airhilt.assistant.decision.slices import SECOND_MS
from airhilt.messages import CONTROLLER, Severity
from airhilt.phraseology import Call, Instruction, parse_call

MOST_TURNS = 12
"""Number of calls that are given, the last ones."""
MOST_TRACKS = 20
MOST_ADVISORIES = 4
"""Largest number of advisories of the model's own in one answer."""
INSTRUCTIONS = (
    "You assist pilots and air traffic controllers. You are given JSON: what was said on the radio "
    "as understood (by whom or to whom, its kind, its actions), ADS-B tracks, runways, and the "
    "alerts of fixed rules. Answer with JSON. `judgements`: alerts of the rules whose severity is "
    "wrong, with the radio calls that show it. An alert is withheld by severity INFO, because a "
    "readback of the last half minute resolves the conflict. `advisories`: conflicts that the "
    "rules have missed, with the callsigns concerned and the calls that show them. `actions` are "
    "those of the rules only. If the rules are right, both lists are empty."
)


class Turn(NamedTuple):
    """One call, as the phraseology understands it."""

    name: str
    """Name of the call in the question, which says nothing about it."""
    turn: RadioTurn
    call: Call
    callsign: str
    """Callsign that is called, or that speaks."""


@dataclass(frozen=True)
class QuestionContext:
    """Situation as a language model is given it."""

    request: AssistantRequest
    callsigns: tuple[str, ...]
    """All who may be concerned."""
    runways: tuple[str, ...]
    """Designators of the airport's runways."""
    turns: Mapping[str, Turn]
    """Calls by their names."""
    alerts: Mapping[str, Alert]
    """Alerts of the rules that are open, by their ids."""

    @classmethod
    def of(
        cls, request: AssistantRequest, callsigns: tuple[str, ...], alerts: Mapping[str, Alert]
    ) -> QuestionContext:
        """Return the situation of some slices, and of the open alerts of the rules."""
        airport = request.context.airport if request.context else None
        runways = tuple(each.ident for each in airport.runways) if airport else ()
        return cls(request, callsigns, runways, _turns(request, callsigns), alerts)

    def question(self) -> str:
        """Return the situation as JSON."""
        now_ms = self.request.ts_ms
        document = {
            "t_s": round(now_ms / SECOND_MS),
            "runways": self.runways,
            "radio": [_said(each, now_ms) for each in self.turns.values()],
            "tracks": [
                {
                    "callsign": track.callsign or track.icao24,
                    "latitude_deg": round(track.latitude_deg, 4),
                    "longitude_deg": round(track.longitude_deg, 4),
                    "altitude_ft": track.altitude_ft,
                    "speed_kt": round(track.ground_speed_kt),
                    "track_deg": round(track.track_deg),
                    "climb_fpm": round(track.vertical_rate_fpm),
                }
                for track in self.request.tracks[:MOST_TRACKS]
            ],
            "rules": [_ruled(each) for each in self.alerts.values()],
        }
        return json.dumps(document, separators=(",", ":"))

    def schema(self) -> dict[str, Any]:
        """Return the JSON schema of the answer: it can name only what is known."""
        names = {"type": "string", "enum": list(self.callsigns)}
        parts: dict[str, Any] = {"advisories": _several(self._advisory(names), MOST_ADVISORIES)}
        if self.alerts:
            ids = {"type": "string", "enum": list(self.alerts)}
            judgement = {"alert": ids, "severity": _SEVERITY, **self._radio()}
            parts["judgements"] = _several(_object(judgement), len(self.alerts))
        return _object(parts)

    def _advisory(self, names: Mapping[str, Any]) -> dict[str, Any]:
        told = {"type": "string", "enum": [*self.callsigns, CONTROLLER]}
        runway = {"type": "string", "enum": [*self.runways, ""]}
        return _object(
            {
                "kind": {"type": "string", "enum": list(KINDS)},
                "severity": _SEVERITY,
                "traffic": _several(names, 3),
                "recipients": _several(told, 4),
                "runway": runway,
                "actions": _several(_object({"callsign": names, "action": _ACTION}), 3),
                **self._radio(),
            }
        )

    def _radio(self) -> dict[str, Any]:
        if not self.turns:
            return {}
        return {"radio": _several({"type": "string", "enum": list(self.turns)}, 4)}


KINDS = ("loss_of_separation", "readback_mismatch", "runway_conflict")
"""Kinds of conflict that the model may tell of."""
ACTIONS = ("altitude", "turn", "maintain", "go_around", "cancel_takeoff", "hold_position")
_SEVERITY: Mapping[str, Any] = {"type": "string", "enum": [each.value for each in Severity]}
_ACTION: Mapping[str, Any] = {"type": "string", "enum": list(ACTIONS)}


def _object(properties: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": dict(properties),
        "required": list(properties),
        "additionalProperties": False,
    }


def _several(items: Mapping[str, Any], most: int) -> dict[str, Any]:
    return {"type": "array", "items": dict(items), "maxItems": most}


def _turns(request: AssistantRequest, callsigns: tuple[str, ...]) -> dict[str, Turn]:
    """Return the last calls that the phraseology understands, by names of their own."""
    understood: list[tuple[RadioTurn, Call, str]] = []
    for turn in request.radio:
        confidences = [word.confidence for word in turn.words]
        text = " ".join(word.text for word in turn.words) if confidences else turn.text
        call = parse_call(text, callsigns, confidences or None)
        if call.callsign is not None and call.instructions:
            understood.append((turn, call, call.callsign))
    return {
        f"r{number}": Turn(f"r{number}", *each)
        for number, each in enumerate(understood[-MOST_TURNS:], start=1)
    }


def _said(turn: Turn, now_ms: int) -> dict[str, Any]:
    return {
        "id": turn.name,
        "age_s": round((now_ms - turn.turn.ts_ms) / SECOND_MS),
        ("to" if turn.call.addressed_first else "by"): turn.callsign,
        "kind": turn.call.kind,
        "says": [_action(each) for each in turn.call.instructions],
        "confidence": round(min(turn.call.confidence, turn.turn.confidence), 2),
    }


def _action(instruction: Instruction) -> str:
    level = "" if instruction.altitude_ft is None else f"{instruction.altitude_ft:.0f} ft"
    parts = (instruction.action, instruction.runway, instruction.sense, level)
    return " ".join(part for part in parts if part)


def _ruled(alert: Alert) -> dict[str, Any]:
    evidence = alert.evidence
    left_s = evidence.time_to_loss_s if evidence.time_to_go_s is None else evidence.time_to_go_s
    return {
        "id": alert.id,
        "kind": alert.kind,
        "severity": alert.severity,
        "traffic": alert.traffic,
        "runway": evidence.runway,
        "time_left_s": None if left_s is None else round(left_s),
        "actions": {name: each.action for name, each in alert.recommendations.items()},
    }
