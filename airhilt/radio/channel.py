"""The VHF channel: what becomes of speech between a microphone and somebody else's headset.

Double-sideband amplitude modulation (ICAO Annex 10 volume III part II, 2.1 to 2.3): the audio
band is narrow, the receiver's gain follows the carrier, noise comes through at a level that
depends on the received power, and two carriers at once whistle.

The signal-to-noise ratio is that of speech to noise within the audio band, over the time in
which somebody speaks (`active`), and is met exactly before the receiver's gain control.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft

from airhilt.errors import SpeechError
from airhilt.radio.voices.engine import SAMPLE_RATE_HZ, Audio

Background = Literal["cockpit", "tower", "none"]
"""What else the microphone picks up."""

LEVEL_RMS = 0.1
"""Of active speech in what is received: -20 dB of full scale, as ITU-T P.56 recommends levels."""
_FRAME = SAMPLE_RATE_HZ // 50
_MARGIN = 10.0**-1.59
"""Below the active level by 15.9 dB, a frame is a pause (ITU-T P.56, 5.2)."""
_BLOCKED_LEVEL_DB = 3.0
"""Spread of the received powers of two that talk at once."""


@dataclass(frozen=True)
class ChannelProfile:
    """One kind of radio. The attributes in dB are relative to active speech."""

    name: str
    low_hz: float
    high_hz: float
    order: int = 6
    """Of the Butterworth band-pass."""
    cockpit_db: float = -28.0
    tower_db: float = -40.0
    microphone_drive: float = 1.5
    """How far speech is driven into the limiter of the transmitter (tanh)."""
    fade_db: float = 0.0
    """Depth of slow fading."""
    fade_hz: float = 0.3
    gain_control: float = 0.6
    """0: none; 1: the receiver evens all levels out."""
    squelch_tail_s: float = 0.12
    wet: float = 1.0
    """Share of the channel in what is heard; the rest is the voice as it was spoken."""


PROFILES: dict[str, ChannelProfile] = {
    profile.name: profile
    for profile in (
        ChannelProfile("vhf", 300.0, 3_400.0),
        ChannelProfile("vhf_833", 300.0, 2_500.0),
        ChannelProfile("fading", 300.0, 3_400.0, fade_db=8.0),
        ChannelProfile("noisy_cockpit", 300.0, 3_400.0, cockpit_db=-15.0, microphone_drive=2.5),
        ChannelProfile(
            "line",
            50.0,
            7_500.0,
            order=2,
            cockpit_db=-60.0,
            tower_db=-60.0,
            microphone_drive=0.1,
            gain_control=0.0,
            squelch_tail_s=0.0,
        ),
    )
}
"""25 kHz VHF, 8.33 kHz VHF, VHF at the edge of coverage, a loud cockpit, and a wired line."""


class Channel(Protocol):
    """What takes speech from one to another."""

    @property
    def name(self) -> str:
        """In logs."""
        ...

    def transmit(
        self,
        speech: Audio,
        snr_db: float | None,
        rng: np.random.Generator,
        others: Sequence[tuple[Audio, int]] = (),
        background: Background = "none",
    ) -> Audio:
        """Return what is heard of ``speech``; at least as long as it.

        Parameters
        ----------
        snr_db
            Speech to noise; None leaves noise out.
        others
            Who talks at the same time: speech, and the sample of ours at which it begins.
        """
        ...


@dataclass(frozen=True)
class Parts:
    """What a receiver's detector gives, before gain control: wanted signal, and all else."""

    signal: Audio
    noise: Audio
    interference: Audio
    active: NDArray[np.bool_]


