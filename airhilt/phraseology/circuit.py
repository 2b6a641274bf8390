"""Forms of the traffic circuit, and of a landing on another runway than before.

FAA Order JO 7110.65, 3-8-1, 3-10-1, 3-10-6 and 4-8-7; ICAO Doc 4444, 12.3.4.13 to 15.
"""

from __future__ import annotations

import re
from typing import cast

from airhilt.phraseology.call import Action, Instruction, Turn
from airhilt.phraseology.forms import BARE_RUNWAY, Listed, Read, Segment, alone
from airhilt.phraseology.slots import RUNWAY, SIDED_RUNWAY, designator, runway_confidence

LEGS = ("downwind", "base", "final", "crosswind", "upwind")
_LEG = "|".join(LEGS)
_RUNWAY_BEHIND = re.compile(
    rf"(?: (?:for|to|on))?(?: the)?(?: circuit)? (?P<word>runway |(?={SIDED_RUNWAY})){RUNWAY}"
)

_ON_RUNWAY = frozenset({"join", "side_step", "return_to_field"})
_NOW = re.compile(r"(?:turn|start|begin)(?!\S)|make (?:your )?base")
"""First words to fly a leg from here on, rather than to enter it where it usually begins."""
_CLEARED = re.compile(r" (?:cleared|clear|line)(?!\S)")


def on_leg(segment: Segment, action: Action) -> Read | None:
    """Read a leg of the circuit, the side of its turns and its runway.

    A runway right before another action is also that of a clearance. "Make left traffic" names the
    circuit alone, which is entered on its downwind leg.
    """
    parts = segment.found.groupdict()
    runway = _RUNWAY_BEHIND.match(segment.after) if action in _ON_RUNWAY else None
    end, sure = segment.found.end(), 1.0
    if runway is not None:
        is_shared = _CLEARED.match(segment.text, end + runway.end()) is not None
        end += 0 if is_shared else runway.end()
        sure = min(runway_confidence(runway[2]), 1.0 if runway["word"] else BARE_RUNWAY)
    read = Instruction(
        action,
        designator(*runway.group(2, 3)) if runway else None,
        parts.get("leg") or ("downwind" if action == "join" else None),
        turn=cast("Turn | None", parts.get("turn") or parts.get("turn_behind")),
        immediate=action == "join" and _NOW.match(segment.found[0]) is not None,
        confidence=sure,
    )
    return Read(read, segment.start, end)


_SIDE = r"(?:(?P<turn>left|right)(?: hand)? )?"
FORMS: Listed = (
    ("make making do fly", "orbit",
     rf"(?:mak(?:e|ing)|do|fly) (?:(?:a|one|another|1) )?{_SIDE}(?:turn )?(?:a )?"
     r"(?:1?360(?: degrees?)?(?: turn(?! left| right))?|orbit)"
     r"(?: (?:to the )?(?P<turn_behind>left|right))?", on_leg),
    ("orbit orbiting", "orbit", r"orbit(?:ing)?(?: to the)?(?: (?P<turn>left|right))?", on_leg),
    ("left right", "orbit", r"(?P<turn>left|right) (?:hand )?(?:360(?= for)|orbit)", on_leg),
    ("extend extending continue", "extend",
     rf"(?:extend(?:ing)?|continue(?! on))(?: (?:your|the|on|left|right|hand))* (?P<leg>{_LEG})"
     r"(?: leg)?", on_leg),
    ("make making", "short_approach", r"mak(?:e|ing)(?: a)? short approach", alone),
    ("short", "short_approach", r"short approach approved", alone),
    ("make making join joining enter entering", "join",
     rf"(?:mak(?:e|ing)|join(?:ing)?|enter(?:ing)?)(?: (?:the|a|your))? {_SIDE}"
     rf"(?P<leg>{_LEG}|straight in)(?: (?:leg|approach))?(?: (?P<turn_behind>left|right) hand)?",
     on_leg),
    ("make making enter entering fly left right", "join",
     r"(?:(?:mak(?:e|ing)|enter(?:ing)?|fly) |(?<![0-9] ))(?P<turn>left|right)(?: hand)?"
     r"(?: closed)? (?:traffic|circuits?)(?: pattern)?(?: approved)?", on_leg),
    ("turn", "join",
     rf"turn (?:now )?(?:(?:on )?to )?(?:the |a |your )?{_SIDE}(?P<leg>{_LEG})(?: leg)?(?: now)?",
     on_leg),
    ("start begin", "join",
     rf"(?:start|begin) (?:the |a |your )?{_SIDE}(?:turn (?:on )?to )?(?P<leg>base|final)"
     r"(?: turn| leg)?(?: now)?",
     on_leg),
    ("side sidestep", "side_step", r"side ?step(?:ping)?", on_leg),
    ("return", "return_to_field",
     r"return (?:to (?:the )?(?:field|airport|aerodrome|airfield|land)|for landing)", on_leg),
)  # fmt: skip
"""Forms of the circuit."""
