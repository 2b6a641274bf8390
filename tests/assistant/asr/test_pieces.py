"""Word pieces write any word, with as few pieces as there are."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from airhilt.assistant.asr.pieces import Pieces
from paths import ROOT

LEARNT = Pieces((ROOT / "airhilt/assistant/asr/model/pieces.txt").read_text().split())
"""Pieces of tools/asr/learn_pieces.py."""
WORDS = st.text(alphabet="abcdefghijklmnopqrstuvwxyz'", min_size=1, max_size=12)


@given(st.lists(WORDS, max_size=6))
def test_any_words_are_read_back_as_they_were_split(words: list[str]) -> None:
    units = LEARNT.units(words)
    assert units is not None
    assert LEARNT.text(units) == " ".join(words)
    assert len(LEARNT.words(units)) == len(words)


def test_the_fewest_pieces_write_a_word() -> None:
    pieces = Pieces(["_a", "_ab", "b", "c", "bcd", "d", "cd"])
    assert pieces.text(pieces.split("abcd") or ()) == "abcd"
    assert pieces.split("abcd") == (2, 7)
    assert pieces.split("abc") == (2, 4)


def test_a_word_with_a_letter_that_no_piece_has_cannot_be_written() -> None:
    pieces = Pieces(["_a", "b"])
    assert pieces.split("abc") is None
    assert pieces.units(["ab", "abc"]) is None
