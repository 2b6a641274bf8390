"""Text from outside cannot command a terminal, hide itself or fill the screen."""

from __future__ import annotations

import pytest

from airhilt.host.text import LONGEST_LINE, MOST_CHARACTERS, readable


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("Über 5 °C – 東京", "Über 5 °C – 東京"),
        ("\x1b[31mred\x1b]0;title\x07", "�[31mred�]0;title�"),
        ("\x9b2Jcleared\x7f", "�2Jcleared�"),
        ("a\r\nb\tc\u2028d\u2029e\x85f", "a  b c d e f"),
        ("safe\u202egnp.exe\u2066x\u200b", "safe�gnp.exe�x�"),
        ("half \ud83d", "half �"),
    ],
)
def test_what_has_no_shape_is_replaced(text: str, shown: str) -> None:
    assert readable(text) == shown
    assert readable(shown) == shown


def test_a_long_text_is_cut_once() -> None:
    cut = readable("x" * 1_000_000)
    assert (len(cut), cut[-1]) == (MOST_CHARACTERS, "…")
    assert readable(cut) == cut
    assert len(readable("\x1b" * 1_000_000, LONGEST_LINE)) == LONGEST_LINE
    assert len(readable("x\x1b" * 1000, longest=None)) == 2000
