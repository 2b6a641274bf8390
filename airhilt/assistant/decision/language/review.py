"""The rules as guard over the answers of a language model.

Everything that the model wants is refused unless a rule allows it. The thresholds below are
assumptions of this project; the model may

- never lower or withhold a WARNING of the rules, and never give one itself;
- withhold or lower another alert, before it was told, only by a resolving readback of the last half
  minute, by one of those in conflict, recognised with the paper's confidence;
- raise an ADVISORY to a CAUTION by a call of one of those in it;
- add a conflict only between callsigns that are there, and only where tracks or calls show it;
- recommend only what the rules recommend to the same callsign.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from pydantic import BaseModel, ConfigDict

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.language.question import ACTIONS, KINDS, QuestionContext, Turn
from airhilt.assistant.decision.service_messages import AssistantRequest
from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.relative_motion import Minima, relative, time_to_loss_s
from airhilt.messages import CONTROLLER, AdvisoryKind, Evidence, Recommendation, Rejection, Severity
from airhilt.phraseology import TAU_ASR, Action
from airhilt.units import FOOT, MILLISECOND_NS, NAUTICAL_MILE

RESOLVING: frozenset[Action] = frozenset(
    {"go_around", "hold_short", "hold_position", "cancel_takeoff", "cancel_landing", "vacate",
     "altitude", "heading", "stop"}
)  # fmt: skip
"""Actions by which a conflict may be resolved."""
RESOLVED_MS = 30_000
"""Age up to which a readback may resolve a conflict that is new, in ms."""
NEAR = 1.5
"""Multiple of the separation minima: two tracks that stay farther apart are in no conflict."""
LOOK_AHEAD_S = 180.0
"""Time within which they must do so, in s: that of the rules' ADVISORY."""
ANSWERED_MS = 30_000
"""Longest time from an instruction to its readback, in ms: that of the rules."""


