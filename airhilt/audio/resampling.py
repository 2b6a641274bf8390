"""Speech of other sample rates."""

from __future__ import annotations

from math import gcd
from typing import Any

import numpy as np

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio


def resampled(samples: Any, rate_hz: int) -> Audio:
    """Return samples of a rate at `SAMPLE_RATE_HZ`, clipped to [-1, 1].

    The filter is that of `scipy.signal.resample_poly`, which goes beyond the loudest sample.
    """
    if rate_hz == SAMPLE_RATE_HZ:
        return np.asarray(samples, np.float32)
    from scipy.signal import resample_poly  # Not at the top: it takes half a second.

    common = gcd(SAMPLE_RATE_HZ, rate_hz)
    spoken = resample_poly(samples, SAMPLE_RATE_HZ // common, rate_hz // common)
    return np.clip(np.asarray(spoken, np.float32), -1.0, 1.0)
