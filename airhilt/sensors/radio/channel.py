"""The VHF channel between a microphone and the headset of a listener.

Double-sideband amplitude modulation (ICAO Annex 10 volume III part II, 2.1 to 2.3): the audio
band is narrow, the receiver's gain follows the carrier, noise comes through at a level that
depends on the received power, and two carriers at once whistle over all that is said.

The signal-to-noise ratio is that of speech to noise within the audio band, over the time in
which somebody speaks (`active`), and is met exactly before the receiver's gain control.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.audio.spectrum import fast_size
from airhilt.errors import SpeechError
from airhilt.scenario.radio_profiles import ChannelProfile
from airhilt.sensors.radio.on_air import BackgroundNoise

LEVEL_RMS = 0.1
"""RMS of active speech in the received audio: -20 dB of full scale, as ITU-T P.56 recommends."""
_FRAME = SAMPLE_RATE_HZ // 50
_MARGIN = 10.0**-1.59
"""Power of a pause, as a fraction of that of active speech: -15.9 dB (ITU-T P.56, 5.2)."""
PEAK_MODULATION = 0.85
"""Modulation depth that every transmitter reaches (ICAO Annex 10 volume III part II, chapter 2)."""
MODULATION = PEAK_MODULATION * 10.0 ** (-12.0 / 20.0)
"""RMS modulation depth of active speech: 0.21, because the peaks of speech lie some 12 dB above its
level (10 to 13 dB in what this channel makes of synthetic voices)."""
_OPEN_MICROPHONE = PEAK_MODULATION / 3.0
"""RMS modulation depth of noise where nobody speaks. A transmitter is to keep its average
modulation as high as it can (ibid.), and the peaks of noise are 3 sigma."""
WHISTLES_HZ = (400.0, 1_200.0)
"""Range of the difference between two carriers, in Hz. Airborne transmitters may be off by 5 parts
in a million where channels are 8.33 kHz wide (ibid.): two of them by at most 1.2 kHz at 120 MHz."""


class Other(NamedTuple):
    """Another transmission at the same time."""

    speech: Audio
    begin: int
    """Sample of the wanted transmission at which it begins."""
    whistle_hz: float
    """Difference of the two carriers."""


@dataclass(frozen=True)
class Parts:
    """Output of a receiver's detector before gain control: the wanted signal, and all else."""

    signal: Audio
    noise: Audio
    interference: Audio
    active: NDArray[np.bool_]


