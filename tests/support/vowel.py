"""A sound with the pitch and the formants of a vowel."""

from __future__ import annotations

import numpy as np

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio

PITCH_HZ = 120.0


def vowel(seconds: float = 1.0, pitch_hz: float = PITCH_HZ) -> Audio:
    """Return a buzz with the first three formants of a vowel, and silence at both ends."""
    time_s = np.arange(int(seconds * SAMPLE_RATE_HZ)) / SAMPLE_RATE_HZ
    sound = sum(
        np.sin(2.0 * np.pi * order * pitch_hz * time_s)
        * sum(
            0.1 / order + np.exp(-(((order * pitch_hz - at) / 150.0) ** 2))
            for at in (600.0, 1200.0, 2500.0)
        )
        for order in range(1, 40)
    )
    syllables = 0.55 + 0.45 * np.sin(2.0 * np.pi * 4.0 * time_s)
    return np.asarray(np.pad(0.05 * sound * syllables, 1_600), np.float32)
