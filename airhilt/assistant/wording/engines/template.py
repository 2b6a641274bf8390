"""Fixed sentences: who, what to do, what is wrong, and how long there is."""

from __future__ import annotations

import re

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.findings import (
    Announcement,
    Intruder,
    LevelMisread,
    LossOfSeparation,
    NotReadBack,
    Obstruction,
    Occupied,
    RecipientUnclear,
    RunwayMisread,
    Unclear,
)
from airhilt.engines import Engine
from airhilt.messages import CONTROLLER, Climb, MaintainLevel, Recommendation, Turn
from airhilt.phraseology.aloud import ADDRESS, UNKNOWN

OVER = "clear of conflict"
STANDARD_RATE_FPM = 1500.0
"""Vertical rate that is not said, in ft/min: the one that crews fly for a resolution advisory (ICAO
Annex 10, volume IV, 4.4.2.6)."""
SELF_CONTAINED = (RunwayMisread, NotReadBack, RecipientUnclear, Occupied)
"""Findings whose statement says of whom it is."""


class Template:
    """Puts the structure of an alert into fixed sentences.

    Who is to act is told first what to do, and then why, as TCAS does: nobody can act on an
    instruction before it has been said.
    """

    name = "template"

    def message(self, alert: Alert, recipient: str) -> str:
        """Return what one recipient of an alert is told."""
        return _with_unknown(_message(alert, recipient), recipient)


def _message(alert: Alert, recipient: str) -> str:
    if not alert.active:
        return OVER
    match alert.finding:
        case LossOfSeparation() as loss:
            return _loss_of_separation(alert, loss, recipient)
        case LevelMisread() as misread:
            return f"{misread.callsign} {misread.statement()}"
        case Unclear() as unclear:
            return f"confirm {unclear.statement()}, traffic {unclear.traffic}"
        case Intruder() as intruder:
            return _intruder(alert, intruder, recipient)
        case Announcement(aural=aural):
            turn = alert.recommendations.get(recipient)
            return f"{aural}, {_action(turn)}" if isinstance(turn, Turn) else aural
        case None:
            kind = f"{alert.kind.replace('_', ' ')}, {' and '.join(alert.traffic)}"
            return _on_ground(alert, recipient, alert.evidence.note or kind)
        case Obstruction() as obstruction if recipient not in (obstruction.user, CONTROLLER):
            return _on_ground(alert, recipient, obstruction.statement_of_use())
        case finding:
            return _on_ground(alert, recipient, finding.statement())


def _loss_of_separation(alert: Alert, loss: LossOfSeparation, recipient: str) -> str:
    if recipient not in loss.callsigns:
        return _with_advice(loss.statement(), alert)
    first, second = loss.callsigns
    other = second if recipient == first else first
    time_s = loss.time_to_loss_s or 0.0
    return _told(alert, recipient, f"traffic {other}, loss of separation in {time_s:.0f} s")


def _intruder(alert: Alert, intruder: Intruder, recipient: str) -> str:
    if recipient == CONTROLLER:
        when = "" if intruder.contact_s is None else f", {intruder.contact_s:.0f} s"
        return _with_advice(f"{intruder.carrier}: {intruder.statement()}{when}", alert)
    if recipient not in alert.recommendations:
        return f"{recipient} look out. {_sentence(intruder.statement())}"
    return _told(alert, recipient, intruder.statement())


def _told(alert: Alert, recipient: str, why: str) -> str:
    """Return what a recipient is to do, if anything, and why."""
    recommended = alert.recommendations.get(recipient)
    if recommended is None:
        return f"{recipient} {why}"
    return f"{recipient} {_action(recommended)}. {_sentence(why)}"


def _sentence(words: str) -> str:
    """Return words with a capital letter, unless they begin with a callsign or an icao24."""
    first = words.split(" ", 1)[0]
    return words[0].upper() + words[1:] if first.isalpha() else words


def _with_unknown(text: str, recipient: str) -> str:
    """Return a text that says of each icao24, but that of its recipient, that it is one."""

    def named(found: re.Match[str]) -> str:
        if found[0] == recipient:
            return found[0]
        begins = text[: found.start()].endswith(". ")
        return f"{UNKNOWN.capitalize() if begins else UNKNOWN} {found[0]}"

    return ADDRESS.sub(named, text)


def _with_advice(text: str, alert: Alert) -> str:
    """Return a text for the controller with what each in flight is recommended."""
    advice = "; ".join(
        f"{callsign} {_action(recommendation)}"
        for callsign, recommendation in alert.recommendations.items()
    )
    return f"{text}; {advice}" if advice else text


def _on_ground(alert: Alert, recipient: str, statement: str) -> str:
    """Return what is wrong on a runway, with the actions of those concerned."""
    left_s = alert.evidence.time_to_go_s
    when = "" if left_s is None else f", {left_s:.0f} s to go"
    if recipient == CONTROLLER:
        actions = [f"{name} {_action(each)}" for name, each in alert.recommendations.items()]
        has_subject = isinstance(alert.finding, SELF_CONTAINED)
        user = "" if has_subject or not alert.traffic else f"{alert.traffic[0]}, "
        return "; ".join([f"{user}{statement}{when}", *actions])
    told = statement.removeprefix(f"{recipient} ")
    for verb, yours in (("is ", "you are "), ("has ", "you have ")):
        if told.startswith(verb):
            told = yours + told.removeprefix(verb)
    return _told(alert, recipient, f"{told}{when}")


def _action(recommendation: Recommendation) -> str:
    match recommendation:
        case Climb(sense=sense, altitude_ft=altitude, vertical_rate_fpm=rate, turn_deg=degrees):
            turn = f"{_turn(degrees)} and " if degrees else ""
            at = "" if rate == STANDARD_RATE_FPM else f" at {rate:.0f} ft/min"
            return f"{turn}{sense} to {altitude:.0f} ft{at}"
        case MaintainLevel(altitude_ft=altitude):
            return f"maintain {altitude:.0f} ft"
        case Turn(degrees=degrees):
            return _turn(degrees)
        case _:
            return recommendation.action.replace("_", " ")


def _turn(degrees: float) -> str:
    return f"turn {'right' if degrees >= 0 else 'left'} {abs(degrees):.0f} degrees"


ENGINE = Engine(
    name="template",
    summary="fixed sentences",
    create=lambda _: Template(),
)
