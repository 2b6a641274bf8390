"""What general recognisers write, in the form of transcripts."""

from __future__ import annotations

import pytest

from airhilt.phraseology.canonical import canonical


def written(text: str) -> str:
    return " ".join(word for word, _ in canonical((word, 1.0) for word in text.split()))


def test_a_runway_is_written_one_way(subtests: pytest.Subtests) -> None:
    table = [
        "runway 1L", "Runway 1 left,", "run way one left.", "Run-way 1-L", "RWY 1 L",
        "runway 1Left", "runway1L", "runway one L", "Runways 1 left", "runway one-left",
        "RUNWAY 1L",
    ]  # fmt: skip
    for text in table:
        with subtests.test(text):
            assert written(text) == "runway one left"


def test_a_runways_number_is_spelled(subtests: pytest.Subtests) -> None:
    for text, expected in [
        ("Runway 01", "runway zero one"),
        ("runway 19.", "runway one nine"),
        ("runway 1 9", "runway one nine"),
        ("runway 1-9 right", "runway one nine right"),
        ("runway nineteen", "runway one nine"),
        ("runway thirty six right", "runway three six right"),
        ("runway thirty-six R", "runway three six right"),
        ("runway 27 center", "runway two seven center"),
        ("runway two seven centre", "runway two seven center"),
        ("runway thirty", "runway three zero"),
        ("runway oh one", "runway zero one"),
        ("runway one niner", "runway one niner"),
        ("runway fower left", "runway fower left"),
        ("runway 22 write", "runway two two right"),
        ("hold short runway 4L at 3", "hold short runway four left at 3"),
        ("runway 19 1 mile final", "runway one nine 1 mile final"),
        ("runway 33 4 miles", "runway three three 4 miles"),
        ("runway in sight", "runway in sight"),
        ("runway 350", "runway 350"),
        ("the runway", "the runway"),
        ("cross runway 1 and runway 4 right", "cross runway one and runway four right"),
    ]:
        with subtests.test(text):
            assert written(text) == expected


def test_other_words_only_lose_their_dress(subtests: pytest.Subtests) -> None:
    for text, expected in [
        ("American 123, climb 10,000.", "american 123 climb 10000"),
        ("Contact 118.3.", "contact 118.3"),
        ("Go-around!", "go around"),
        ("X-ray", "xray"),
        ("We run late", "we run late"),
        ("run", "run"),
        ("turn right heading 190", "turn right heading 190"),
        ("... \u2026", ""),
    ]:
        with subtests.test(text):
            assert written(text) == expected


def test_words_keep_the_confidence_of_what_they_came_from() -> None:
    assert canonical([("Run", 0.9), ("way", 0.5), ("01L", 0.7), ("now", 0.6)]) == (
        ("runway", 0.5),
        ("zero", 0.7),
        ("one", 0.7),
        ("left", 0.7),
        ("now", 0.6),
    )


def test_what_is_canonical_stays_as_it_is() -> None:
    for text in ("runway zero one left cleared to land", "runway one nine line up and wait"):
        assert written(written(text)) == text
