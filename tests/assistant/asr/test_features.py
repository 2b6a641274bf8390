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


@settings(deadline=None)
@given(st.floats(0.0, 20.0), st.floats(0.0, 20.0), st.sampled_from([0.0, 1e-3]))
def test_pauses_before_and_behind_a_call_change_nothing_in_it(
    before_s: float, behind_s: float, noise_level: float
) -> None:
    call = bursts(6)
    before, behind = (round(s * 100) * SAMPLE_RATE_HZ // 100 for s in (before_s, behind_s))
    alone, held = call, np.pad(call, (before, behind))
    noise = np.random.default_rng(1).standard_normal(len(held), np.float32) * noise_level
    of_call = slice(
        round(before_s * 100), round(before_s * 100) + len(call) * 100 // SAMPLE_RATE_HZ
    )
    as_it_is = normalised(mel_power(alone + noise[: len(alone)]))[:-1]
    with_pauses = normalised(mel_power(held + noise))[of_call]
    assert np.abs(as_it_is - with_pauses).mean() < 0.5  # Of features from -5 to 5.


def test_a_click_in_a_long_pause_is_no_call() -> None:
    call = np.pad(bursts(6), (8 * SAMPLE_RATE_HZ, 0))
    clicked = call.copy()
    clicked[2 * SAMPLE_RATE_HZ : 2 * SAMPLE_RATE_HZ + 400] += 0.9
    quiet, loud = (normalised(mel_power(each))[8 * 100 + 5 :] for each in (call, clicked))
    assert np.abs(quiet - loud).mean() < 0.1


def test_clicks_alone_have_features() -> None:
    clicks = np.zeros(10 * SAMPLE_RATE_HZ, np.float32)
    for second in range(10):
        clicks[second * SAMPLE_RATE_HZ : second * SAMPLE_RATE_HZ + 800] = 0.5
    assert np.isfinite(normalised(mel_power(clicks))).all()


def test_silence_has_no_features() -> None:
    features = normalised(mel_power(np.zeros(SAMPLE_RATE_HZ, np.float32)))
    assert features.shape == (101, BINS)
    assert np.abs(features).max() < 1e-3
