"""Calls of the judge are reproducible and complete, and say the values that their truth holds."""

from __future__ import annotations

import json
import random
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

import phraseology_judge
from phraseology_judge.calls import corpus
from phraseology_judge.degrade import Similar, degraded, distance, sound
from phraseology_judge.model import Call, Item
from phraseology_judge.spoken_numbers import Speller, Style, group, run_together
from phraseology_judge.vocabulary import BY_HAND, KINDS

WORDS = (
    ("zero", 0), ("one", 1), ("two", 2), ("three", 3), ("tree", 3), ("four", 4), ("fower", 4),
    ("five", 5), ("fife", 5), ("six", 6), ("seven", 7), ("eight", 8), ("nine", 9), ("niner", 9),
    ("ten", 10), ("eleven", 11), ("twelve", 12), ("thirteen", 13), ("fourteen", 14),
    ("fifteen", 15), ("sixteen", 16), ("seventeen", 17), ("eighteen", 18), ("nineteen", 19),
)  # fmt: skip
UNITS = dict(WORDS)
TENS = {
    "twenty": 20, "thirty": 30, "forty": 40, "fifty": 50, "sixty": 60, "seventy": 70,
    "eighty": 80, "ninety": 90,
}  # fmt: skip
HESITATIONS = {"uh", "um", "er", "ah", "and", "point", "decimal"}
NUMERIC = {"altitude", "heading", "speed", "squawk", "altitude_passing", "turn_by", "vertical_rate"}


THOUSAND_AND = re.compile(
    r"thousand ((?:uh |um |er |ah |and )*\w+ (?:(?:uh|um|er|ah|and) )*)hundred"
)
"""Hundreds that belong to the thousands before them."""


def read(text: str) -> list[str]:
    """Return the digits of each run of number words: "ten five thousand" is "105000"."""
    runs, run, before = [], "", ""
    for word in [*THOUSAND_AND.sub(r"thousands \1hundreds", text).split(), "end"]:
        if word in UNITS:
            follows = before in TENS and 0 < UNITS[word] < 10
            run = (run[:-1] if follows else run) + str(UNITS[word])
        elif word in TENS:
            run += str(TENS[word])
        elif word in {"hundred", "hundreds", "thousand"}:
            run += "000" if word == "thousand" else "00"
        elif word not in HESITATIONS | {"thousands"}:
            runs += [run] if run else []
            run = ""
        before = before if word in HESITATIONS else word
    return runs


@cache
def calls(seed: int = 7) -> tuple[Call, ...]:
    return tuple(corpus(seed, 1000))


def items(kinds: set[str]) -> Iterator[tuple[Call, Item]]:
    for call in calls():
        yield from ((call, item) for item in call.items if item.kind in kinds)


def test_a_seed_gives_the_same_calls_and_another_gives_others() -> None:
    assert tuple(corpus(7, 200)) == calls()[:200]
    assert tuple(corpus(8, 200)) != calls()[:200]


@pytest.mark.parametrize("seed", [7, 8, 9])
def test_a_thousand_calls_have_every_kind_of_item_and_no_other(seed: int) -> None:
    assert {item.kind for call in calls(seed) for item in call.items} == set(KINDS) - BY_HAND


def test_numbers_that_run_together_are_found() -> None:
    assert run_together("heading two twenty", "five three six")
    assert run_together("two thousand", "one hundred on the heading")
    assert not run_together("heading two two zero", "five three six")


def test_every_status_and_both_speakers_occur() -> None:
    statuses = {item.status for call in calls() for item in call.items}
    assert statuses == {
        "now", "conditional", "expected", "readback", "request", "report", "information",
        "withdrawn",
    }  # fmt: skip
    assert {call.speaker for call in calls()} == {"controller", "pilot"}


@pytest.mark.parametrize("name", ["colloquial", "second_exam"])
def test_calls_written_by_hand_have_the_form_of_generated_ones(name: str) -> None:
    text = (Path(phraseology_judge.__file__).parent / f"{name}.jsonl").read_text()
    lines = [json.loads(line) for line in text.splitlines()]
    assert len(lines) == len({line["text"] for line in lines}) == 200
    for line in lines:
        assert list(line) == ["text", "roster", "speaker", "callsign", "items", "source"]
        assert re.fullmatch(r"[a-z'\- ]+", line["text"]), line["text"]
        assert line["callsign"] is None or line["callsign"] in line["roster"], line["text"]
        assert 3 <= len(set(line["roster"])) == len(line["roster"]) <= 8, line["text"]
        for item in line["items"]:
            assert item["kind"] in KINDS, (item, line["text"])
            assert (item["status"] == "conditional") <= (item["begins"] is not None), line["text"]


