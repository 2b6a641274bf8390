"""Texts of training for the recogniser: what is in them, and what is kept out for tests."""

from __future__ import annotations

import json
import random
import re
from functools import lru_cache
from typing import get_args

import pytest

from airhilt.phraseology import parse_call
from airhilt.phraseology.call import Action, Instruction
from airhilt.phraseology.numbers import Style
from airhilt.phraseology.say import speak_instruction
from airhilt.phraseology.telephony import TELEPHONY
from asr_corpus import UNEXPECTED_SHARE, Talk, common_words
from asr_names import Names, held_out_places, is_held_out, places
from asr_said import Said, transcript
from paths import ROOT

SCENARIOS = sorted((ROOT / "scenarios").glob("*.json"))


@lru_cache(maxsize=1)
def texts() -> list[str]:
    talk = Talk(random.Random(0))
    return [talk.call() for _ in range(16_000)]


@lru_cache(maxsize=1)
def words() -> set[str]:
    return {word for text in texts() for word in text.split()}


def spoken_in(value: object) -> list[str]:
    """Return all texts of calls in a scenario."""
    if isinstance(value, dict):
        own = [text for key, text in value.items() if key == "text" and isinstance(text, str)]
        return own + [text for each in value.values() for text in spoken_in(each)]
    return [text for each in value for text in spoken_in(each)] if isinstance(value, list) else []


def test_texts_are_lower_case_words_without_punctuation() -> None:
    assert all(re.fullmatch(r"[a-z']+(?: [a-z']+)*", text) for text in texts())


def test_some_calls_have_words_that_no_form_has() -> None:
    common = set(common_words())
    assert len(common) > 8_000
    assert {"yesterday", "kitchen", "although"} <= common
    unheard = common - {word for text in calls_without_unexpected() for word in text.split()}
    share = sum(not unheard.isdisjoint(text.split()) for text in texts()) / len(texts())
    assert 0.7 * UNEXPECTED_SHARE < share < 1.1 * UNEXPECTED_SHARE


def calls_without_unexpected() -> list[str]:
    """Return calls of the forms alone."""
    talk = Talk(random.Random(1))
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("asr_corpus.UNEXPECTED_SHARE", 0.0)
        return [talk.call() for _ in range(16_000)]


def test_no_name_that_is_held_out_is_a_common_word() -> None:
    rng = random.Random(3)
    names = Names(rng, held_out=True)
    fixes = {names.fix() for _ in range(5_000)}
    assert fixes.isdisjoint(common_words())
    assert set(held_out_places()).isdisjoint(common_words())


def test_every_word_of_a_scenario_is_drawn() -> None:
    spoken = [text for path in SCENARIOS for text in spoken_in(json.loads(path.read_text()))]
    assert len(spoken) > 50
    said = {word for text in spoken for word in transcript(text).split()}
    assert said <= words()


@pytest.mark.parametrize("style", get_args(Style))
def test_every_word_of_the_projects_own_speakers_is_drawn(style: Style) -> None:
    rng = random.Random(1)
    said = Said(rng, Names(rng))
    spoken = {
        word
        for action in get_args(Action)
        for immediate in (False, True)
        for condition in (None, "behind the landing Boeing")
        for word in transcript(
            speak_instruction("DAL456", _of(said, action, immediate, condition), style)
        ).split()
    }
    assert {word for word in spoken if len(word) != 5} <= words() | set(" ".join(places()).split())


def _of(said: Said, action: Action, immediate: bool, condition: str | None) -> Instruction:
    """Return an instruction with all details; its fix has five letters, as words that are open."""
    return Instruction(
        action, runway="15C", via=("A", "B7"), hold_short="C", sense="climb", altitude_ft=12_400.0,
        bound="or_more", rate_fpm=1_500.0, turn="left", heading_deg=70.0, turn_deg=30.0,
        speed_kt=210.0, mach=0.78, named="normal", frequency_khz=118_335, squawk="4213",
        approach="ils", variant="Z", immediate=immediate, condition=condition,
        position="Tower" if action in ("contact", "monitor") else "bopse",
    )  # fmt: skip


def test_every_airline_and_every_digit_is_drawn_as_it_is_spoken() -> None:
    assert {word for name in TELEPHONY.values() for word in name.split()} <= words()
    assert {"tree", "fower", "fife", "niner", "tousand", "oh", "double", "triple"} <= words()


def test_same_seed_draws_the_same_calls() -> None:
    first, again = Talk(random.Random(7)), Talk(random.Random(7))
    assert [first.call() for _ in range(50)] == [again.call() for _ in range(50)]


def test_places_that_are_held_out_are_in_no_training_text() -> None:
    kept = held_out_places()
    assert len(kept) > 30
    assert words().isdisjoint({word for name in kept for word in name.split()})


def test_training_and_tests_draw_their_fixes_from_different_names() -> None:
    training = Names(random.Random(0))
    tests = Names(random.Random(0), held_out=True)
    assert not any(is_held_out(training.fix()) for _ in range(2_000))
    drawn = {tests.fix() for _ in range(500)}
    assert all(is_held_out(name) for name in drawn)
    assert len(drawn) > 450


def test_a_call_with_held_out_names_keeps_the_words_of_the_phraseology() -> None:
    talk = Talk(random.Random(0), held_out=True)
    drawn = {word for _ in range(3_000) for word in talk.call().split()}
    assert {"cleared", "runway", "descend", "washington"} <= drawn


def test_callsign_of_a_call_is_that_which_the_parser_reads() -> None:
    talk = Talk(random.Random(2))
    calls = [(talk.call(), talk.callsign_of_call) for _ in range(500)]
    named = [(text, callsign) for text, callsign in calls if callsign is not None]
    read = [parse_call(text, (callsign,)).callsign == callsign for text, callsign in named]
    assert len(named) > 300
    assert sum(read) >= 0.97 * len(read)
