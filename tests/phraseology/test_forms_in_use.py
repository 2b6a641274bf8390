"""The forms that controllers and pilots use are read, each with its values, and nothing else."""

from __future__ import annotations

from collections import Counter

import pytest

from airhilt.phraseology import parse_call, tokens
from airhilt.phraseology.hits import NAME
from airhilt.phraseology.speakers import speaker_of
from listed_forms import CALLED, KNOWN, all_of, by_subject, forms


@pytest.mark.parametrize("subject", by_subject())
def test_the_forms_in_use_are_read_as_they_are_meant(subject: str) -> None:
    misread = {}
    for text, _, truth in by_subject()[subject]:
        call = parse_call(text, KNOWN)
        if call.callsign != "DAL88" or all_of(call) != truth:
            misread[text] = (call.callsign, all_of(call), truth)
    assert misread == {}


def test_hardly_any_controller_is_taken_for_a_pilot_or_a_pilot_for_a_controller() -> None:
    """By the place of the callsign and the words alone."""
    taken: Counter[tuple[str, str]] = Counter()
    for text, speaker, _ in forms():
        beginning, _, rest = text.partition(CALLED)
        words = [*tokens(beginning), NAME, *tokens(rest)]
        taken[speaker, speaker_of(" ".join(words)).speaker] += 1
    said = Counter(speaker for _, speaker, _ in forms())
    assert taken["controller", "pilot"] / said["controller"] < 0.03
    assert taken["pilot", "controller"] / said["pilot"] < 0.01
