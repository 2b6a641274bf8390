"""Phraseology: `parse_call` finds the meaning of a call, and the functions of `say` word one.

Both use the same vocabulary. `tokens` returns the words that parsing starts from.
"""

from airhilt.phraseology.alphabet import LETTERS
from airhilt.phraseology.call import (
    BESIDES,
    CLEARANCES,
    REPORTS,
    TAU_ASR,
    Action,
    Bound,
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
from airhilt.phraseology.readbacks import agree, differences
from airhilt.phraseology.speakers import Speaker, Spoken
from airhilt.phraseology.telephony import AIRLINES, TELEPHONY, Airline
from airhilt.phraseology.words import tokens
