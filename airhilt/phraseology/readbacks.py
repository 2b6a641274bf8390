"""Instructions compared with each other, such as a readback with what it answers.

Items to be read back: ICAO Doc 4444, 4.5.7.5; FAA Order JO 7110.65, 2-4-3.
"""

from __future__ import annotations

from airhilt.phraseology.call import Instruction

ITEMS = (
    "runway", "hold_short", "sense", "altitude_ft", "rate_fpm", "turn", "heading_deg", "turn_deg",
    "speed_kt", "mach", "frequency_khz", "squawk", "approach",
)  # fmt: skip
"""Details of an instruction that a readback may not change."""


def differences(given: Instruction, read: Instruction) -> tuple[str, ...]:
    """Return the names of the details that both instructions have and that differ.

    A readback may leave out what it does not change, and may say more than the call.
    """
    return tuple(
        name
        for name in ITEMS
        if None not in (pair := (getattr(given, name), getattr(read, name))) and pair[0] != pair[1]
    )


def agree(given: Instruction, read: Instruction) -> bool:
    """Return whether two instructions have one action and do not contradict each other.

    Conditions agree if there is one on both sides or on neither: the words may differ.
    """
    return (
        given.action == read.action
        and given.is_conditional == read.is_conditional
        and not differences(given, read)
    )
