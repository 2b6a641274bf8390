"""Features of the embedded recogniser: the logarithm of a mel spectrum, 100 times a second.

The mel scale is that of O'Shaughnessy (Speech Communication, 1987): 2595 log10(1 + f / 700).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio

BINS = 64
BLOCK_FRAMES = 3_000
"""Frames that are computed at a time, half a minute, so that a stuck microphone takes little
memory."""
HOP = SAMPLE_RATE_HZ // 100
WINDOW = SAMPLE_RATE_HZ // 40
LOW_HZ, HIGH_HZ = 150.0, 3_900.0
"""Band of an aeronautical radio, in Hz."""
FLOOR = 1e-7
"""Power added before the logarithm, far below the noise of any receiver."""
QUIET = 1e-3
"""Share of the mean power of a call that is added as white noise: 30 dB below it. Otherwise the
pauses of a call without any noise would have by far the lowest logarithms, and shift the means."""
LOUD_FRAMES = 50
"""Frames of a call that are louder than what counts as loud: half a second, longer than a click."""
LEAST_RANGE_DB = 6.0
"""Difference between loud and quiet below which no frames are a pause, but noise."""
LONGEST_CLICK_FRAMES = 10
"""Longest loud sound that is none of speech: a tenth of a second."""
NEAR_FRAMES = 25
"""Frames on both sides of a loud one that are no pause: a quarter of a second."""
_SIZE = 512


def _mel(frequency_hz: NDArray[np.floating[Any]]) -> NDArray[np.float64]:
    return np.asarray(2595.0 * np.log10(1.0 + frequency_hz / 700.0), np.float64)


def filters() -> NDArray[np.float32]:
    """Return triangular mel filters, shape (`BINS`, bins of the spectrum)."""
    low, high = _mel(np.array([LOW_HZ, HIGH_HZ]))
    edges = np.linspace(low, high, BINS + 2)
    at = _mel(np.fft.rfftfreq(_SIZE, 1.0 / SAMPLE_RATE_HZ))
    rising = (at - edges[:-2, None]) / (edges[1:-1] - edges[:-2])[:, None]
    falling = (edges[2:, None] - at) / (edges[2:] - edges[1:-1])[:, None]
    return np.asarray(np.maximum(0.0, np.minimum(rising, falling)), np.float32)


_WINDOW = np.hanning(WINDOW).astype(np.float32)
_FILTERS = filters()
_REACHES = [slice(int(bins[0]), int(bins[-1]) + 1) for bins in map(np.flatnonzero, _FILTERS)]
"""Bins of the spectrum that each filter takes."""
WHITE = np.asarray(_FILTERS.sum(axis=1) / _FILTERS.sum(axis=1).mean(), np.float32)
"""Power of white noise in each band, 1 in the mean."""


def mel_power(audio: Audio) -> NDArray[np.float32]:
    """Return the power in each mel band, shape (frames, `BINS`); one frame at least."""
    padded = np.pad(np.asarray(audio, np.float32), (WINDOW // 2, WINDOW))
    count = len(audio) // HOP + 1
    frames = np.lib.stride_tricks.sliding_window_view(padded, WINDOW)[::HOP][:count]
    power = np.empty((count, BINS), np.float32)
    for begin in range(0, count, BLOCK_FRAMES):
        block = slice(begin, begin + BLOCK_FRAMES)
        spectrum = np.fft.rfft(frames[block] * _WINDOW, _SIZE, axis=1)
        energy = spectrum.real**2 + spectrum.imag**2
        for band, (weights, reach) in enumerate(zip(_FILTERS, _REACHES, strict=True)):
            # A product of matrices would take all cores.
            power[block, band] = np.einsum("fb,b->f", energy[:, reach], weights[reach])
    return power


def logarithm(power: NDArray[np.float32], mean: float) -> NDArray[np.float32]:
    """Return the logarithm of mel power of a call of a mean power, with a little white noise."""
    return np.asarray(np.log(power + FLOOR + QUIET * mean * WHITE), np.float32)


def is_near_speech(power: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Return which frames are none of a long pause, shape (frames,); all where no pause is found.

    A frame is loud above the middle, in dB, between what half a second exceeds and the level of the
    quietest tenth.
    """
    mean = np.convolve(np.pad(power.mean(axis=1), 2, "symmetric"), np.full(5, 0.2), "valid")
    levels_db = 10.0 * np.log10(mean + FLOOR)
    loud_db = float(np.sort(levels_db)[-LOUD_FRAMES:][0])
    quiet_db = float(np.percentile(levels_db, 10.0))
    if loud_db - quiet_db < LEAST_RANGE_DB:
        return np.ones(len(power), np.bool_)
    is_loud = levels_db >= (loud_db + quiet_db) / 2.0
    begins, ends = np.flatnonzero(np.diff(is_loud, prepend=False, append=False)).reshape(-1, 2).T
    is_near = np.zeros(len(power), np.bool_)
    for begin, end in zip(begins, ends, strict=True):
        if end - begin >= LONGEST_CLICK_FRAMES:
            is_near[max(begin - NEAR_FRAMES, 0) : end + NEAR_FRAMES] = True
    return is_near if is_near.any() else np.ones(len(power), np.bool_)


def normalised(power: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the logarithm of mel power without the mean of each band over the call.

    Long pauses, such as before somebody speaks who has pressed the button, do not count in means.
    """
    is_counted = is_near_speech(power)
    log = logarithm(power, float(power[is_counted].mean()))
    return np.asarray(log - log[is_counted].mean(axis=0), np.float32)