def test_a_call_has_words_and_a_callsign_of_three_to_eight_on_the_frequency() -> None:
    for call in calls():
        assert re.fullmatch(r"[a-z'\- ]+", call.text), call.text
        assert 3 <= len(set(call.roster)) == len(call.roster) <= 8
        assert call.callsign is None or call.callsign in call.roster


def test_an_instruction_that_begins_later_is_not_in_effect_now() -> None:
    for call in calls():
        for item in call.items:
            assert (item.status == "conditional") <= (item.begins is not None)
            assert (item.status == "now") <= (item.begins is None)
            assert (item.status in {"readback", "request", "report"}) <= (call.speaker == "pilot")


def test_numbers_that_are_true_are_said() -> None:
    for call, item in items(NUMERIC):
        if item.value is None or (item.kind == "squawk" and "terminated" in call.text):
            continue
        digits = f"{item.value:03}" if item.kind == "heading" else f"{item.value}"
        wanted = {digits, digits.zfill(3)}
        assert any(each in run for run in read(call.text) for each in wanted), (item, call.text)


def test_frequencies_and_settings_that_are_true_are_said() -> None:
    for call, item in items({"frequency", "altimeter"}):
        if not isinstance(item.value, int | float):
            continue
        digits = f"{item.value:.2f}".replace(".", "") if item.unit == "inHg" else f"{item.value}"
        runs = read(call.text)
        assert any(digits in run or digits.rstrip("0") in run for run in runs), (item, call.text)


def test_runways_that_are_true_are_said_with_their_side() -> None:
    sides = {"L": "left", "R": "right", "C": "center"}
    for call, item in items({"takeoff", "landing", "cross_runway", "line_up_and_wait"}):
        if item.value is None:
            continue
        assert isinstance(item.value, str)
        assert any(item.value[:2].lstrip("0") in run for run in read(call.text)), (item, call.text)
        assert item.value[2:] == "" or sides[item.value[2]] in call.text.split()


def test_manners_and_ends_that_are_true_are_said() -> None:
    words = {"left", "right", "contact", "monitor", "maintain", "straight_in", "increase"}
    for call in calls():
        text = re.sub(r"\b(and uh|uh|um|er|ah) ?", "", call.text)
        for item in call.items:
            if item.manner in words and item.kind != "block_altitude":
                assert item.manner[:6].replace("_", " ") in text, (item, call.text)
            assert re.sub(r"\band ", "", item.ends or "") in text, (item, call.text)


def test_items_without_value_are_said() -> None:
    kinds = "follow ident expedite immediately own_navigation pushback wake"
    for word in kinds.split():
        for call, _ in items({word}):
            said = {"own_navigation": "own", "pushback": "push"}.get(word, word)
            assert said in call.text, call.text


@pytest.mark.parametrize("style", ["faa", "icao"])
def test_spelled_numbers_are_read_as_they_were(style: Style) -> None:
    speller = Speller(random.Random(1), style)
    for number in range(500, 18000, 500):
        assert read(speller.altitude(number)) == [str(number)]
    for number in range(5, 365, 5):
        assert read(speller.heading(number)) == [f"{number:03}"]
    for number in range(118000, 137000, 25):
        assert f"{number}".startswith(read(speller.frequency(number))[0])


def test_group_form_is_read_as_it_was() -> None:
    for number in (7, 10, 23, 105, 110, 200, 452, 1005, 1200, 1234, 8090):
        assert read(group(f"{number}")) == [f"{number}"]


def test_a_slip_of_the_tongue_is_corrected_to_the_true_value() -> None:
    speller = Speller(random.Random(1), "icao", errors_left=1)
    assert read(speller.heading(220).split("correction")[1]) == ["220"]
    assert "correction" not in speller.heading(220)


def test_errors_leave_the_truth_and_keep_what_was_said() -> None:
    given = calls()[:120]
    heard = degraded(given, 0.2, seed=3)
    assert heard == degraded(given, 0.2, seed=3)
    assert [call.items for call in heard] == [call.items for call in given]
    assert [call.said for call in heard] == [call.text for call in given]
    assert sum(call.text != call.said for call in heard) > 60


def test_an_impossible_error_rate_is_refused() -> None:
    with pytest.raises(ValueError, match="expected 0 to 1"):
        degraded(calls()[:1], 1.5, seed=3)


def test_words_that_sound_alike_replace_each_other() -> None:
    assert sound("knots") == sound("nots")
    assert distance(sound("flight"), sound("light")) == 1
    assert "descent" in Similar(["descend", "descent", "runway"]).to("descend")
