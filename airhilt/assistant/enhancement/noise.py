"""The spectrum of noise in a transmission, by minimum statistics.

In each band the power falls to that of the noise in the pauses of speech. The noise is the least of
the smoothed power in a window that is longer than a word, times a factor for the bias of the least
value (Martin, "Noise power spectral density estimation based on optimal smoothing and minimum
statistics", IEEE Transactions on Speech and Audio Processing 9, 2001). This is the method with a
constant smoothing factor in place of the optimal one of that paper.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import minimum_filter1d
from scipy.signal import lfilter

SMOOTHING = 0.9
"""Factor of the recursive smoothing of the power, for frames of 8 ms: a time constant of 76 ms."""
WINDOW_S = 1.5
"""Length of the window of the least value, in s, longer than a word. The window is centred, because
the whole transmission is known."""
BIAS = 2.0
"""Ratio of the mean power of white noise to the least of its smoothed power in the window. It was
simulated with this smoothing and window, and frames of 32 ms."""


def noise_power(power: NDArray[np.float64], frames_per_s: float) -> NDArray[np.float64]:
    """Return the power of the noise in each frame and band.

    Parameters
    ----------
    power
        Power of the frames of a transmission, shape (bands, frames).
    """
    start = SMOOTHING * power[:, : max(round(0.1 * frames_per_s), 1)].mean(axis=1, keepdims=True)
    smooth, _ = lfilter([1.0 - SMOOTHING], [1.0, -SMOOTHING], power, axis=1, zi=start)
    frames = max(round(WINDOW_S * frames_per_s), 1)
    least = minimum_filter1d(smooth, frames, axis=1, mode="nearest")
    return np.asarray(BIAS * least, np.float64)
