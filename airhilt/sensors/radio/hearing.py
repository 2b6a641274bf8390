"""Model of how well a person with a headset understands a call in noise."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Literal

from airhilt.messages import key_chunk
from airhilt.sim.streams import stream

Outcome = Literal["understood", "misheard", "unsure", "missed"]

UNDERSTOOD_HALF_DB = 0.0
"""SNR at which half of all calls are understood. Whole everyday sentences are at -6 dB in
speech-shaped noise (Plomp and Mimpen, Audiology 18, 1979); calls have fewer clues than those, and a
radio passes 300 to 3400 Hz only: the 6 dB for that are an estimate."""
UNDERSTOOD_SLOPE_DB = 1.4
"""Scale of the logistic curve: 18 % a decibel at its middle, within the 15 to 20 % of Plomp and
Mimpen."""
NOTICED_HALF_DB = -6.0
"""SNR at which half of all calls are noticed by their addressees: an estimate. Half of those
everyday sentences come through at this ratio, and so do many callsigns."""
NOTICED_SLOPE_DB = 1.4
MISHEARD_SHARE = 0.1
"""Share of the calls noticed but not understood that are taken for something else: an estimate.
Most people know when they have not understood."""

CONFUSED_WITH = {
    "five": "nine", "fife": "niner", "nine": "five", "niner": "fife",
    "two": "three", "three": "two", "tree": "two", "one": "nine", "four": "five", "six": "eight",
    "eight": "six", "seven": "zero", "zero": "seven", "left": "right", "right": "left",
}  # fmt: skip
"""Words, and the word that each is taken for. Five and nine are the reason for "fife" and "niner"
in Annex 10 (volume II, 5.2.1.4.3); the others are estimates."""


@dataclass(frozen=True, slots=True)
class Heard:
    """Words that a listener has heard of a call, and the outcome."""

    outcome: Outcome
    text: str
    """Words that were heard, certain or not; empty if there are none."""


@dataclass(frozen=True, slots=True)
class HearingModel:
    """Draws what people hear, from a stream for each call and listener.

    Without an SNR everybody understands everything.
    """

    seed: int

    def listen(
        self, transmission: str, listener: str, text: str, snr_db: float | None, times: int = 1
    ) -> Heard:
        """Return what a listener hears of a transmission that is not blocked.

        Words that are said several times are understood if they are once.
        """
        if snr_db is None:
            return Heard("understood", text)
        draws = stream(self.seed, f"hearing/{listener}/{transmission}").random(3)
        if draws[0] < 1.0 - (1.0 - probability_understood(snr_db)) ** times:
            return Heard("understood", text)
        if draws[0] >= probability_noticed(snr_db):
            return Heard("missed", "")
        if draws[1] < MISHEARD_SHARE:
            other = _misheard(text, float(draws[2]))
            if other is not None:
                return Heard("misheard", other)
        return Heard("unsure", text)


def probability_understood(snr_db: float) -> float:
    """Return the probability that a call is understood as it was said."""
    return _logistic((snr_db - UNDERSTOOD_HALF_DB) / UNDERSTOOD_SLOPE_DB)


def probability_noticed(snr_db: float) -> float:
    """Return the probability that an addressee notices a call."""
    return _logistic((snr_db - NOTICED_HALF_DB) / NOTICED_SLOPE_DB)


def _logistic(x: float) -> float:
    return 0.5 * (1.0 + math.tanh(x / 2.0))


def _misheard(text: str, draw: float) -> str | None:
    """Return the text with one word taken for another; None if it has no such word."""
    words = [
        found for found in re.finditer(r"[A-Za-z]+", text) if found[0].lower() in CONFUSED_WITH
    ]
    if not words:
        return None
    word = words[min(int(draw * len(words)), len(words) - 1)]
    return text[: word.start()] + CONFUSED_WITH[word[0].lower()] + text[word.end() :]


def hearing_key(listener: str) -> str:
    """Return the key of what a listener has heard."""
    return f"truth/hearing/{key_chunk(listener)}"
