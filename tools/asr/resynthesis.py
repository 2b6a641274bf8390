"""Speech in another voice: other pitch, formants, tempo, breath and timbre.

The vocoder is WORLD (Morise, Yokomori and Ozawa, IEICE Transactions E99-D, 2016; package
`pyworld`, MIT licence). It takes speech apart into pitch, spectral envelope and aperiodicity, which
may be changed one by one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pyworld
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio

Frames = NDArray[np.float64]
FRAME_MS = 5.0
PITCH_FLOOR_HZ, PITCH_CEILING_HZ = 60.0, 500.0
MOST_BORROWED = 3.0
"""Largest difference of timbres, in logarithms of power (13 dB), so that no noise is raised where
a voice has nothing: an assumption."""
WANDER_FRAMES = 80.0
"""Frames over which the tempo wanders: about a word."""


@dataclass(frozen=True, slots=True)
class Manner:
    """A manner of speaking, by how it differs from what was said.

    Attributes
    ----------
    pitch, formants, tempo
        Factors; a tempo of 2 takes half the time.
    pitch_range
        Factor on the logarithmic deviations of the pitch from its mean; 0 is a monotone.
    jitter
        Standard deviation of the pitch from frame to frame, relative.
    tempo_wander
        Standard deviation of the logarithm of the tempo within the call.
    breath
        Share of the periodic energy that becomes noise, in [0, 1].
    whispered
        True if nothing has a pitch.
    borrowed
        Share of the difference to the timbre of somebody else, in [0, 1].
    """

    pitch: float = 1.0
    formants: float = 1.0
    tempo: float = 1.0
    pitch_range: float = 1.0
    jitter: float = 0.0
    tempo_wander: float = 0.0
    breath: float = 0.0
    whispered: bool = False
    borrowed: float = 0.0


@dataclass(frozen=True, slots=True)
class Voice:
    """Parts into which WORLD takes speech: a row each 5 ms, of the aperiodicity each 10 ms."""

    pitch_hz: Frames
    """0 where there is none."""
    envelope: Frames
    """Logarithm of the power spectrum."""
    aperiodicity: Frames
    """Share of noise in [0, 1], by frequency."""


def draw_manner(rng: Generator) -> Manner:
    """Return a manner of speaking at random, most of them near to what people do."""
    return Manner(
        pitch=float(np.exp(rng.uniform(np.log(0.7), np.log(1.5)))),
        formants=float(rng.uniform(0.85, 1.18)),
        tempo=float(np.exp(rng.uniform(np.log(0.75), np.log(1.35)))),
        pitch_range=float(rng.uniform(0.2, 1.8)),
        jitter=float(rng.choice((0.0, 0.005, 0.02))),
        tempo_wander=float(rng.uniform(0.0, 0.15)),
        breath=float(rng.choice((0.0, 0.0, rng.uniform(0.05, 0.5)))),
        whispered=bool(rng.random() < 0.03),
        borrowed=float(rng.choice((0.0, rng.uniform(0.2, 0.8)))),
    )


def analyse(speech: Audio) -> Voice:
    """Return what WORLD finds in speech (DIO and StoneMask, CheapTrick, D4C)."""
    samples = np.asarray(speech, np.float64)
    pitch_hz, times, envelope = _pitch_and_envelope(samples)
    aperiodicity = pyworld.d4c(samples, pitch_hz[::2].copy(), times[::2].copy(), SAMPLE_RATE_HZ)
    return Voice(pitch_hz, envelope, aperiodicity)


def timbre_of(speech: Audio) -> Frames:
    """Return the mean logarithmic envelope of speech where it has a pitch, without its level."""
    pitch_hz, _, envelope = _pitch_and_envelope(np.asarray(speech, np.float64))
    return _timbre(pitch_hz, envelope)


def _timbre(pitch_hz: Frames, envelope: Frames) -> Frames:
    voiced = envelope[pitch_hz > 0.0]
    mean = (voiced if len(voiced) else envelope).mean(axis=0)
    return np.asarray(mean - mean.mean())


def _pitch_and_envelope(samples: Frames) -> tuple[Frames, Frames, Frames]:
    """Return the pitch, the times of its frames and the logarithmic envelopes."""
    rough, times = pyworld.dio(
        samples,
        SAMPLE_RATE_HZ,
        f0_floor=PITCH_FLOOR_HZ,
        f0_ceil=PITCH_CEILING_HZ,
        frame_period=FRAME_MS,
    )
    pitch_hz = pyworld.stonemask(samples, rough, times, SAMPLE_RATE_HZ)
    power = pyworld.cheaptrick(samples, pitch_hz, times, SAMPLE_RATE_HZ)
    return pitch_hz, times, np.log(power)


def resynthesise(
    voice: Voice, manner: Manner, rng: Generator, timbre: Frames | None = None
) -> Audio:
    """Return the speech of a voice in another manner.

    Parameters
    ----------
    timbre
        Timbre of somebody else, of which ``manner.borrowed`` is taken.
    """
    at = _frames_at(len(voice.pitch_hz), manner, rng)
    pitch_hz = _pitch(voice.pitch_hz[np.rint(at).astype(int)], manner, rng)
    envelope = _warped(_interpolated(voice.envelope, at), manner.formants)
    aperiodicity = np.clip(_interpolated(voice.aperiodicity, at / 2.0), 0.0, 1.0)
    if timbre is not None:
        own = _timbre(voice.pitch_hz, voice.envelope)
        difference = timbre - _warped(own[None], manner.formants)[0]
        envelope += manner.borrowed * np.clip(difference, -MOST_BORROWED, MOST_BORROWED)
    height = np.linspace(0.0, 1.0, envelope.shape[1])
    if manner.whispered:
        envelope -= 3.0 * np.exp(-height * 12.0)  # A whisper has little below the first formant.
    aperiodicity += manner.breath * np.minimum(1.0, 0.3 + height) * (1.0 - aperiodicity)
    samples = pyworld.synthesize(
        pitch_hz,
        np.ascontiguousarray(np.exp(envelope)),
        np.ascontiguousarray(aperiodicity),
        SAMPLE_RATE_HZ,
        FRAME_MS,
    )
    return np.asarray(samples, np.float32)


def _frames_at(count: int, manner: Manner, rng: Generator) -> Frames:
    """Return the places in the old frames of the new ones."""
    wander = gaussian_filter1d(rng.standard_normal(count), WANDER_FRAMES)
    wander *= manner.tempo_wander / max(float(np.std(wander)), 1e-9)
    durations = np.exp(wander)
    durations *= count / (manner.tempo * durations.sum())
    ends = np.cumsum(durations)
    places = np.interp(np.arange(max(2, round(ends[-1]))), ends - durations[0], np.arange(count))
    return np.asarray(places)


def _pitch(pitch_hz: Frames, manner: Manner, rng: Generator) -> Frames:
    voiced = pitch_hz > 0.0
    if manner.whispered or not voiced.any():
        return np.zeros_like(pitch_hz)
    log = np.log(pitch_hz[voiced])
    log = log.mean() + manner.pitch_range * (log - log.mean()) + np.log(manner.pitch)
    log += manner.jitter * rng.standard_normal(len(log))
    changed = np.zeros_like(pitch_hz)
    changed[voiced] = np.clip(np.exp(log), PITCH_FLOOR_HZ, PITCH_CEILING_HZ * 1.2)
    return changed


def _interpolated(rows: Frames, at: Frames) -> Frames:
    """Return the rows at places between them."""
    low = np.minimum(at.astype(int), len(rows) - 2)
    part = np.minimum(at - low, 1.0)[:, None]
    return np.asarray(rows[low] * (1.0 - part) + rows[low + 1] * part)


def _warped(rows: Frames, factor: float) -> Frames:
    """Return spectra whose frequencies are multiplied by a factor."""
    last = rows.shape[1] - 1
    at = np.minimum(np.arange(last + 1) / factor, last)
    low = np.minimum(at.astype(int), last - 1)
    part = at - low
    return np.asarray(rows[:, low] * (1.0 - part) + rows[:, low + 1] * part)
