"""Speech by linear prediction, with pulses or noise as excitation: a cheap vocoder.

Atal and Hanauer, JASA 50, 1971. It sounds like the vocoders of old digital radios (LPC-10, FIPS
137), whose order and voicing by autocorrelation are like these.
"""

from __future__ import annotations

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.linalg import solve_toeplitz
from scipy.signal import lfilter

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio

Frames = NDArray[np.float64]
PITCH_FLOOR_HZ, PITCH_CEILING_HZ = 60.0, 500.0
LPC_ORDER = 16
LPC_FRAME, LPC_HOP = 400, 160
"""Samples of a frame and from one to the next: 25 ms and 10 ms."""
VOICED_FROM = 0.4
"""Least normalised autocorrelation of a frame that has a pitch: an assumption."""


def _autocorrelation(frame: Frames) -> Frames:
    power = np.abs(np.fft.rfft(frame, 2 * LPC_FRAME)) ** 2
    return np.asarray(np.fft.irfft(power)[:LPC_FRAME])


WINDOW = np.hanning(LPC_FRAME)
WINDOW_CORRELATION = _autocorrelation(WINDOW) + 1e-3


def predicted(speech: Audio, rng: Generator, pitch: float = 1.0) -> Audio:
    """Return speech made of pulses or noise through filters of linear prediction."""
    size = max(1, -(-len(speech) // LPC_HOP))
    padded = np.pad(np.asarray(speech, np.float64), (LPC_FRAME, size * LPC_HOP))
    out = np.zeros(size * LPC_HOP)
    state = np.zeros(LPC_ORDER)
    due = 0
    for frame in range(size):
        begin = LPC_FRAME + frame * LPC_HOP - (LPC_FRAME - LPC_HOP) // 2
        correlation = _autocorrelation(padded[begin : begin + LPC_FRAME] * WINDOW)
        if correlation[0] < 1e-8:
            continue
        filtered, gain = _predictor(correlation)
        lag = _lag(correlation)
        period = round(lag / pitch) if lag else 0
        excitation = np.zeros(LPC_HOP) if period else rng.standard_normal(LPC_HOP)
        while period and due < LPC_HOP:
            excitation[due] = np.sqrt(period)
            due += period
        due = max(0, due - LPC_HOP)
        where = slice(frame * LPC_HOP, (frame + 1) * LPC_HOP)
        out[where], state = lfilter([gain], filtered, excitation, zi=state)
    return np.asarray(out[: len(speech)], np.float32)


def _predictor(correlation: Frames) -> tuple[Frames, float]:
    """Return the filter of a frame and its gain per sample, with a little white noise added."""
    regular = correlation[: LPC_ORDER + 1].copy()
    regular[0] *= 1.0001
    weights = solve_toeplitz(regular[:-1], regular[1:])
    error = max(float(regular[0] - weights @ regular[1:]), 0.0)
    energy_of_window = float(np.sum(WINDOW**2))
    return np.concatenate([[1.0], -weights]), float(np.sqrt(error / energy_of_window))


def _lag(correlation: Frames) -> int:
    """Return the period of a frame in samples; 0 if it has none."""
    first = int(SAMPLE_RATE_HZ / PITCH_CEILING_HZ)
    last = int(SAMPLE_RATE_HZ / PITCH_FLOOR_HZ)
    unbiased = correlation / WINDOW_CORRELATION * (WINDOW_CORRELATION[0] / correlation[0])
    lag = first + int(np.argmax(unbiased[first:last]))
    return lag if unbiased[lag] > VOICED_FROM else 0
