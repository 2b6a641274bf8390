"""A readback compared with the call that it answers, item by item.

Items to be read back: ICAO Doc 4444, 4.5.7.5; FAA Order JO 7110.65, 2-4-3.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

from airhilt.phraseology.call import Action, Call, Instruction

Outcome = Literal["right", "wrong", "missing"]

ITEMS = (
    "runway", "hold_short", "sense", "altitude_ft", "turn", "heading_deg", "speed_kt",
    "frequency_khz", "squawk", "approach",
)  # fmt: skip
"""Details of an instruction that are read back."""


class ItemReadBack(NamedTuple):
    """One item of an instruction, and what the readback says of it."""

    action: Action
    item: str
    """Name of the detail of `Instruction`; ``action`` for the instruction itself."""
    given: object
    read: object
    """None if it was not read back."""
    outcome: Outcome


def compare_readback(given: Call, read: Call) -> tuple[ItemReadBack, ...]:
    """Return the items of a call, each with what its readback says of it.

    A detail that the readback gives and the call does not have is not an item of the call. An
    instruction that is read back twice counts by the one that agrees best.
    """
    items: list[ItemReadBack] = []
    for told in given.instructions:
        answers = [_items(told, each) for each in read.instructions if each.action == told.action]
        best = max(answers, key=_rights) if answers else _items(told, None)
        items.extend(best)
    return tuple(items)


def _items(told: Instruction, read: Instruction | None) -> list[ItemReadBack]:
    """Return the items of one instruction."""
    if read is None:
        return [ItemReadBack(told.action, "action", told.action, None, "missing")]
    items = [ItemReadBack(told.action, "action", told.action, read.action, "right")]
    for name in ITEMS:
        given, said = getattr(told, name), getattr(read, name)
        if given is not None:
            outcome: Outcome = "missing" if said is None else "wrong"
            if said == given:
                outcome = "right"
            items.append(ItemReadBack(told.action, name, given, said, outcome))
    return items


def _rights(items: list[ItemReadBack]) -> int:
    """Return how many items are right, less those that are wrong."""
    return sum({"right": 1, "missing": 0, "wrong": -1}[each.outcome] for each in items)
