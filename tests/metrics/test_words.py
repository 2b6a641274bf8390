"""How transcripts are compared with what was said."""

from __future__ import annotations

from collections import Counter

import pytest

from airhilt.metrics.words import align, in_words, recognition, score, slots_of
from airhilt.phraseology import parse_call

ROSTER = ("AAL123", "DAL456", "N123AB")


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("Runway 01L, cleared to land.", "runway zero one left cleared to land"),
        ("Climb and maintain 11,500.", "climb and maintain one one thousand five hundred"),
        ("descend to ten thousand", "descend to 10,000"),
        ("United twenty-three thirty", "united two three three zero"),
        ("contact tower 119.1", "contact tower one one niner point one"),
        ("cleared for take off", "cleared for takeoff"),
        ("November one alpha X-ray, lineup", "november one alfa xray line up"),
        ("fife tree fower niner", "five three four nine"),
        ("FL350", "flight level three five zero"),
        ("taxi via B5", "taxi via bravo five"),
    ],
)
def test_the_same_words_are_the_same_however_they_are_written(one: str, other: str) -> None:
    assert in_words(one) == in_words(other)


def test_words_that_only_sound_alike_are_other_words() -> None:
    assert in_words("cleared two land") != in_words("cleared to land")
    assert score("cleared to land", "cleared two land", ROSTER).errors == 1


def test_texts_are_laid_side_by_side() -> None:
    stretches = align("American one two three, go around", "american two three go around now")
    assert [(one.kind, one.said, one.heard) for one in stretches] == [
        ("equal", ("american",), ("american",)),
        ("delete", ("one",), ()),
        ("equal", ("two", "three", "go", "around"), ("two", "three", "go", "around")),
        ("insert", (), ("now",)),
    ]
    assert sum(one.errors for one in stretches) == 2


def test_a_slot_with_another_value_is_missed_and_another_one_is_false() -> None:
    wrong = score(
        "American one two three, runway zero one, cleared to land",
        "american one two three runway one niner cleared to land",
        ROSTER,
    )
    assert (wrong.slots, wrong.slots_found, wrong.false_slots) == (2, 1, 1)


def test_a_callsign_is_found_as_the_roster_knows_it() -> None:
    said = "American one two three, turn left heading two seven zero"
    assert score(said, "american won two three turn left", ROSTER).has_callsign
    other = score(said, "delta four five six turn left heading two seven zero", ROSTER)
    assert (other.has_callsign, other.callsign_found) == (True, False)
    stranger = score("Speedbird nine, go around", "speedbird nine go around", ROSTER)
    assert (stranger.has_callsign, stranger.callsign_found) == (False, False)


def test_the_slots_of_a_call_are_those_of_all_its_instructions() -> None:
    call = parse_call(
        "American one two three, climb and maintain eight thousand, turn right heading zero niner "
        "zero, contact departure one one eight decimal niner five",
        ROSTER,
    )
    assert slots_of(call) == Counter(
        [("action", "altitude"), ("altitude_ft", 8000.0), ("action", "heading"),
         ("heading_deg", 90.0), ("action", "contact"), ("frequency_khz", 118_950)]
    )  # fmt: skip


def test_rates_are_over_all_words_and_not_the_mean_of_calls() -> None:
    long = score("one two three four five six seven", "one two three four five six seven", ROSTER)
    short = score("one", "two", ROSTER)
    assert recognition([long, short], None).wer == pytest.approx(1 / 8)
