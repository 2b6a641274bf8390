"""Audio samples, and PCM as it goes over the bus.

All audio of a run is 16 kHz, mono, 16 bits, little-endian.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from airhilt.errors import SpeechError

SAMPLE_RATE_HZ = 16_000
"""Sample rate of all audio in a run."""
SAMPLE_BYTES = 2
"""Size of a sample of PCM."""
FULL_SCALE = 32_768
"""Integer that stands for 1.0 in PCM of 16 bits."""

Audio = NDArray[np.float32]
"""Mono samples, shape (n,), in [-1, 1], at `SAMPLE_RATE_HZ`."""


def to_pcm(audio: Audio) -> bytes:
    """Return samples as PCM; values beyond full scale are clipped.

    Raises
    ------
    SpeechError
        They are not one row of finite numbers.
    """
    if audio.ndim != 1:
        raise SpeechError(f"audio of shape {audio.shape}; expected one row of samples, mono")
    if not np.isfinite(audio).all():
        bad = int(np.flatnonzero(~np.isfinite(audio))[0])
        raise SpeechError(
            f"audio with {audio[bad]} at sample {bad}; expected finite numbers in [-1, 1]"
        )
    scaled = np.rint(audio.astype(np.float32) * FULL_SCALE)
    return np.clip(scaled, -FULL_SCALE, FULL_SCALE - 1).astype("<i2").tobytes()


def from_pcm(pcm: bytes) -> Audio:
    """Return PCM as samples; `to_pcm` gives the same bytes again.

    Raises
    ------
    SpeechError
        The bytes are no whole number of samples.
    """
    if len(pcm) % SAMPLE_BYTES:
        raise SpeechError(f"PCM of {len(pcm)} bytes; expected two bytes a sample, an even number")
    return np.frombuffer(pcm, "<i2").astype(np.float32) / np.float32(FULL_SCALE)
