"""The spectrum that the embedded recogniser sees."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from airhilt.assistant.asr.features import BINS, logarithm, mel_power, normalised
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


def reference_power(audio: NDArray[np.floating]) -> NDArray[np.float64]:
    """Return the mel power of each hundredth of a second, band by band as the books have it."""
    low, high = 2595.0 * np.log10(1.0 + np.array([150.0, 3_900.0]) / 700.0)
    edges_hz = 700.0 * (10.0 ** (np.linspace(low, high, 66) / 2595.0) - 1.0)
    mels = 2595.0 * np.log10(1.0 + np.arange(257) * (16_000 / 512) / 700.0)
    edges = 2595.0 * np.log10(1.0 + edges_hz / 700.0)
    frames = []
    for middle in range(0, len(audio) + 1, 160):
        window = np.zeros(400)
        for at in range(400):
            if 0 <= middle - 200 + at < len(audio):
                window[at] = audio[middle - 200 + at]
        spectrum = np.abs(np.fft.fft(window * np.hanning(400), 512)[:257]) ** 2
        frames.append([
            np.sum(spectrum * np.interp(mels, edges[band : band + 3], [0.0, 1.0, 0.0]))
            for band in range(64)
        ])  # fmt: skip
    return np.array(frames)


def test_a_spectrum_has_64_mel_bands_of_25_ms_each_10_ms_within_the_band_of_a_radio() -> None:
    """150 to 3,900 Hz, with Hann windows: the network of the recogniser was trained with that."""
    call = bursts(1)[:2_000] + 0.01 * np.random.default_rng(3).standard_normal(2_000)
    found = mel_power(call.astype(np.float32))
    expected = reference_power(call)
    assert found.shape == (13, 64)
    np.testing.assert_allclose(found, expected, rtol=1e-3, atol=1e-6 * expected.max())


def test_a_call_longer_than_half_a_minute_has_the_spectrum_of_its_parts() -> None:
    rng = np.random.default_rng(4)
    long = (0.1 * rng.standard_normal(31 * SAMPLE_RATE_HZ)).astype(np.float32)
    whole, part = mel_power(long), mel_power(long[28 * SAMPLE_RATE_HZ :])
    assert len(whole) == 3_101
    np.testing.assert_allclose(whole[2_810:], part[10:], rtol=1e-3, atol=1e-7)


def test_features_are_logarithms_above_a_floor_without_their_means() -> None:
    """White noise 30 dB below the mean power of the call, as much as each band has of it."""
    power = mel_power(bursts(1)[:3_000])
    of_white = reference_power(np.eye(1, 400, 200).ravel())[1]
    white = of_white / of_white.mean()
    expected = np.log(power + 1e-7 + 1e-3 * power.mean() * white)
    expected -= expected.mean(axis=0)
    np.testing.assert_allclose(normalised(power), expected, atol=0.02)
    silence = logarithm(np.zeros((1, BINS), np.float32), 0.0)
    np.testing.assert_allclose(silence, np.log(1e-7), rtol=1e-5)
