"""Words of a call that may be a callsign."""

from __future__ import annotations

from typing import NamedTuple

from airhilt.phraseology.aircraft_names import MAKERS
from airhilt.phraseology.alphabet import LETTER_OF
from airhilt.phraseology.numbers import SOUNDS
from airhilt.phraseology.spoken_forms import ABBREVIATED
from airhilt.phraseology.words import UNITS

NAME = "|"
"""Placeholder for the callsign of the call."""
WAKE = frozenset({"heavy", "super"})
"""Words after the callsign of a large aircraft (ICAO Doc 4444, 4.9.2; FAA Order JO 7110.65,
2-4-15)."""
STATIONS = frozenset(
    {"tower", "ground", "approach", "departure", "centre", "radar", "control", "radio",
     "delivery", "clearance", "arrival", "director", "final", "information", "apron", "ramp"}
)  # fmt: skip
"""Last words of the name of a unit (ICAO Annex 10 volume II, 5.2.1.7.1.2)."""
SPOKEN_OF = frozenset(
    {"follow", "following", "behind", "after", "departing", "passing", "turbulence"}
)
"""Words before the callsign of somebody else."""
CONTINUED = 0.7
"""Factor for a callsign that is followed by a letter, which may belong to another callsign."""
_OF_OTHERS = MAKERS | {"the", "a", "an", "landing", "heavy", "from"}
"""Words that may stand between one of `SPOKEN_OF` and a callsign."""
_UNIT = tuple([unit] for unit in UNITS)
_SIDES = (["left"], ["right"], ["centre"])
_CLEARED = (["cleared"], ["clear"], ["line"])


class Hit(NamedTuple):
    """Words of a call that may be a callsign."""

    start: int
    end: int
    score: float
    callsign: str
    left_over: str = ""
    """Digits of the last word that do not belong to the callsign."""
    before: str = ""
    """Digits of the first word that do not belong to it."""
    is_mended: bool = False


def read(
    words: list[str], start: int, at: int, signs: str, callsign: str, worth: float
) -> Hit | None:
    """Return the hit if the words from ``at`` on are these signs."""
    done, size, left_over = 0, len(signs), ""
    is_mended = False
    while done < size:
        if at == len(words):
            return None
        word = words[at]
        rest = signs[done:]
        if word[0].isdigit():
            if rest.startswith(word):
                done += len(word)
            elif (
                rest.isdigit()
                and word.startswith(rest)
                and (words[at + 1 : at + 2] in _UNIT or _is_runway(word[len(rest) :], words, at))
            ):
                done, left_over = size, word[len(rest) :]
                worth *= ABBREVIATED
            else:
                return None
        elif LETTER_OF.get(word) == rest[0]:
            done += 1
        elif len(word) <= 3 and rest.startswith(word.upper()):
            done += len(word)
        elif SOUNDS.get(word) == rest[0]:
            done += 1
            is_mended = True
        else:
            return None
        at += 1
    if at < len(words) and words[at] in LETTER_OF and size:
        if signs[-1].isalpha():
            return None
        worth *= CONTINUED
    if at < len(words) and words[at] in WAKE:
        at += 1
    return Hit(start, at, worth, callsign, left_over, "", is_mended)


def _is_runway(number: str, words: list[str], at: int) -> bool:
    """Return whether digits behind a callsign are a runway: its side and its clearance follow."""
    return (
        words[at + 1 : at + 2] in _SIDES
        and words[at + 2 : at + 3] in _CLEARED
        and number.isdigit()
        and len(number) <= 2
        and 1 <= int(number) <= 36
    )


def is_spoken_of(words: list[str], start: int, end: int) -> bool:
    """Return whether words that may be a callsign name somebody else, by the words before them.

    "Flight following" is a service. At the end of a call the speaker's own callsign may follow
    "traffic departing" or a repeated "behind".
    """
    at = start - 1
    while at > 0 and words[at] in _OF_OTHERS:
        at -= 1
    if at < 0 or words[at] not in SPOKEN_OF:
        return False
    if words[max(at - 1, 0) : at + 1] == ["flight", "following"]:
        return False
    if end < len(words):
        return True
    if words[start - 1] in MAKERS and words[start].isalpha() and words[start] not in LETTER_OF:
        return False  # No maker's name stands before that of an airline.
    if at > 0 and words[at] in ("follow", "following") and words[at - 1] in ("will", "we"):
        return False
    is_again = words[at] in ("behind", "after") and words[at] in words[:at]
    return not is_again and words[max(at - 1, 0) : at + 1] != ["traffic", "departing"]
