"""The spectrum that the embedded recogniser sees."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.assistant.asr.features import BINS, mel_power, normalised
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio


def bursts(count: int) -> Audio:
    """Return bursts of coloured sound, a quarter of a second each, with as long pauses."""
    rng = np.random.default_rng(count)
    size = SAMPLE_RATE_HZ // 4
    burst = np.convolve(rng.standard_normal(size), [1.0, 0.8, 0.4], "same") * 0.1
    return np.tile(np.concatenate([burst, np.zeros(size)]), count).astype(np.float32)


@settings(deadline=None)
@given(st.integers(1, 8), st.floats(1e-6, 1e-3))
def test_a_call_without_noise_looks_like_one_with_hardly_any(count: int, level: float) -> None:
    call = bursts(count)
    noise = np.random.default_rng(0).standard_normal(len(call), np.float32)
    quiet, noisy = (normalised(mel_power(call + noise * np.float32(one))) for one in (0.0, level))
    assert np.abs(quiet - noisy).mean() < 0.2


@settings(deadline=None)
@given(st.floats(0.05, 1.0))
def test_how_loud_a_call_is_makes_no_difference(gain: float) -> None:
    call = bursts(3)
    loud, soft = (normalised(mel_power(call * np.float32(one))) for one in (1.0, gain))
    assert np.abs(loud - soft).max() < 0.1


def test_silence_has_no_features() -> None:
    features = normalised(mel_power(np.zeros(SAMPLE_RATE_HZ, np.float32)))
    assert features.shape == (101, BINS)
    assert np.abs(features).max() < 1e-3