class _Answered(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Judgement(_Answered):
    """Judgement of the model about an alert of the rules."""

    alert: str
    severity: Severity
    radio: tuple[str, ...] = ()


class Recommended(_Answered):
    """An action that the model recommends."""

    callsign: str
    action: str


class OwnAdvisory(_Answered):
    """A conflict that the model sees and the rules do not."""

    kind: AdvisoryKind
    severity: Severity
    traffic: tuple[str, ...]
    recipients: tuple[str, ...]
    runway: str = ""
    actions: tuple[Recommended, ...] = ()
    radio: tuple[str, ...] = ()


class Answer(_Answered):
    """The answer of the model."""

    judgements: tuple[Judgement, ...] = ()
    advisories: tuple[OwnAdvisory, ...] = ()


@dataclass(frozen=True)
class Reviewed:
    """Part of an answer that the rules accept."""

    severities: Mapping[str, Severity]
    """Severity of alerts of the rules, by their ids, as the model judges them."""
    advisories: tuple[Alert, ...]
    """Alerts of the model's own."""
    rejections: tuple[Rejection, ...]


def review(
    answer: Answer,
    situation: QuestionContext,
    runway_of: Callable[[str], str | None],
) -> Reviewed:
    """Return what the rules accept of an answer, and why not the rest.

    Parameters
    ----------
    runway_of
        Returns the runway that a callsign uses; None if it uses none.
    """
    severities: dict[str, Severity] = {}
    own: dict[str, Alert] = {}
    rejections: list[Rejection] = []
    for judgement in answer.judgements:
        if why := _against_judgement(judgement, situation):
            rejections.append(_rejection(judgement.alert, judgement, why))
        else:
            severities[judgement.alert] = judgement.severity
    for advisory in answer.advisories:
        subject = f"{advisory.kind} of {', '.join(advisory.traffic) or 'nobody'}"
        if why := _against_advisory(advisory, situation, runway_of):
            rejections.append(_rejection(subject, advisory, why))
        else:
            alert = _alert(advisory, situation)
            own[alert.id] = alert
    return Reviewed(severities, tuple(own.values()), tuple(rejections))


def judged(alert: Alert, severity: Severity) -> Alert:
    """Return an alert of the rules with the severity that the model gives it."""
    rules = (*alert.evidence.rules, "language model")
    return replace(
        alert, severity=severity, evidence=alert.evidence.model_copy(update={"rules": rules})
    )


def _against_judgement(judgement: Judgement, situation: QuestionContext) -> str:
    alert = situation.alerts.get(judgement.alert)
    if alert is None:
        return "the rules have no such alert"
    if alert.severity is Severity.WARNING:
        return "" if judgement.severity is Severity.WARNING else "a WARNING of the rules stands"
    if alert.kind == "clarification":
        return "a question for a confirmation stands"
    turns = [situation.turns.get(name) for name in judgement.radio]
    cited = [turn for turn in turns if turn is not None and turn.callsign in alert.traffic]
    if judgement.severity.rank > alert.severity.rank:
        if judgement.severity is Severity.WARNING:
            return "only the rules give a WARNING"
        return "" if cited else "it names no call by or to one of those in conflict"
    if judgement.severity.rank == alert.severity.rank:
        return ""
    if any(_resolves(turn, situation.request.ts_ms) for turn in cited):
        return ""
    return "it names no readback of the last half minute that resolves the conflict"


def _resolves(turn: Turn, now_ms: int) -> bool:
    confidence = min(turn.call.confidence, turn.turn.confidence)
    is_recent = now_ms - turn.turn.end_ms <= RESOLVED_MS
    actions = {each.action for each in turn.call.instructions}
    resolves = turn.call.kind == "readback" and not RESOLVING.isdisjoint(actions)
    return is_recent and resolves and confidence >= TAU_ASR


def _against_advisory(
    advisory: OwnAdvisory, situation: QuestionContext, runway_of: Callable[[str], str | None]
) -> str:
    traffic = set(advisory.traffic)
    unknown = sorted((traffic | set(advisory.recipients)) - {CONTROLLER} - set(situation.callsigns))
    if unknown:
        return f"nobody is called {', '.join(unknown)}"
    if advisory.runway and advisory.runway not in situation.runways:
        return f"there is no runway {advisory.runway}"
    if advisory.kind not in KINDS:
        return f"it is no {' or '.join(KINDS)}"
    if advisory.severity not in (Severity.ADVISORY, Severity.CAUTION):
        return "only the rules give a WARNING, and INFO tells nothing"
    if len(traffic) < 2 or len(traffic) < len(advisory.traffic):
        return "a conflict is between two"
    if not advisory.recipients or not set(advisory.recipients) <= traffic | {CONTROLLER}:
        return "its recipients are not those in conflict"
    if any(traffic <= set(alert.traffic) for alert in situation.alerts.values()):
        return "the rules tell of these already"
    return _against_actions(advisory, situation) or _unsupported(advisory, situation, runway_of)


def _against_actions(advisory: OwnAdvisory, situation: QuestionContext) -> str:
    """Return which action the rules do not recommend; empty if they recommend all."""
    for each in advisory.actions:
        ruled = _ruled(each.callsign, situation)
        if ruled is None or ruled.action != each.action or each.action not in ACTIONS:
            what = "nothing" if ruled is None else ruled.action
            return f"it recommends {each.action} to {each.callsign}, the rules {what}"
        if each.callsign not in advisory.recipients:
            return f"it recommends something to {each.callsign}, who is no recipient"
    return ""


def _unsupported(
    advisory: OwnAdvisory, situation: QuestionContext, runway_of: Callable[[str], str | None]
) -> str:
    """Return what does not show the conflict; empty if tracks or calls show it."""
    traffic = set(advisory.traffic)
    if advisory.kind == "loss_of_separation":
        is_near = is_airborne_conflict(advisory.traffic, situation.request)
        return "" if is_near else "their tracks do not come near each other"
    cited = [
        turn
        for name in advisory.radio
        if (turn := situation.turns.get(name)) is not None and turn.callsign in traffic
    ]
    if not advisory.runway:
        return "it names no runway"
    if all(runway_of(each) != advisory.runway for each in traffic):
        return f"none of them uses runway {advisory.runway}"
    if advisory.kind == "readback_mismatch":
        is_misread = misread_turns(cited)
        return "" if is_misread else "it names no instruction that was read back differently"
    named = {
        turn.callsign
        for turn in cited
        if any(each.runway == advisory.runway for each in turn.call.instructions)
    }
    on_runway = {each for each in traffic if runway_of(each) == advisory.runway}
    missing = sorted(traffic - named - on_runway)
    return f"nothing shows {', '.join(missing)} on runway {advisory.runway}" if missing else ""


def _ruled(callsign: str, situation: QuestionContext) -> Recommendation | None:
    """Return what the rules recommend to a callsign; None if they recommend nothing."""
    for alert in situation.alerts.values():
        if callsign in alert.recommendations:
            return alert.recommendations[callsign]
    return None


def _alert(advisory: OwnAdvisory, situation: QuestionContext) -> Alert:
    traffic = tuple(sorted(advisory.traffic))
    what = advisory.kind.replace("_", " ")
    where = f" on runway {advisory.runway}" if advisory.runway else ""
    cited = [situation.turns[name] for name in advisory.radio if name in situation.turns]
    recommendations = {
        each.callsign: ruled
        for each in advisory.actions
        if (ruled := _ruled(each.callsign, situation)) is not None
    }
    return Alert(
        id=f"llm-{advisory.kind}-{'-'.join(traffic)}",
        revision=0,
        kind=advisory.kind,
        severity=advisory.severity,
        recipients=tuple(dict.fromkeys(advisory.recipients)),
        traffic=traffic,
        evidence=Evidence(
            sources=("radio", "adsb") if cited else ("adsb",),
            runway=advisory.runway or None,
            note=f"possible {what}{where}, {' and '.join(traffic)}",
            radio_ids=tuple(turn.turn.turn_id for turn in cited),
            rules=("language model",),
        ),
        recommendations=recommendations,
    )


def _rejection(subject: str, answered: BaseModel, reason: str) -> Rejection:
    return Rejection(subject=subject, answered=answered.model_dump_json(), reason=reason)


def is_airborne_conflict(traffic: Sequence[str], request: AssistantRequest) -> bool:
    """Return whether two of some aircraft come near each other, if they fly on as they do."""
    if request.context is None:
        return False
    near = Minima(
        NEAR * request.context.horizontal_separation_nm * NAUTICAL_MILE,
        NEAR * request.context.vertical_separation_ft * FOOT,
    )
    now_ns = request.ts_ms * MILLISECOND_NS
    flying = [
        Track.of(each, each.altitude_ft, each.ts_ms * MILLISECOND_NS).at(now_ns)
        for each in request.tracks
        if (each.callsign or each.icao24) in traffic
        and each.altitude_ft is not None
        and not each.on_ground
    ]
    meetings_s = [
        time_to_loss_s(relative(first, second), first.profile(), second.profile(), near)
        for first, second in itertools.combinations(flying, 2)
    ]
    is_near = any(each is not None and each <= LOOK_AHEAD_S for each in meetings_s)
    return is_near and len(flying) == len(set(traffic))


def misread_turns(turns: Sequence[Turn]) -> bool:
    """Return whether one of some calls reads another one back differently, or for another."""
    given = [turn for turn in turns if turn.call.addressed_first]
    read = [turn for turn in turns if not turn.call.addressed_first]
    return any(
        0 < answer.turn.ts_ms - call.turn.ts_ms <= ANSWERED_MS
        and (
            answer.callsign != call.callsign
            or set(answer.call.instructions).isdisjoint(call.call.instructions)
        )
        for call in given
        for answer in read
    )
