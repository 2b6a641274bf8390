"""What is said on the radio, both ways: `parse_call` reads a call, the functions of `say` make one.

Both use one vocabulary; `tokens` shows the words that the reading starts from.
"""

from __future__ import annotations

from airhilt.phraseology.alphabet import LETTERS
from airhilt.phraseology.call import (
    CLEARANCES,
    REPORTS,
    Action,
    Call,
    Instruction,
    Kind,
    Sense,
    Turn,
    Wind,
)
from airhilt.phraseology.callsigns import CallsignMatch, Candidate
from airhilt.phraseology.numbers import DIGITS, Style
from airhilt.phraseology.parse import parse_call
from airhilt.phraseology.telephony import AIRLINES, TELEPHONY, Airline
from airhilt.phraseology.words import tokens

__all__ = [
    "AIRLINES",
    "CLEARANCES",
    "DIGITS",
    "LETTERS",
    "REPORTS",
    "TELEPHONY",
    "Action",
    "Airline",
    "Call",
    "CallsignMatch",
    "Candidate",
    "Instruction",
    "Kind",
    "Sense",
    "Style",
    "Turn",
    "Wind",
    "parse_call",
    "tokens",
]
