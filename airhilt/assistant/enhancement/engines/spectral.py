"""The embedded enhancer: a gain in each frame and band of the spectrum.

The gain makes the least mean-square error of the logarithm of the spectral amplitude (Ephraim and
Malah, "Speech enhancement using a minimum mean-square error log-spectral amplitude estimator", IEEE
Transactions on Acoustics, Speech and Signal Processing 33, 1985). Its a priori SNR is
decision-directed (the same authors, 1984). The noise is that of minimum statistics.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.signal import istft, stft
from scipy.special import exp1

from airhilt.assistant.enhancement.noise import noise_power
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.engines import Engine
from airhilt.errors import SpeechError

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


class Spectral:
    """Reduces steady noise; speech that is as loud as the noise loses level too."""

    name = "spectral"

    def enhance(self, audio: Audio) -> Audio:
        """Return the audio with less noise.

        Raises
        ------
        SpeechError
            A sample is no number.
        """
        if not np.isfinite(audio).all():
            raise SpeechError("enhancer spectral: the audio has samples that are no numbers (NaN)")
        if len(audio) < FRAME:
            return audio
        _, _, spectrum = stft(audio, SAMPLE_RATE_HZ, nperseg=FRAME, noverlap=FRAME - HOP)
        power = np.abs(spectrum) ** 2
        noise = np.maximum(noise_power(power, SAMPLE_RATE_HZ / HOP), np.finfo(np.float64).tiny)
        gains = _gains(np.minimum(power / noise, MOST_POSTERIOR))
        _, enhanced = istft(gains * spectrum, SAMPLE_RATE_HZ, nperseg=FRAME, noverlap=FRAME - HOP)
        return np.asarray(enhanced[: len(audio)], np.float32)


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
