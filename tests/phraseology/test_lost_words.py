"""A word that is lost from a form in use makes no other clearance of it."""

from __future__ import annotations

from airhilt.phraseology import CLEARANCES, TAU_ASR, parse_call
from listed_forms import KNOWN, forms

LOST_UNSEEN = frozenset(
    {"not", "don't", "did", "you", "was", "that", "plan", "told", "ready", "anticipate", "once",
     "after", "behind", "when", "vehicle"}
)  # fmt: skip
"""Words whose loss nobody could tell."""


def test_a_word_that_is_lost_from_such_a_form_makes_no_other_clearance() -> None:
    """Sides and conditions apart, of which nobody could tell that they are lost."""
    for text, _, truth in forms():
        words = text.split()
        given = {" ".join(each.split()[:1]) for each in truth}
        for at in range(3, len(words)):
            if words[at] in LOST_UNSEEN:
                continue
            rest = " ".join([*words[:at], *words[at + 1 :]])
            made = {
                each.action
                for each in parse_call(rest, KNOWN).instructions
                if each.action in CLEARANCES
                and each.condition is None
                and each.confidence >= TAU_ASR
            }
            assert made <= given, rest