class VhfChannel:
    """A VHF channel of one profile: turns the speech of a speaker into the audio of a listener."""

    def __init__(self, profile: ChannelProfile) -> None:
        self._profile = profile
        self.name = profile.name
        """Name of the channel in logs."""

    def transmit(
        self,
        speech: Audio,
        snr_db: float | None,
        rng: np.random.Generator,
        others: Sequence[Other] = (),
        background: BackgroundNoise = "none",
        wet: float | None = None,
    ) -> Audio:
        """Return the received audio of ``speech``: the call, noise, and the squelch tail.

        Without a ``snr_db`` it has no noise. ``others`` are on the air at the same time. ``wet`` is
        the part of the channel in the sound (None: that of the channel); the rest is the voice as
        it was spoken.
        """
        profile = self._profile
        parts = self.parts(speech, snr_db, rng, others, background)
        heard = parts.signal + parts.noise + parts.interference
        heard = _even_out(heard, profile.gain_control)
        heard = np.tanh(2.0 * heard) / 2.0
        tail = round(profile.squelch_tail_s * SAMPLE_RATE_HZ)
        if tail:
            loudness = LEVEL_RMS * 10.0 ** (-(20.0 if snr_db is None else max(snr_db, 0.0)) / 40.0)
            burst = _band(rng.standard_normal(tail, np.float32), profile)
            heard = np.concatenate([heard, loudness * burst])
        heard = with_voice(heard, speech, profile.wet if wet is None else wet)
        return np.asarray(np.clip(heard, -1.0, 1.0), np.float32)

    def parts(
        self,
        speech: Audio,
        snr_db: float | None,
        rng: np.random.Generator,
        others: Sequence[Other] = (),
        background: BackgroundNoise = "none",
    ) -> Parts:
        """Return the parts of what is received, each as long as ``speech``.

        A SpeechError says that the speech is empty, or a sample or the ratio is no number.
        """
        speech = _checked(speech)
        if snr_db is not None and not np.isfinite(snr_db):
            raise SpeechError(f"radio channel: a signal-to-noise ratio of {snr_db} dB is no number")
        signal, is_active = self._modulated(speech, rng, background)
        count = len(signal)
        noise = np.zeros(count, np.float32)
        if snr_db is not None:
            noise = _band(rng.standard_normal(count, np.float32), self._profile)
            wanted = _power(signal, is_active) if is_active.any() else LEVEL_RMS**2
            noise *= np.sqrt(wanted / 10.0 ** (snr_db / 10.0) / _power(noise, is_active))
        interference = self.interference(signal, others, rng)
        return Parts(signal, noise, interference, is_active)

    def _modulated(
        self, speech: Audio, rng: np.random.Generator, background: BackgroundNoise
    ) -> tuple[Audio, NDArray[np.bool_]]:
        profile = self._profile
        levelled, is_active = _level(speech)
        if background != "none":
            level_db = profile.cockpit_db if background == "cockpit" else profile.tower_db
            surroundings = _surroundings(len(speech), background, rng)
            levelled = levelled + LEVEL_RMS * 10.0 ** (level_db / 20.0) * surroundings
        drive = profile.microphone_drive / (4.0 * LEVEL_RMS)
        signal = _band(np.tanh(drive * levelled) / drive, profile)
        if profile.fade_db:
            signal = signal * _fading(len(signal), profile, rng)
        if is_active.any():
            signal = signal * np.float32(LEVEL_RMS / np.sqrt(_power(signal, is_active)))
        return signal, is_active

    def interference(
        self, signal: Audio, others: Sequence[Other], rng: np.random.Generator
    ) -> Audio:
        """Return what other transmissions add to a detected signal, shape (count,).

        Carriers add up before the detector, which gives out the envelope of their sum, limited to
        that of one fully modulated carrier. All are assumed to be received equally strongly, and
        the others to come from cockpits. Their beat is nearly the whole carrier then, 7 to 9 dB
        above speech, which modulates it by `MODULATION`; only parts of words come through.
        """
        count = len(signal)
        field = (1.0 + MODULATION / LEVEL_RMS * signal).astype(np.complex64)
        begin, end = count, 0
        for other in others:
            overlap = _checked(other.speech)[max(-other.begin, 0) : max(count - other.begin, 0)]
            if not len(overlap):
                continue
            theirs, speaks = self._modulated(overlap, rng, "cockpit")
            depth = MODULATION / LEVEL_RMS
            if not speaks.any():
                depth = _OPEN_MICROPHONE / (theirs.std() or 1.0)
            first, after = max(other.begin, 0), max(other.begin, 0) + len(overlap)
            turns = other.whistle_hz / SAMPLE_RATE_HZ * np.arange(len(overlap))
            field[first:after] += np.exp(2j * np.pi * turns) * (1.0 + depth * theirs)
            begin, end = min(begin, first), max(end, after)
        placed = np.zeros(count, np.float32)
        if begin < end:
            envelope = np.abs(field[begin:end])
            audio = np.clip(envelope - envelope.mean(), -PEAK_MODULATION, PEAK_MODULATION)
            detected = _band(audio * np.float32(LEVEL_RMS / MODULATION), self._profile)
            placed[begin:end] = detected - signal[begin:end]
        return placed


def with_voice(heard: Audio, speech: Audio, wet: float) -> Audio:
    """Return what is heard of a channel, mixed with the voice as it was spoken, at the usual level.

    ``wet`` is the part of the channel, in [0, 1].
    """
    if wet == 1.0:
        return heard
    dry = np.zeros_like(heard)
    dry[: len(speech)] = _level(speech)[0]
    return wet * heard + (1.0 - wet) * dry


