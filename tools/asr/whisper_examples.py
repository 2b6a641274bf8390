"""Draws what a Whisper learns from: calls on the air, as the recogniser gives them to the model.

A call goes through the radio channel with a profile, noise and background of its own each time
that it is drawn. The tokens are those that faster-whisper asks for: hot words, the task in English,
and the words between two time stamps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from airhilt.assistant.asr.engines.whisper import hot_words
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.scenario.radio_profiles import PROFILES
from airhilt.sensors.radio.channel import VhfChannel
from airhilt.sensors.radio.on_air import BackgroundNoise
from eval_asr import SpokenCall

PROFILE_NAMES = ("vhf", "vhf", "vhf_833", "fading", "noisy_cockpit", "line")
"""Radio profiles, each as often as it is here; those that the embedded recogniser learned from."""
BACKGROUNDS: tuple[BackgroundNoise, ...] = ("cockpit", "cockpit", "tower", "none")
SNR_DB = (-3.0, 30.0)
SILENT_SHARE = 0.05
"""Share of examples in which nobody speaks; the right answer is then the token of no speech."""
PROMPTED_SHARE = 0.5
"""Share of calls with hot words before them, so that the model works with and without."""
ROSTER = 10
MISSING_SHARE = 0.1
"""Share of rosters without the callsign of the call, so that the model does not trust them."""
PROMPT_TOKENS = 223
"""Most tokens of hot words (faster-whisper, `WhisperModel.get_prompt`)."""
POSITIONS = 448
"""Most tokens in all (Whisper's `max_target_positions`)."""
STAMP_S = 0.02
"""Time between two time stamps (openai/whisper, `tokenizer.timestamp_begin`)."""
IGNORED = -100
"""Label of tokens that do not count in the loss (`torch.nn.CrossEntropyLoss`)."""

Tokens = NDArray[np.int64]


@dataclass(frozen=True)
class Example:
    """One window of audio, with the tokens that the decoder is given and those it shall say."""

    features: NDArray[np.float32]
    """Log-mel features (bands, frames)."""
    given: Tokens
    wanted: Tokens
    """The token after each of `given`; `IGNORED` for those of the prompt."""


class Examples:
    """A data set that is drawn anew, without an end but for its ``size``.

    The example of an index depends on the seed and the index only, so that any number of processes
    may draw.

    Parameters
    ----------
    calls
        Calls, none longer than a window.
    tokenizer
        A `faster_whisper.tokenizer.Tokenizer`.
    features
        A `transformers.WhisperFeatureExtractor`.
    """

    def __init__(
        self, calls: Sequence[SpokenCall], tokenizer: Any, features: Any, size: int, seed: int
    ) -> None:
        self._calls = calls
        self._callsigns = sorted({each.callsign for each in calls if each.callsign})
        self._tokenizer = tokenizer
        self._features = features
        self._size = size
        self._seed = seed

    def __len__(self) -> int:
        return self._size

    def __getitem__(self, index: int) -> Example:
        if index >= self._size:
            raise IndexError(index)
        rng = np.random.default_rng([self._seed, index])
        if rng.random() < SILENT_SHARE:
            silence = np.zeros(int(rng.uniform(1.0, 8.0) * SAMPLE_RATE_HZ), np.float32)
            return self._example(on_the_air(silence, rng), [], self._nothing_said())
        call = self._calls[int(rng.integers(len(self._calls)))]
        heard = on_the_air(call.speech, rng)
        said = self._said(call.text, len(heard) / SAMPLE_RATE_HZ)
        prompt = self._prompt(self._roster(call, rng)) if rng.random() < PROMPTED_SHARE else []
        return self._example(heard, prompt, said)

    def _example(self, heard: Audio, prompt: list[int], said: list[int]) -> Example:
        bands = self._features(heard, sampling_rate=SAMPLE_RATE_HZ, return_tensors="np")
        room = POSITIONS - len(said)
        prompt = prompt[: max(room, 0)]
        tokens = np.array([*prompt, *said], np.int64)
        wanted = tokens[1:].copy()
        wanted[: len(prompt)] = IGNORED
        return Example(np.asarray(bands.input_features[0], np.float32), tokens[:-1], wanted)

    def _said(self, text: str, length_s: float) -> list[int]:
        tokenizer = self._tokenizer
        begin = tokenizer.timestamp_begin
        end = begin + round(min(length_s, self._features.chunk_length) / STAMP_S)
        words = tokenizer.encode(f" {text}")
        return [*tokenizer.sot_sequence, begin, *words, end, tokenizer.eot]

    def _nothing_said(self) -> list[int]:
        tokenizer = self._tokenizer
        return [tokenizer.sot, tokenizer.no_speech, tokenizer.eot]

    def _prompt(self, roster: list[str]) -> list[int]:
        hot = self._tokenizer.encode(f" {hot_words(roster)}")[:PROMPT_TOKENS]
        return [self._tokenizer.sot_prev, *hot]

    def _roster(self, call: SpokenCall, rng: np.random.Generator) -> list[str]:
        count = min(int(rng.integers(1, ROSTER + 1)), len(self._callsigns))
        roster = [str(name) for name in rng.choice(self._callsigns, count, replace=False)]
        if call.callsign and rng.random() >= MISSING_SHARE:
            roster = [name for name in roster if name != call.callsign]
            roster.insert(int(rng.integers(len(roster) + 1)), call.callsign)
        return roster


def on_the_air(speech: Audio, rng: np.random.Generator) -> Audio:
    """Return speech as a receiver has it."""
    channel = VhfChannel(PROFILES[PROFILE_NAMES[rng.integers(len(PROFILE_NAMES))]])
    background = BACKGROUNDS[rng.integers(len(BACKGROUNDS))]
    return channel.transmit(speech, float(rng.uniform(*SNR_DB)), rng, (), background)


def speaker_of(voice: str) -> str:
    """Return who speaks with a voice: the timbre of espeak-ng in whatever accent, or all of it."""
    return voice.rpartition("+")[2]


def split(
    calls: Sequence[SpokenCall], share: float, seed: int
) -> tuple[list[SpokenCall], list[SpokenCall]]:
    """Return calls for training, and calls of other speakers that are about a share of all.

    Raises
    ------
    ValueError
        All are of one speaker.
    """
    speakers = sorted({speaker_of(each.voice) for each in calls})
    if len(speakers) < 2:
        raise ValueError("calls of one speaker; expected at least two, one of them to be held out")
    out: set[str] = set()
    held = 0
    for speaker in np.random.default_rng(seed).permutation(speakers)[:-1]:
        if out and held >= share * len(calls):
            break
        out.add(str(speaker))
        held += sum(speaker_of(each.voice) == speaker for each in calls)
    training = [each for each in calls if speaker_of(each.voice) not in out]
    return training, [each for each in calls if speaker_of(each.voice) in out]
