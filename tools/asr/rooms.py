"""Ways from a mouth to a transmitter: rooms, microphones, codecs, keys, other sounds.

Each function takes speech in [-1, 1] and returns it changed, at about the same level.
"""

from __future__ import annotations

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d
from scipy.signal import fftconvolve, firwin2, lfilter, resample_poly, sosfilt, tf2sos

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio

Samples = NDArray[np.float64]
TAPS = 257
MOST_CUT_S = 0.2
"""Longest time by which a key is pressed late or released early: an assumption."""
MOST_CUT_SHARE = 0.08
"""Largest share of a call that is lost thereby, so that no short call loses a word."""
ADPCM_STEPS = np.array(
    [7, 8, 9, 10, 11, 12, 13, 14, 16, 17, 19, 21, 23, 25, 28, 31, 34, 37, 41, 45, 50, 55, 60, 66,
     73, 80, 88, 97, 107, 118, 130, 143, 157, 173, 190, 209, 230, 253, 279, 307, 337, 371, 408,
     449, 494, 544, 598, 658, 724, 796, 876, 963, 1060, 1166, 1282, 1411, 1552, 1707, 1878, 2066,
     2272, 2499, 2749, 3024, 3327, 3660, 4026, 4428, 4871, 5358, 5894, 6484, 7132, 7845, 8630,
     9493, 10442, 11487, 12635, 13899, 15289, 16818, 18500, 20350, 22385, 24623, 27086, 29794,
     32767]
).tolist()  # fmt: skip
ADPCM_CHANGES = (-1, -1, -1, -1, 2, 4, 6, 8)
"""Steps and their changes (IMA Digital Audio, Recommended Practices 3.0, 1992)."""


def rms(samples: NDArray[np.floating]) -> float:
    """Return the root mean square."""
    return float(np.sqrt(np.mean(np.square(samples, dtype=np.float64)) + 1e-12))


def at_level_of(samples: NDArray[np.floating], like: Audio) -> Audio:
    """Return samples with the root mean square of others, within [-1, 1]."""
    scaled = samples * (rms(like) / rms(samples))
    return np.asarray(np.clip(scaled, -1.0, 1.0), np.float32)


def _level(db: float) -> float:
    return float(10.0 ** (db / 20.0))


# --- rooms and microphones -----------------------------------------------------------------


