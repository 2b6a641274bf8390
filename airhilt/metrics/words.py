"""The words of a call against its transcript: word errors, callsign and slots.

Words that only sound alike are not equal: "to" for "two" is an error here, though the parser mends
it. Callsigns and slots are compared as `parse_call` reads both texts.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from airhilt.metrics.summary import RecognitionStatistics
from airhilt.phraseology import DIGITS, LETTERS, Call, parse_call
from airhilt.phraseology.canonical import DIGITS as PLAIN_DIGITS
from airhilt.phraseology.canonical import canonical
from airhilt.phraseology.numbers import TEENS, TENS
from airhilt.phraseology.words import PAIRS, SPELLINGS

SLOTS = (
    "action",
    "runway",
    "altitude_ft",
    "heading_deg",
    "speed_kt",
    "frequency_khz",
    "hold_short",
)
"""Fields of `Instruction` that are compared: those that are read back (ICAO Doc 4444, 4.5.7.5.1;
FAA AIM 4-4-7 b)."""
LETTER_WORDS = {word[0]: word for word in LETTERS}
ROUND_NUMBER = re.compile(r"([1-9][0-9]?)([0-9])00")
"""An altitude such as 5000 or 11500; other numbers are spoken digit by digit."""


def in_words(text: str) -> list[str]:
    """Return the words of a text in the form in which they are compared.

    Two ways to write the same words are equal: capitals, punctuation, numbers in digits or in
    words, "niner" and "nine", "take off" and "takeoff", other spellings.
    """
    plain = (word for word, _ in canonical((chunk, 1.0) for chunk in text.split()))
    spelled = [part for word in plain for part in _spelled(word)]
    return list(_joined(_without_tens(spelled)))


def _spelled(word: str) -> Iterable[str]:
    if word in DIGITS:
        return [PLAIN_DIGITS[int(DIGITS[word])]]
    if word in SPELLINGS:
        return SPELLINGS[word]
    if word in TEENS:
        return _digits(TEENS[word])
    if not any(sign in "0123456789" for sign in word):
        return [word]
    if found := ROUND_NUMBER.fullmatch(word):
        hundreds = [*_digits(found[2]), "hundred"] if found[2] != "0" else []
        return [*_digits(found[1]), "thousand", *hundreds]
    return [part for piece in re.findall(r"[a-z]+|[0-9]|\.", word) for part in _part(piece)]


def _part(piece: str) -> Iterable[str]:
    if piece == ".":
        return ["decimal"]
    if piece in "0123456789":
        return _digits(piece)
    if piece not in SPELLINGS and len(piece) <= 2:
        return [LETTER_WORDS[letter] for letter in piece]
    return SPELLINGS.get(piece, (piece,))


def _digits(digits: str) -> list[str]:
    return [PLAIN_DIGITS[int(digit)] for digit in digits]


def _without_tens(words: Sequence[str]) -> Iterator[str]:
    for index, word in enumerate(words):
        if word not in TENS:
            yield word
            continue
        tens, zero = _digits(TENS[word])
        yield tens
        if words[index + 1 : index + 2] == [] or words[index + 1] not in PLAIN_DIGITS[1:]:
            yield zero


def _joined(words: Iterable[str]) -> Iterator[str]:
    before = ""
    for word in words:
        if PAIRS.get(before, {}).get(word) == (before + word,):
            yield before + word
            before = ""
            continue
        if before:
            yield before
        before = word
    if before:
        yield before


# --- words against words --------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Stretch:
    """Adjacent words that are equal in both texts, or all differ."""

    said: tuple[str, ...]
    heard: tuple[str, ...]

    @property
    def kind(self) -> Literal["equal", "substitute", "delete", "insert"]:
        """Kind of the difference."""
        if self.said == self.heard:
            return "equal"
        if not self.heard:
            return "delete"
        return "substitute" if self.said else "insert"

    @property
    def errors(self) -> int:
        """Number of words that are wrong, left out, or too many."""
        return 0 if self.kind == "equal" else max(len(self.said), len(self.heard))


def align(said: str, heard: str) -> tuple[Stretch, ...]:
    """Return the words of two texts side by side, with the fewest errors."""
    first, second = in_words(said), in_words(heard)
    if not first:
        return (Stretch((), tuple(second)),) if second else ()
    # Not at the top: a run without speech has nothing to compare.
    import jiwer

    (alignment,) = jiwer.process_words(" ".join(first), " ".join(second)).alignments
    return tuple(
        Stretch(
            tuple(first[chunk.ref_start_idx : chunk.ref_end_idx]),
            tuple(second[chunk.hyp_start_idx : chunk.hyp_end_idx]),
        )
        for chunk in alignment
    )


# --- meaning against meaning ----------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Score:
    """Counts of what was recognised in one call."""

    words: int
    errors: int
    has_callsign: bool
    """True if the call names a callsign that the parser knows."""
    callsign_found: bool
    slots: int
    slots_found: int
    false_slots: int


def score(said: str, heard: str, callsigns: Sequence[str]) -> Score:
    """Return the counts of a transcript against what was said."""
    stretches = align(said, heard)
    meant, taken = parse_call(said, callsigns), parse_call(heard, callsigns)
    slots, found = slots_of(meant), slots_of(taken)
    return Score(
        words=sum(len(stretch.said) for stretch in stretches),
        errors=sum(stretch.errors for stretch in stretches),
        has_callsign=meant.callsign is not None,
        callsign_found=meant.callsign is not None and taken.callsign == meant.callsign,
        slots=slots.total(),
        slots_found=(slots & found).total(),
        false_slots=(found - slots).total(),
    )


def slots_of(call: Call) -> Counter[tuple[str, object]]:
    """Return the slots of all instructions of a call with their values."""
    return Counter(
        (name, value)
        for instruction in call.instructions
        for name in SLOTS
        if (value := getattr(instruction, name)) is not None
    )


def recognition(scores: Sequence[Score], snr_db: float | None) -> RecognitionStatistics:
    """Return the statistics of several calls."""
    words = sum(one.words for one in scores)
    slots = sum(one.slots for one in scores)
    return RecognitionStatistics(
        snr_db=snr_db,
        calls=len(scores),
        words=words,
        wer=_share(sum(one.errors for one in scores), words),
        callsign_accuracy=_share(
            sum(one.callsign_found for one in scores), sum(one.has_callsign for one in scores)
        ),
        slot_accuracy=_share(sum(one.slots_found for one in scores), slots),
        false_slots=sum(one.false_slots for one in scores) if scores else None,
    )


def _share(part: int, whole: int) -> float | None:
    return part / whole if whole else None