def active(speech: Audio) -> NDArray[np.bool_]:
    """Return which samples are speech, shape (n,): ITU-T P.56, method B, in frames of 20 ms."""
    count = -(-len(speech) // _FRAME)
    padded = np.zeros(count * _FRAME, np.float32)
    padded[: len(speech)] = speech
    powers = np.mean(padded.reshape(count, _FRAME) ** 2, axis=1)
    speaks = powers > 0.0
    for _ in range(6):
        if not speaks.any():
            break
        speaks = powers > _MARGIN * float(np.mean(powers[speaks]))
    return np.repeat(speaks, _FRAME)[: len(speech)]


def _checked(speech: Audio) -> Audio:
    samples = np.asarray(speech, np.float32)
    if samples.ndim != 1 or not len(samples):
        raise SpeechError(
            f"radio channel: expected mono samples, got an array of shape {samples.shape}"
        )
    if not np.isfinite(samples).all():
        raise SpeechError("radio channel: the speech has samples that are no numbers (NaN)")
    return samples


def _power(samples: Audio, where: NDArray[np.bool_]) -> float:
    chosen = samples[where] if where.any() else samples
    return float(np.mean(np.square(chosen, dtype=np.float64)))


def _level(speech: Audio) -> tuple[Audio, NDArray[np.bool_]]:
    is_active = active(speech)
    power = _power(speech, is_active)
    return (speech * np.float32(LEVEL_RMS / np.sqrt(power)) if power else speech), is_active


def _band(samples: Audio, profile: ChannelProfile) -> Audio:
    """Return samples with the magnitude response of a Butterworth band-pass, without its delay."""
    size = fast_size(len(samples) + _FRAME)
    frequency = np.maximum(np.fft.rfftfreq(size, 1.0 / SAMPLE_RATE_HZ), 1.0).astype(np.float32)
    steepness = 2 * profile.order
    response = 1.0 / np.sqrt(1.0 + (profile.low_hz / frequency) ** steepness)
    response /= np.sqrt(1.0 + (frequency / profile.high_hz) ** steepness)
    return np.asarray(
        np.fft.irfft(np.fft.rfft(samples, size) * response, size)[: len(samples)], np.float32
    )


def _fading(count: int, profile: ChannelProfile, rng: np.random.Generator) -> Audio:
    """Return a slowly varying gain."""
    phase = rng.uniform(0.0, 2.0 * np.pi, 3)
    rates = profile.fade_hz * np.array([1.0, 1.7, 0.4])
    times_s = np.arange(0, count + _FRAME, _FRAME) / SAMPLE_RATE_HZ
    swing = np.sin(2.0 * np.pi * rates[:, None] * times_s + phase[:, None]).mean(axis=0)
    gain = 10.0 ** (profile.fade_db * (swing - 0.5) / 20.0)
    evenly = np.interp(np.arange(count), np.arange(len(gain)) * _FRAME, gain)
    return np.asarray(evenly, np.float32)


def _surroundings(count: int, background: BackgroundNoise, rng: np.random.Generator) -> Audio:
    """Return the noise of a cockpit (rumble, airflow, hum) or of a tower, with power 1."""
    size = fast_size(count)
    frequency = np.fft.rfftfreq(size, 1.0 / SAMPLE_RATE_HZ).astype(np.float32)
    corner = 400.0 if background == "cockpit" else 900.0
    shape = 1.0 / (1.0 + (frequency / corner) ** 2)
    shape[0] = 0.0
    white = rng.standard_normal(size, np.float32)
    noise = np.fft.irfft(np.fft.rfft(white) * shape, size)[:count]
    if background == "cockpit":
        times_s = np.arange(count, dtype=np.float32) / SAMPLE_RATE_HZ
        hum = 400.0 + rng.uniform(-5.0, 5.0)
        noise = noise + 0.3 * noise.std() * np.sin(2.0 * np.pi * hum * times_s, dtype=np.float32)
    return np.asarray(noise / (noise.std() or 1.0), np.float32)


def _even_out(samples: Audio, strength: float) -> Audio:
    """Return samples after gain control, which brings their level closer to `LEVEL_RMS`."""
    if strength == 0.0:
        return samples
    count = -(-len(samples) // _FRAME)
    padded = np.zeros(count * _FRAME, np.float32)
    padded[: len(samples)] = samples
    powers = np.mean(padded.reshape(count, _FRAME) ** 2, axis=1)
    kernel = np.exp(-np.arange(25) / 8.0)
    level = np.sqrt(np.convolve(powers, kernel / kernel.sum())[:count])
    gain = (np.maximum(level, 0.02 * LEVEL_RMS) / LEVEL_RMS) ** -strength
    gain = np.minimum(gain, 6.0)
    centres = (np.arange(count) + 0.5) * _FRAME
    return samples * np.interp(np.arange(len(samples)), centres, gain).astype(np.float32)
