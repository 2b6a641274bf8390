"""Speech through rooms, microphones, codecs and keys."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.random import Generator

import rooms
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from linear_prediction import predicted
from vowel import vowel

CHANGES: dict[str, Callable[[Audio, Generator], Audio]] = {
    "room": lambda speech, rng: rooms.in_room(speech, 0.3, 3.0, rng),
    "microphone": rooms.through_microphone,
    "resonance": lambda speech, _: rooms.with_resonance(speech, 1500.0, 10.0, 5.0),
    "clipping": lambda speech, _: rooms.clipped(speech, 12.0),
    "gain control": lambda speech, _: rooms.pumped(speech, 0.2, 0.6),
    "mu-law": lambda speech, _: rooms.mu_law(speech),
    "a-law": lambda speech, _: rooms.a_law(speech),
    "adpcm": lambda speech, _: rooms.adpcm(speech),
    "hum": lambda speech, rng: rooms.with_hum(speech, 400.0, -20.0, rng),
    "engine": lambda speech, rng: rooms.with_engine(speech, -15.0, rng),
    "babble": lambda speech, rng: rooms.with_babble(speech, vowel(0.7, 200.0), -15.0, rng),
    "pauses": lambda speech, rng: rooms.hesitating(speech, 2, rng),
    "key": rooms.keyed,
    "open microphone": rooms.with_hot_microphone,
    "linear prediction": predicted,
}


@pytest.mark.parametrize("name", CHANGES)
def test_a_change_is_the_same_for_the_same_seed_and_stays_within_full_scale(name: str) -> None:
    first, again = (CHANGES[name](vowel(), np.random.default_rng(4)) for _ in range(2))
    assert np.array_equal(first, again)
    assert np.all(np.isfinite(first))
    assert np.max(np.abs(first)) <= 1.0
    assert not np.array_equal(first, vowel())


@pytest.mark.parametrize("name", ["room", "microphone", "clipping", "mu-law", "adpcm"])
def test_equipment_keeps_the_length_and_the_level(name: str) -> None:
    changed = CHANGES[name](vowel(), np.random.default_rng(0))
    assert len(changed) == len(vowel())
    assert rooms.rms(changed) == pytest.approx(rooms.rms(vowel()), rel=0.05)


@pytest.mark.parametrize("name", ["mu-law", "a-law", "adpcm"])
def test_a_codec_leaves_speech_recognisable(name: str) -> None:
    changed = CHANGES[name](vowel(), np.random.default_rng(0))
    assert np.corrcoef(changed, vowel())[0, 1] > 0.97


@pytest.mark.parametrize("code", [rooms.mu_law, rooms.a_law])
def test_a_logarithmic_codec_has_the_noise_of_eight_bits(code: Callable[[Audio], Audio]) -> None:
    time_s = np.arange(SAMPLE_RATE_HZ) / SAMPLE_RATE_HZ
    tone = np.asarray(0.5 * np.sin(2.0 * np.pi * 440.0 * time_s), np.float32)
    inner = slice(1_000, -1_000)
    noise = code(tone)[inner] - tone[inner]
    ratio_db = 20.0 * np.log10(rooms.rms(tone[inner]) / rooms.rms(noise))
    assert 30.0 < ratio_db < 45.0


def test_a_late_key_cuts_a_small_part_of_a_call_only() -> None:
    for seed in range(50):
        left = rooms.keyed(vowel(2.0), np.random.default_rng(seed))
        assert 1.6 <= len(left) / SAMPLE_RATE_HZ <= 2.0


def test_reverberation_decays_by_60_db_in_its_time() -> None:
    click = np.zeros(SAMPLE_RATE_HZ, np.float32)
    click[0] = 0.5
    heard = rooms.in_room(click, 0.4, 0.0, np.random.default_rng(0))
    early, late = heard[160:800], heard[160 + 3_200 : 800 + 3_200]
    decay_db = 20.0 * np.log10(rooms.rms(early) / rooms.rms(late))
    assert decay_db == pytest.approx(30.0, abs=3.0)


def test_sounds_beneath_speech_have_the_level_that_is_asked_for() -> None:
    speech = vowel()
    beneath = rooms.with_engine(speech, -15.0, np.random.default_rng(0)) - speech
    assert 20.0 * np.log10(rooms.rms(beneath) / rooms.rms(speech)) == pytest.approx(-15.0, abs=0.5)


def test_hesitations_only_add_time() -> None:
    longer = rooms.hesitating(vowel(), 2, np.random.default_rng(0))
    assert 0.3 <= (len(longer) - len(vowel())) / SAMPLE_RATE_HZ <= 1.6


def test_linear_prediction_keeps_the_length_and_follows_the_envelope() -> None:
    made = predicted(vowel(), np.random.default_rng(0))
    assert len(made) == len(vowel())
    spectra = [np.abs(np.fft.rfft(each, 4096)[:1024]).reshape(-1, 32).mean(axis=1)
               for each in (vowel(), made)]  # fmt: skip
    assert np.corrcoef(*spectra)[0, 1] > 0.7