class VhfChannel:
    """A VHF channel of one profile."""

    def __init__(self, profile: ChannelProfile) -> None:
        self._profile = profile
        self.name = profile.name

    def transmit(
        self,
        speech: Audio,
        snr_db: float | None,
        rng: np.random.Generator,
        others: Sequence[tuple[Audio, int]] = (),
        background: Background = "none",
    ) -> Audio:
        """Return what is heard: the call, noise, and the squelch tail."""
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
        if profile.wet < 1.0:
            dry = np.zeros_like(heard)
            dry[: len(speech)] = _level(speech)[0]
            heard = profile.wet * heard + (1.0 - profile.wet) * dry
        return np.asarray(np.clip(heard, -1.0, 1.0), np.float32)

    def parts(
        self,
        speech: Audio,
        snr_db: float | None,
        rng: np.random.Generator,
        others: Sequence[tuple[Audio, int]] = (),
        background: Background = "none",
    ) -> Parts:
        """Return the parts of what is received, each as long as ``speech``.

        Raises
        ------
        SpeechError
            The speech is empty, or a sample or the ratio is no number.
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
        interference = np.zeros(count, np.float32)
        for other, offset in others:
            interference += self._interference(_checked(other), offset, count, rng)
        return Parts(signal, noise, interference, is_active)

    def _modulated(
        self, speech: Audio, rng: np.random.Generator, background: Background
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

    def _interference(
        self, other: Audio, offset: int, count: int, rng: np.random.Generator
    ) -> Audio:
        """Return somebody else's call where it lies over ours, shape (count,)."""
        placed = np.zeros(count, np.float32)
        overlap = other[max(-offset, 0) : max(count - offset, 0)]
        if not len(overlap):
            return placed
        signal, _ = self._modulated(overlap, rng, "none")
        gain = 10.0 ** (rng.uniform(-_BLOCKED_LEVEL_DB, _BLOCKED_LEVEL_DB) / 20.0)
        times_s = np.arange(len(signal), dtype=np.float32) / SAMPLE_RATE_HZ
        whistle = np.sin(2.0 * np.pi * rng.uniform(400.0, 1_200.0) * times_s, dtype=np.float32)
        begin = max(offset, 0)
        placed[begin : begin + len(signal)] = gain * signal + LEVEL_RMS * whistle
        return placed


def active(speech: Audio) -> NDArray[np.bool_]:
    """Return where somebody speaks, shape (n,), after ITU-T P.56, method B, in frames of 20 ms."""
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
    size = next_fast_len(len(samples) + _FRAME, real=True)
    frequency = np.maximum(np.fft.rfftfreq(size, 1.0 / SAMPLE_RATE_HZ), 1.0).astype(np.float32)
    steepness = 2 * profile.order
    response = 1.0 / np.sqrt(1.0 + (profile.low_hz / frequency) ** steepness)
    response /= np.sqrt(1.0 + (frequency / profile.high_hz) ** steepness)
    return np.asarray(irfft(rfft(samples, size) * response, size)[: len(samples)], np.float32)


def _fading(count: int, profile: ChannelProfile, rng: np.random.Generator) -> Audio:
    """Return a slowly varying gain."""
    phase = rng.uniform(0.0, 2.0 * np.pi, 3)
    rates = profile.fade_hz * np.array([1.0, 1.7, 0.4])
    times_s = np.arange(0, count + _FRAME, _FRAME) / SAMPLE_RATE_HZ
    swing = np.sin(2.0 * np.pi * rates[:, None] * times_s + phase[:, None]).mean(axis=0)
    gain = 10.0 ** (profile.fade_db * (swing - 0.5) / 20.0)
    evenly = np.interp(np.arange(count), np.arange(len(gain)) * _FRAME, gain)
    return np.asarray(evenly, np.float32)


def _surroundings(count: int, background: Background, rng: np.random.Generator) -> Audio:
    """Return the noise of a place, of power one: rumble and airflow, or a room's murmur."""
    size = next_fast_len(count, real=True)
    frequency = np.fft.rfftfreq(size, 1.0 / SAMPLE_RATE_HZ).astype(np.float32)
    corner = 400.0 if background == "cockpit" else 900.0
    shape = 1.0 / (1.0 + (frequency / corner) ** 2)
    shape[0] = 0.0
    noise = irfft(rfft(rng.standard_normal(size, np.float32)) * shape, size)[:count]
    if background == "cockpit":
        times_s = np.arange(count, dtype=np.float32) / SAMPLE_RATE_HZ
        hum = 400.0 + rng.uniform(-5.0, 5.0)
        noise = noise + 0.3 * noise.std() * np.sin(2.0 * np.pi * hum * times_s, dtype=np.float32)
    return np.asarray(noise / (noise.std() or 1.0), np.float32)


def _even_out(samples: Audio, strength: float) -> Audio:
    """Return samples whose level is drawn towards `LEVEL_RMS`, as gain control does."""
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
