"""The place in a text at which its instruction has been said.

Nobody can act on an instruction before the words that give it. Which words those are is read out of
the text by the phraseology, so that it does not depend on how an assistant words its messages.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import NamedTuple

from airhilt.messages import (
    CancelTakeoff,
    Climb,
    Confirm,
    GoAround,
    HoldPosition,
    MaintainLevel,
    Recommendation,
    Turn,
)
from airhilt.phraseology.call import Instruction
from airhilt.phraseology.parse import parse_call

LEVEL_TOLERANCE_FT = 100.0
"""Difference between a level that is recommended and one that is said, in ft: levels are said in
hundreds of feet."""
_WORD = re.compile(r"\S+")

Detail = tuple[str, object, object, object, object, object]


class _Details(NamedTuple):
    """Details of a recommendation that a text gives."""

    given: frozenset[Detail]
    is_addressed: bool
    """True if the text names whom it is for, and that matters."""


def instruction_end(
    text: str,
    recommendation: Recommendation | None,
    callsigns: Collection[str],
    addressed: str | None = None,
) -> int:
    """Return the number of characters after which a text has given what it recommends.

    It is the shortest beginning of the text from which the recommended action is read, with all
    values that the whole text gives for it; the whole text if the action is not read from it.

    Parameters
    ----------
    callsigns
        Callsigns that the text may name.
    addressed
        Callsign that must have been said too, if the text says it, so that its bearer knows that
        the text is for it; None in a cockpit.
    """
    if recommendation is None:
        return len(text)
    whole = _details(text, recommendation, callsigns, addressed)
    if not whole.given:
        return len(text)
    beginnings = ((end, text[:end]) for end in _ends(text))
    return next(
        (
            end
            for end, beginning in beginnings
            if _details(beginning, recommendation, callsigns, addressed) == whole
        ),
        len(text),
    )


def action_end(text: str, callsigns: Collection[str]) -> int:
    """Return the number of characters after which a text has named its first action.

    It is the length of the text if no action is read from it.
    """
    for end in _ends(text):
        if parse_call(text[:end], callsigns).instructions:
            return end
    return len(text)


def _details(
    text: str, told: Recommendation, callsigns: Collection[str], addressed: str | None
) -> _Details:
    """Return what of a recommendation a text gives."""
    call = parse_call(text, callsigns)
    given = frozenset(_detail(each) for each in call.instructions if _gives(each, told))
    return _Details(given, addressed is not None and call.callsign == addressed)


def _ends(text: str) -> Iterator[int]:
    """Yield the ends of the words of a text."""
    return (word.end() for word in _WORD.finditer(text))


def _gives(said: Instruction, told: Recommendation) -> bool:
    """Return whether an instruction is a part of what is recommended, as far as it says."""
    match told:
        case Climb(sense=sense, altitude_ft=altitude_ft):
            return (
                (said.action == "altitude" and said.sense in (None, sense))
                and _is_level(said, altitude_ft)
            ) or said.action in ("vertical_rate", "turn_by", "heading")
        case MaintainLevel(altitude_ft=altitude_ft):
            return said.action == "altitude" and _is_level(said, altitude_ft)
        case Turn():
            return said.action in ("turn_by", "heading")
        case GoAround():
            return said.action in ("go_around", "missed_approach")
        case CancelTakeoff():
            return said.action in ("cancel_takeoff", "stop")
        case HoldPosition():
            return said.action in ("hold_position", "hold_short", "stop")
        case Confirm():
            return False


def _is_level(said: Instruction, altitude_ft: float) -> bool:
    return said.altitude_ft is None or abs(said.altitude_ft - altitude_ft) <= LEVEL_TOLERANCE_FT


def _detail(said: Instruction) -> Detail:
    """Return what of an instruction a crew must have heard before it can act.

    The runway is none of it: a crew knows which one it uses.
    """
    return (
        said.action, said.sense, said.altitude_ft, said.rate_fpm, said.turn,
        said.turn_deg if said.turn_deg is not None else said.heading_deg,
    )  # fmt: skip
