"""Curves of confidence: which words are right, and whose callsigns the rosters have."""

from __future__ import annotations

import numpy as np
import pytest

import calibrate_asr
from airhilt.assistant.asr.engines.embedded import Emission
from eval_asr import SpokenCall

SAID = "american one two three climb alfa"


def call(heard: str, posteriors: list[float], callsign: range) -> calibrate_asr.HeardCall:
    path = [
        Emission(word, posterior, at, is_callsign=at in callsign)
        for at, (word, posterior) in enumerate(zip(heard.split(), posteriors, strict=True))
    ]
    right = calibrate_asr.right_words(SAID, [each.word for each in path])
    return calibrate_asr.HeardCall(SAID, path, right)


@pytest.mark.parametrize(
    ("heard", "right"),
    [
        ("american one two tree climb alpha", [True] * 6),
        ("american one two four climb alfa", [True, True, True, False, True, True]),
        ("american two three climb bravo", [True, True, True, True, False]),
        ("", []),
    ],
)
def test_a_word_is_right_where_it_was_said_in_whatever_spelling(
    heard: str, right: list[bool]
) -> None:
    assert calibrate_asr.right_words(SAID, heard.split()) == right


def test_a_callsign_is_right_only_if_all_its_words_are() -> None:
    """Half of the callsigns have a wrong digit, whatever their likelihood; all other words are
    right where they are likely."""
    calls = [
        call(f"american one two {digit} climb alfa", [likely] * 4 + [0.9, 0.9], range(4))
        for digit in ("three", "four")
        for likely in (0.2, 0.5, 0.9)
    ] + [call("american one two three turn alfa", [0.9] * 4 + [0.1, 0.9], range(0))] * 4
    curves = calibrate_asr.curves_of(calls)
    of_callsign, of_word = curves(
        [Emission("one", 0.9, 0, is_callsign=True), Emission("climb", 0.9, 1)]
    )
    assert of_callsign == pytest.approx(0.5, abs=0.02)
    assert of_word > 0.9


def test_some_rosters_have_a_callsign_one_digit_off_instead() -> None:
    pcm = np.zeros(1, np.int16)
    calls = [SpokenCall({"callsign": f"AAL{number}"}, pcm) for number in range(100, 300)]
    rosters = [(str(each.callsign), "N54G") for each in calls]
    found = calibrate_asr.misleading(calls, rosters)
    changed = [
        (name, other) for (name, _), (other, _) in zip(rosters, found, strict=True) if other != name
    ]
    assert 0.05 < len(changed) / len(calls) < 0.15
    assert all(sum(map(str.__ne__, name, other)) == 1 for name, other in changed)
    assert all(roster[1] == "N54G" for roster in found)
