"""Features of the embedded recogniser: the logarithm of a mel spectrum, 100 times a second.

The mel scale is that of O'Shaughnessy (Speech Communication, 1987): 2595 log10(1 + f / 700).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.fft import rfft
from scipy.sparse import csr_array

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
_FILTERS = csr_array(filters())
"""Mel filters as a sparse matrix, whose product stays on one core; NumPy's would use all."""
_WHITE = np.asarray(_FILTERS.sum(axis=1) / _FILTERS.sum(axis=1).mean(), np.float32)
"""Power of white noise in each band, 1 in the mean."""


def mel_power(audio: Audio) -> NDArray[np.float32]:
    """Return the power in each mel band, shape (frames, `BINS`); one frame at least."""
    padded = np.pad(np.asarray(audio, np.float32), (WINDOW // 2, WINDOW))
    count = len(audio) // HOP + 1
    frames = np.lib.stride_tricks.sliding_window_view(padded, WINDOW)[::HOP][:count]
    power = np.empty((count, BINS), np.float32)
    for begin in range(0, count, BLOCK_FRAMES):
        block = slice(begin, begin + BLOCK_FRAMES)
        spectrum = rfft(frames[block] * _WINDOW, _SIZE, axis=1)
        power[block] = (_FILTERS @ (spectrum.real**2 + spectrum.imag**2).T).T
    return power


def logarithm(power: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the logarithm of mel power of a call with a little white noise."""
    return np.asarray(np.log(power + FLOOR + QUIET * power.mean() * _WHITE), np.float32)


def normalised(power: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the logarithm of mel power without the mean of each band over the call."""
    log = logarithm(power)
    return np.asarray(log - log.mean(axis=0), np.float32)
