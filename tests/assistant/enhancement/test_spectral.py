"""The embedded enhancer reduces noise and leaves speech."""

from __future__ import annotations

import numpy as np
import pytest

from airhilt.assistant.enhancement.engines.spectral import LEAST_GAIN, Spectral, noise_power
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio


def speech(seconds: float = 4.0) -> Audio:
    """Return a buzz in syllables, with pauses."""
    t = np.arange(round(seconds * SAMPLE_RATE_HZ)) / SAMPLE_RATE_HZ
    buzz = sum(np.sin(2 * np.pi * 150 * k * t + k) / k for k in range(2, 20))
    return np.asarray(0.1 * buzz * np.clip(np.sin(2 * np.pi * 2 * t), 0, 1), np.float32)


def noise(count: int, level: float) -> Audio:
    return np.asarray(level * np.random.default_rng(0).standard_normal(count), np.float32)


def error_db(heard: Audio, clean: Audio) -> float:
    """Return the ratio of speech to all that is wrong."""
    gain = np.dot(heard, clean) / np.dot(clean, clean)
    wrong = heard - gain * clean
    return float(10 * np.log10(gain**2 * np.mean(clean**2) / np.mean(wrong**2)))


def test_speech_is_farther_above_the_noise_than_before() -> None:
    clean = speech()
    noisy = clean + noise(len(clean), float(np.sqrt(np.mean(clean**2))))
    assert error_db(Spectral().enhance(noisy), clean) > error_db(noisy, clean) + 3.0


def test_speech_without_noise_stays_nearly_as_it_is() -> None:
    clean = speech()
    assert error_db(Spectral().enhance(clean + noise(len(clean), 1e-4)), clean) > 12.0


def test_noise_alone_falls_to_the_least_gain() -> None:
    alone = noise(4 * SAMPLE_RATE_HZ, 0.1)
    fallen = np.std(Spectral().enhance(alone)) / np.std(alone)
    assert fallen == pytest.approx(LEAST_GAIN, rel=0.3)


def test_the_noise_is_found_behind_speech_and_is_not_biased() -> None:
    power = np.random.default_rng(1).exponential(2.0, (65, 1000))
    power[10:20, 300:350] += 100.0
    assert noise_power(power, 125.0)[:, 100:-100].mean() == pytest.approx(2.0, rel=0.35)
    assert noise_power(power, 125.0)[10:20, 300:350].mean() < 4.0


def test_silence_stays_silence() -> None:
    silence = np.zeros(16_000, np.float32)
    assert not Spectral().enhance(silence).any()
