"""The spelling alphabet (ICAO Annex 10 volume II, 5.2.1.3; FAA AIM 4-2-7)."""

from __future__ import annotations

LETTERS = (
    "alfa", "bravo", "charlie", "delta", "echo", "foxtrot", "golf", "hotel", "india",
    "juliett", "kilo", "lima", "mike", "november", "oscar", "papa", "quebec", "romeo",
    "sierra", "tango", "uniform", "victor", "whiskey", "xray", "yankee", "zulu",
)  # fmt: skip
LETTER_OF = {word: word[0].upper() for word in LETTERS}
"""Letter of each word."""
LETTER_VARIANTS = {
    "alpha": "alfa", "juliet": "juliett", "whisky": "whiskey", "foxtrott": "foxtrot",
    "zebra": "zulu", "quebeck": "quebec", "seirra": "sierra", "siera": "sierra",
}  # fmt: skip
"""Other spellings by people and recognisers."""


def spell(text: str) -> list[str]:
    """Return the words of the letters of a text, and its digits as they are."""
    return [
        LETTERS[ord(sign) - ord("A")] if "A" <= sign <= "Z" else sign
        for sign in text.upper()
        if sign.isascii() and sign.isalnum()
    ]
