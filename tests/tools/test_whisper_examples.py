"""Examples for a Whisper: the tokens that faster-whisper asks for, and calls on the air."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import whisper_examples
from airhilt.assistant.asr.engines.whisper import hot_words
from eval_asr import SpokenCall
from finetune_whisper import together
from whisper_examples import IGNORED, POSITIONS, PROMPT_TOKENS, Example, Examples, speaker_of, split

SECOND = 16_000
START, LANGUAGE, TASK, PREVIOUS, NOBODY, END, STAMPS = 300, 301, 302, 303, 304, 305, 1_000


class Tokens:
    """A tokenizer whose tokens are bytes."""

    sot, sot_prev, no_speech, eot, timestamp_begin = START, PREVIOUS, NOBODY, END, STAMPS
    sot_sequence = (START, LANGUAGE, TASK)

    def encode(self, text: str) -> list[int]:
        return list(text.encode())


class Features:
    """Features that are the samples."""

    chunk_length = 30

    def __call__(self, audio: np.ndarray, **_: Any) -> SimpleNamespace:
        return SimpleNamespace(input_features=audio[None, None])


def call(text: str, callsign: str | None, voice: str = "en-us+max") -> SpokenCall:
    tone = 9_000 * np.sin(np.arange(2 * SECOND) * 0.2)
    return SpokenCall({"text": text, "callsign": callsign, "voice": voice}, tone.astype(np.int16))


CALLS = [
    call("american one twenty three hold short", "AAL123"),
    call("delta four five six roger", "DAL456"),
    call("follow the greens", None),
]


@pytest.fixture
def quiet(monkeypatch: pytest.MonkeyPatch) -> None:
    """Calls do not go through the channel, which takes most of the time."""
    monkeypatch.setattr(whisper_examples, "on_the_air", lambda speech, rng: speech)


def examples(calls: list[SpokenCall], count: int = 60) -> list[Example]:
    drawn = Examples(calls, Tokens(), Features(), count, seed=3)
    return [drawn[index] for index in range(count)]


def taught(example: Example) -> list[int]:
    return [int(token) for token in example.wanted if token != IGNORED]


def prompt_of(example: Example) -> str | None:
    """Return the hot words before a call, or None if it has none."""
    tokens = example.given.tolist()
    if tokens[0] != PREVIOUS:
        return None
    return bytes(tokens[1 : tokens.index(START)]).decode()


@pytest.mark.usefixtures("quiet")
def test_the_words_stand_between_time_stamps_after_the_task_in_english() -> None:
    (text,) = {each.text for each in CALLS[:1]}
    for example in examples(CALLS[:1]):
        if NOBODY in taught(example):
            continue
        language, task, begin, *words, end, last = taught(example)
        assert (language, task, begin, last) == (LANGUAGE, TASK, STAMPS, END)
        assert bytes(words).decode() == f" {text}"
        assert end == STAMPS + 100


@pytest.mark.usefixtures("quiet")
def test_each_token_that_is_taught_follows_those_that_are_given() -> None:
    for example in examples(CALLS):
        for before, after in zip(example.wanted, example.given[1:], strict=False):
            assert before in (IGNORED, after)


@pytest.mark.usefixtures("quiet")
def test_hot_words_are_given_and_not_taught() -> None:
    prompts = [(each, prompt_of(each)) for each in examples(CALLS)]
    with_prompt = [each for each, prompt in prompts if prompt is not None]
    assert 0.3 < len(with_prompt) / len(prompts) < 0.7
    for example in with_prompt:
        start = example.given.tolist().index(START)
        assert set(example.wanted[:start]) == {IGNORED}
        assert example.wanted[start] == LANGUAGE


@pytest.mark.usefixtures("quiet")
def test_hot_words_are_those_of_the_recogniser_and_hardly_ever_lack_the_call() -> None:
    calls = [call(f"AAL{number}", f"AAL{number}") for number in range(100, 140)]
    named = [
        hot_words([bytes(taught(each)[4:-2]).decode()]) in prompt
        for each in examples(calls, 400)
        if (prompt := prompt_of(each)) is not None
    ]
    assert len(named) > 100
    assert 0.8 < np.mean(named) < 1.0


@pytest.mark.usefixtures("quiet")
def test_who_says_nothing_is_taught_as_no_speech() -> None:
    silent = [each for each in examples(CALLS, 200) if NOBODY in taught(each)]
    assert 2 <= len(silent) <= 25
    for example in silent:
        assert example.given.tolist() == [START, NOBODY]
        assert taught(example) == [NOBODY, END]


@pytest.mark.usefixtures("quiet")
def test_a_long_call_leaves_less_room_for_hot_words() -> None:
    calls = [call("one " * 90, f"AAL{number}") for number in range(40)]
    for example in examples(calls):
        assert len(example.given) < POSITIONS
        assert len((prompt_of(example) or "").encode()) <= PROMPT_TOKENS


def test_an_example_depends_on_seed_and_index_only() -> None:
    drawn = Examples(CALLS, Tokens(), Features(), 5, seed=3)
    first, again = drawn[4], [drawn[3], drawn[4]][1]
    np.testing.assert_array_equal(first.features, again.features)
    np.testing.assert_array_equal(first.given, again.given)
    other = Examples(CALLS, Tokens(), Features(), 5, seed=4)[4]
    assert not np.array_equal(first.features, other.features)


def test_a_call_is_never_on_the_air_in_the_same_way_twice() -> None:
    heard = [each.features.tobytes() for each in examples(CALLS[:1], 20)]
    assert len(set(heard)) == len(heard)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_speakers_who_are_held_out_are_in_no_call_for_training(seed: int) -> None:
    timbres = ("max", "rob", "m1", "f2", "zac")
    calls = [
        call("roger", None, f"{accent}+{timbre}")
        for accent in ("en-us", "en-gb")
        for timbre in timbres
        for _ in range(5)
    ]
    training, held_out = split(calls, 0.2, seed)
    assert len(training) + len(held_out) == len(calls)
    assert len(held_out) == 10
    assert not {speaker_of(c.voice) for c in training} & {speaker_of(c.voice) for c in held_out}


def test_one_speaker_alone_cannot_be_held_out() -> None:
    with pytest.raises(ValueError, match="calls of one speaker"):
        split(CALLS, 0.1, 0)


def test_shorter_examples_are_filled_with_what_does_not_count() -> None:
    window = np.zeros((1, 4), np.float32)
    short, long = (Example(window, np.arange(size), np.arange(1, size + 1)) for size in (2, 5))
    batch = together([short, long])
    assert batch["labels"].tolist() == [[1, 2, IGNORED, IGNORED, IGNORED], [1, 2, 3, 4, 5]]
    assert batch["decoder_input_ids"].shape == (2, 5)
    assert batch["input_features"].shape == (2, 1, 4)