def in_room(speech: Audio, rt60_s: float, direct_db: float, rng: Generator) -> Audio:
    """Return speech with reverberation: noise that decays by 60 dB in a time (Polack, 1988).

    Parameters
    ----------
    direct_db
        Energy of the direct sound above that of the reverberation.
    """
    size = int(rt60_s * SAMPLE_RATE_HZ)
    tail = rng.standard_normal(size) * 10.0 ** (-3.0 * np.arange(size) / size)
    tail[: SAMPLE_RATE_HZ // 1000] = 0.0
    tail *= _level(-direct_db) / np.sqrt(np.sum(tail**2) + 1e-12)
    tail[0] = 1.0
    return at_level_of(fftconvolve(speech, tail)[: len(speech)], speech)


def through_microphone(speech: Audio, rng: Generator) -> Audio:
    """Return speech through a microphone with a smooth random response, 4 dB per octave point."""
    edges = np.array([0.0, 100.0, 200.0, 400.0, 800.0, 1600.0, 3200.0, 6400.0, 8000.0])
    gains_db = rng.normal(0.0, 4.0, len(edges))
    gains_db[0] = -40.0
    grid = np.linspace(0.0, SAMPLE_RATE_HZ / 2.0, 129)
    gains = 10.0 ** (np.interp(grid, edges, gains_db) / 20.0)
    response = firwin2(TAPS, grid, gains, fs=SAMPLE_RATE_HZ)
    return at_level_of(fftconvolve(speech, response, mode="same"), speech)


def with_resonance(speech: Audio, frequency_hz: float, gain_db: float, quality: float) -> Audio:
    """Return speech with one frequency raised (R. Bristow-Johnson, Audio EQ Cookbook)."""
    angle = 2.0 * np.pi * frequency_hz / SAMPLE_RATE_HZ
    alpha, root = np.sin(angle) / (2.0 * quality), 10.0 ** (gain_db / 40.0)
    above = [1.0 + alpha * root, -2.0 * np.cos(angle), 1.0 - alpha * root]
    below = [1.0 + alpha / root, -2.0 * np.cos(angle), 1.0 - alpha / root]
    return at_level_of(sosfilt(tf2sos(above, below), speech), speech)


def clipped(speech: Audio, drive_db: float) -> Audio:
    """Return speech whose peaks are cut off, by a microphone amplifier that is driven too hard."""
    peak = float(np.max(np.abs(speech))) + 1e-9
    return at_level_of(np.clip(speech * _level(drive_db) / peak, -1.0, 1.0), speech)


def pumped(speech: Audio, release_s: float, strength: float) -> Audio:
    """Return speech as an automatic gain control leaves it: quiet parts rise after loud ones.

    Parameters
    ----------
    strength
        Share of the level in dB that is evened out, in [0, 1].
    """
    decay = np.exp(-1.0 / (release_s * SAMPLE_RATE_HZ))
    level = lfilter([1.0 - decay], [1.0, -decay], np.abs(speech))
    return at_level_of(speech * (level + 0.05 * level.max() + 1e-6) ** -strength, speech)


# --- codecs ----------------------------------------------------------------------------------


def _narrow(speech: Audio) -> Samples:
    return np.asarray(np.clip(resample_poly(np.asarray(speech, np.float64), 1, 2), -1.0, 1.0))


def _wide(speech: Samples, like: Audio) -> Audio:
    return at_level_of(resample_poly(speech, 2, 1)[: len(like)], like)


def mu_law(speech: Audio) -> Audio:
    """Return speech after eight bits of mu-law at 8 kHz (ITU-T G.711, as a formula)."""
    narrow, mu = _narrow(speech), 255.0
    coded = np.rint(np.sign(narrow) * np.log1p(mu * np.abs(narrow)) / np.log1p(mu) * 127.0) / 127.0
    return _wide(np.sign(coded) * np.expm1(np.abs(coded) * np.log1p(mu)) / mu, speech)


def a_law(speech: Audio) -> Audio:
    """Return speech after eight bits of A-law at 8 kHz (ITU-T G.711, as a formula)."""
    narrow, a = _narrow(speech), 87.6
    whole = 1.0 + np.log(a)
    size = np.abs(narrow)
    large = 1.0 + np.log(np.maximum(a * size, 1.0))
    coded = np.rint(np.where(size < 1.0 / a, a * size, large) / whole * 127.0) / 127.0 * whole
    decoded = np.where(coded < 1.0, coded, np.exp(coded - 1.0)) / a
    return _wide(np.sign(narrow) * decoded, speech)


def adpcm(speech: Audio) -> Audio:
    """Return speech after four bits of ADPCM at 8 kHz (IMA, 1992)."""
    guess, index, out = 0, 0, []
    for sample in np.rint(_narrow(speech) * 32767.0).astype(int).tolist():
        step = ADPCM_STEPS[index]
        size = min(7, abs(sample - guess) * 4 // step)
        change = (2 * size + 1) * step // 8
        guess = max(-32768, min(32767, guess + (change if sample >= guess else -change)))
        index = max(0, min(len(ADPCM_STEPS) - 1, index + ADPCM_CHANGES[size]))
        out.append(guess)
    return _wide(np.array(out) / 32768.0, speech)


# --- keys and pauses ---------------------------------------------------------------------------


def spoken_part(speech: Audio) -> tuple[int, int]:
    """Return the first and the last sample that are louder than a fiftieth of the peak."""
    loud = np.flatnonzero(np.abs(speech) > 0.02 * np.max(np.abs(speech), initial=1e-9))
    return (int(loud[0]), int(loud[-1])) if len(loud) else (0, max(0, len(speech) - 1))


def keyed(speech: Audio, rng: Generator) -> Audio:
    """Return speech whose beginning and end a key has cut off, most often by very little."""
    first, last = spoken_part(speech)
    most = min(MOST_CUT_S * SAMPLE_RATE_HZ, MOST_CUT_SHARE * (last - first))
    early, late = (rng.triangular(0.0, 0.0, max(most, 1.0), 2)).astype(int)
    return speech[first + early : max(last + 1 - late, first + early + 1)]


def hesitating(speech: Audio, pauses: int, rng: Generator) -> Audio:
    """Return speech with pauses of 0.15 s to 0.8 s where it is quiet."""
    first, last = spoken_part(speech)
    level = uniform_filter1d(np.abs(speech), SAMPLE_RATE_HZ // 25)
    inner = level[first : last + 1]
    quiet = first + np.flatnonzero(inner <= np.quantile(inner, 0.03))
    for at in sorted(rng.choice(quiet, pauses), reverse=True):
        size = int(rng.uniform(0.15, 0.8) * SAMPLE_RATE_HZ)
        speech = np.concatenate([speech[:at], np.zeros(size, np.float32), speech[at:]])
    return speech


def with_hot_microphone(speech: Audio, rng: Generator) -> Audio:
    """Return speech with up to 2.5 s before and after it, in which only noise is heard."""
    before, after = (rng.uniform(0.2, 2.5, 2) * SAMPLE_RATE_HZ).astype(int)
    padded = np.pad(speech, (before, after))
    noise = _coloured(len(padded), rng.uniform(0.8, 0.99), rng)
    return _added(padded, noise, float(rng.uniform(-45.0, -22.0)), rms(speech))


# --- other sounds ------------------------------------------------------------------------------


def with_hum(speech: Audio, frequency_hz: float, level_db: float, rng: Generator) -> Audio:
    """Return speech with the hum of a supply and five harmonics."""
    time_s = np.arange(len(speech)) / SAMPLE_RATE_HZ
    hum = sum(
        rng.uniform(0.1, 1.0) / order
        * np.sin(2.0 * np.pi * (frequency_hz * order * time_s + rng.random()))
        for order in range(1, 7)
    )  # fmt: skip
    return _added(speech, np.asarray(hum), level_db, rms(speech))


def with_engine(speech: Audio, level_db: float, rng: Generator) -> Audio:
    """Return speech over a propeller or a rotor: coloured noise that beats with the blades.

    Blades pass 10 to 25 times a second in helicopters and 60 to 110 times with propellers.
    """
    rate_hz = rng.uniform(10.0, 25.0) if rng.random() < 0.5 else rng.uniform(60.0, 110.0)
    time_s = np.arange(len(speech)) / SAMPLE_RATE_HZ
    beat = np.sin(2.0 * np.pi * (rate_hz * time_s + rng.random()))
    noise = _coloured(len(speech), rng.uniform(0.7, 0.98), rng)
    engine = noise * (1.0 + rng.uniform(0.2, 1.0) * beat) + rng.uniform(0.0, 0.5) * beat**3
    return _added(speech, engine, level_db, rms(speech))


def with_babble(speech: Audio, other: Audio, level_db: float, rng: Generator) -> Audio:
    """Return speech with another call far beneath it, from a loudspeaker or another frequency."""
    if not len(other):
        return speech
    start = int(rng.integers(0, len(speech)))
    beneath = np.zeros(len(speech))
    heard = other[: len(speech) - start]
    beneath[start : start + len(heard)] = heard * (rms(speech) / rms(other))
    return np.asarray(np.clip(speech + _level(level_db) * beneath, -1.0, 1.0), np.float32)


def _coloured(size: int, darkness: float, rng: Generator) -> Samples:
    """Return noise that falls with frequency, of root mean square one."""
    noise = lfilter([1.0], [1.0, -darkness], rng.standard_normal(size))
    return np.asarray(noise / rms(noise))


def _added(speech: Audio, sound: Samples, level_db: float, like_rms: float) -> Audio:
    added = sound * (like_rms * _level(level_db) / rms(sound))
    return np.asarray(np.clip(speech + added, -1.0, 1.0), np.float32)
