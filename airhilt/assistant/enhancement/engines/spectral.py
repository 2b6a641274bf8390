"""The embedded enhancer: a gain in each frame and band of the spectrum.

The gain makes the least mean-square error of the logarithm of the spectral amplitude (Ephraim and
Malah, "Speech enhancement using a minimum mean-square error log-spectral amplitude estimator", IEEE
Transactions on Acoustics, Speech and Signal Processing 33, 1985). Its a priori SNR is
decision-directed (the same authors, 1984).

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
from scipy.signal import istft, lfilter, stft
from scipy.special import exp1

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.engines import Engine

FRAME = 512
"""Samples of a frame: 32 ms."""
HOP = 128
"""Samples from one frame to the next: 8 ms."""
DECISION_DIRECTED = 0.98
"""Weight of the frame before in the a priori SNR (Ephraim and Malah, 1984, section V)."""
LEAST_PRIOR = 10.0**-2.5
"""Least a priori SNR: -25 dB (Cappe, "Elimination of the musical noise phenomenon", 1994)."""
MOST_POSTERIOR = 10.0**4
"""Greatest a posteriori SNR, for bands without noise: 40 dB."""
LEAST_GAIN = 10.0**-0.6
"""Least gain: -12 dB. Noise that is left hides what the gain does to speech. An assumption."""
SMOOTHING = 0.9
"""Factor of the recursive smoothing of the power, for frames of 8 ms: a time constant of 76 ms."""
WINDOW_S = 1.5
"""Length of the window of the least value, in s, longer than a word. The window is centred, because
the whole transmission is known."""
BIAS = 2.0
"""Ratio of the mean power of white noise to the least of its smoothed power in the window. It was
simulated with this smoothing and window, and frames of 32 ms."""


class Spectral:
    """Reduces steady noise; speech that is as loud as the noise loses level too."""

    name = "spectral"

    def enhance(self, audio: Audio) -> Audio:
        """Return the audio with less noise."""
        if len(audio) < FRAME:
            return audio
        _, _, spectrum = stft(audio, SAMPLE_RATE_HZ, nperseg=FRAME, noverlap=FRAME - HOP)
        power = np.abs(spectrum) ** 2
        noise = np.maximum(noise_power(power, SAMPLE_RATE_HZ / HOP), np.finfo(np.float64).tiny)
        gains = _gains(np.minimum(power / noise, MOST_POSTERIOR))
        _, enhanced = istft(gains * spectrum, SAMPLE_RATE_HZ, nperseg=FRAME, noverlap=FRAME - HOP)
        return np.asarray(enhanced[: len(audio)], np.float32)


def noise_power(power: NDArray[np.float64], frames_per_s: float) -> NDArray[np.float64]:
    """Return the power of the noise in each band and frame of a transmission, as ``power`` has."""
    start = SMOOTHING * power[:, : max(round(0.1 * frames_per_s), 1)].mean(axis=1, keepdims=True)
    smooth, _ = lfilter([1.0 - SMOOTHING], [1.0, -SMOOTHING], power, axis=1, zi=start)
    frames = max(round(WINDOW_S * frames_per_s), 1)
    least = minimum_filter1d(smooth, frames, axis=1, mode="nearest")
    return np.asarray(BIAS * least, np.float64)


def _gains(posterior: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the gain of each band and frame, from the a posteriori SNR, shape (bands, frames)."""
    gains = np.empty_like(posterior)
    before = np.ones(len(posterior))
    for frame in range(posterior.shape[1]):
        ratio = posterior[:, frame]
        prior = DECISION_DIRECTED * before + (1.0 - DECISION_DIRECTED) * np.maximum(ratio - 1, 0.0)
        prior = np.maximum(prior, LEAST_PRIOR)
        wiener = prior / (1.0 + prior)
        gain = wiener * np.exp(0.5 * exp1(np.maximum(wiener * ratio, 1e-10)))
        gains[:, frame] = np.clip(gain, LEAST_GAIN, 1.0)
        before = gain**2 * ratio
    return gains


ENGINE = Engine(
    name="spectral",
    summary="log-spectral amplitude estimator with minimum statistics; ships with AIRHILT",
    create=lambda _: Spectral(),
)
