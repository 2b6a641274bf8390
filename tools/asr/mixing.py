"""Mixes calls for the training of the recogniser: speed, timbre, rooms, noise, gain control.

All is done with mel powers and for a batch of calls at once, on any device of torch: an accelerator
mixes a hundred calls in the time that it trains with them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import torch
from torch import Tensor

from airhilt.assistant.asr.features import (
    BINS,
    FLOOR,
    LEAST_RANGE_DB,
    LONGEST_CLICK_FRAMES,
    LOUD_FRAMES,
    NEAR_FRAMES,
    QUIET,
    WHITE,
)

CHANGED_SHARE = 0.7
"""Share of the calls that each of the common changes is made to."""
FRAMES_MULTIPLE = 48
"""Frames of which each batch has a multiple, so that all its steps are whole."""
SPEECH_POWER = 0.01
"""Power of the speech of a received call, to which its noise is in proportion."""
TIME_MASKS, TIME_MASKED, MASK_FRAMES = 8, 0.3, 11
"""Pieces of time that may be masked in a call, the share that are, and their most frames."""
BAND_MASKS, BAND_MASKED, MASK_BINS = 2, 0.5, 7
"""The same of the bands."""
ROOM_SHARE, REVERBERATION_S, BENEATH_DB = 0.3, (0.05, 0.4), (0.0, 15.0)
"""Share of the calls in a room, its reverberation time, and how far its sound is beneath speech."""
OTHER_SHARE, OTHER_DB = 0.06, (-28.0, -12.0)
"""Share of the calls beneath which another is heard, and its level."""
SMOOTH_SHARE = 0.25
"""Share of the calls whose bands are means of three, in which the pitch is not seen."""
MUCH_SHARE, SOME_SHARE = 0.55, 0.35
"""Shares of the calls with much noise, and with some; the others have none."""
MUCH_DB, SOME_DB, CLEAR_DB = (-4.0, 14.0), (14.0, 40.0), (12.0, 35.0)
"""Signal-to-noise ratios of these, and of the calls of a batch that is not noisy."""
GAIN_STRENGTH = (0.2, 0.7)
"""Exponents of an automatic gain control."""
GAIN_FRAMES, GAIN_TIME = 50, 16.0
"""Frames that a gain control looks back, and its time constant in frames."""
REVERBERATION_FRAMES = (1, 2, 4, 8, 16, 32)
"""Frames by which what is heard is added to itself: reverberation of 0.64 s in six steps."""
SPEED = (0.82, 1.22)
"""Factors of the speed of calls."""
SPEED_WANDER = 0.2
"""Share by which the speed wanders within a call, at most."""
WARP, SHIFT_BINS = (0.88, 1.14), 1.5
"""Factors of the distance of a band from the lowest, and shift in bands on both sides."""
TILT = 0.7
"""Amplitude of each of the waves over the bands by which a timbre differs: 3 dB."""


class Sound(NamedTuple):
    """Changes that calls may get."""

    is_changed: bool
    """True if some get another speed, timbre or room, or are masked in part."""
    is_noisy: bool
    """True if some have much noise."""


EASY, CLEAR, ANY = Sound(False, False), Sound(True, False), Sound(True, True)


@dataclass(frozen=True)
class Drawn:
    """Calls of a batch, as frames of one long row of mel powers.

    Attributes
    ----------
    begins, lengths
        First frame and number of frames of each call.
    is_received
        Whether a call has its noise already: it gets masks alone.
    is_silent
        Whether nobody speaks in it.
    """

    begins: Tensor
    lengths: Tensor
    is_received: Tensor
    is_silent: Tensor

    def to(self, device: str) -> Drawn:
        """Return the same on a device."""
        each = (self.begins, self.lengths, self.is_received, self.is_silent)
        return Drawn(*(one.to(device, non_blocking=True) for one in each))


class Mixer:
    """Makes what the network sees out of the mel powers of calls.

    Parameters
    ----------
    logarithms
        Logarithms of the mel powers of all calls, shape (frames, `BINS`).
    noise
        Mel powers of receivers' noise of power one, shape (kinds, frames, `BINS`).
    """

    def __init__(self, logarithms: Tensor, noise: Tensor) -> None:
        self._logarithms = logarithms
        self._noise = noise
        self._device = logarithms.device

    def mix(self, drawn: Drawn, sound: Sound, rng: torch.Generator) -> tuple[Tensor, Tensor]:
        """Return features, shape (calls, frames, `BINS`), and how many frames of each are its own.

        All that is drawn comes from a generator of the processor: the same on each device.
        """
        chance = _Chance(len(drawn.begins), rng, self._device)
        drawn = drawn.to(str(self._device))
        is_clean = ~drawn.is_received & ~drawn.is_silent
        log, lengths = self._at_other_speed(drawn, is_clean, sound, chance)
        count = log.shape[1]
        is_own = torch.arange(count, device=self._device) < lengths[:, None]
        log = _in_other_timbre(log, is_clean, sound, chance)
        power = log.exp() * is_own[:, :, None]
        power = _in_a_room(power, is_clean, sound, chance)
        power = power + _others(power, is_clean, sound, chance)
        power = power + self._noise_of(count, drawn, sound, chance)
        power = _gain_controlled(power, is_own, is_clean, sound, chance)
        features = normalised(power, is_own)
        features = _masked(features, lengths, sound, chance)
        return features * is_own[:, :, None], lengths

    def _at_other_speed(
        self, drawn: Drawn, is_clean: Tensor, sound: Sound, chance: _Chance
    ) -> tuple[Tensor, Tensor]:
        is_changed = is_clean & chance.of(CHANGED_SHARE * sound.is_changed)
        speed = torch.where(is_changed, chance.between(*SPEED), 1.0)
        lengths = ((drawn.lengths - 1) / speed).long() + 1
        longest = -(-int(lengths.max()) // FRAMES_MULTIPLE) * FRAMES_MULTIPLE
        time = torch.arange(longest, device=self._device)[None, :]
        waves = chance.whole(1, 7)
        wander = chance.between(-SPEED_WANDER, SPEED_WANDER) * is_changed
        angle = torch.pi * waves[:, None] * time / lengths[:, None]
        away = (wander * lengths / (torch.pi * waves))[:, None] * torch.sin(angle)
        at = ((time + away) * speed[:, None]).clamp(min=0.0)
        at = torch.minimum(at, (drawn.lengths - 1)[:, None].float())
        low = at.long()
        high = torch.minimum(low + 1, (drawn.lengths - 1)[:, None])
        part = (at - low)[:, :, None]
        first, second = (
            self._logarithms[drawn.begins[:, None] + frame].float() for frame in (low, high)
        )
        return first * (1.0 - part) + second * part, lengths

    def _noise_of(self, count: int, drawn: Drawn, sound: Sound, chance: _Chance) -> Tensor:
        kind = chance.between(0.0, 1.0)
        much, some = chance.between(*MUCH_DB), chance.between(*SOME_DB)
        has_some = kind < MUCH_SHARE + SOME_SHARE
        snr_db = torch.where(kind < MUCH_SHARE, much, torch.where(has_some, some, torch.inf))
        if not sound.is_noisy:
            snr_db = chance.between(*CLEAR_DB)
        power = SPEECH_POWER / 10.0 ** (snr_db / 10.0)
        power = torch.where(drawn.is_silent, 10.0 ** chance.between(-6.0, -1.0), power)
        power = torch.where(drawn.is_received, 0.0, power)
        kinds, size, _ = self._noise.shape
        time = torch.arange(count, device=self._device)[None, :]
        frames = (chance.whole(0, size)[:, None] + time) % size
        return self._noise[chance.whole(0, kinds)[:, None], frames] * power[:, None, None]


class _Chance:
    """Numbers drawn for each call of a batch."""

    def __init__(self, calls: int, rng: torch.Generator, device: torch.device) -> None:
        self._calls, self._rng, self._device = calls, rng, device

    def between(self, low: float, high: float, *shape: int) -> Tensor:
        """Return numbers between two, shape (calls, *shape)."""
        drawn = torch.rand(self._calls, *shape, generator=self._rng)
        return (low + (high - low) * drawn).to(self._device, non_blocking=True)

    def whole(self, low: int, end: int, *shape: int) -> Tensor:
        """Return whole numbers from one to another, which is not among them."""
        drawn = torch.randint(low, end, (self._calls, *shape), generator=self._rng)
        return drawn.to(self._device, non_blocking=True)

    def of(self, share: float, *shape: int) -> Tensor:
        """Return True for a share of the calls."""
        return self.between(0.0, 1.0, *shape) < share


def _in_other_timbre(log: Tensor, is_clean: Tensor, sound: Sound, chance: _Chance) -> Tensor:
    """Return speech of another length of the throat, through another microphone."""
    share = CHANGED_SHARE * sound.is_changed
    bands = torch.arange(BINS, device=log.device)
    is_warped = is_clean & chance.of(share)
    warp = torch.where(is_warped, chance.between(*WARP), 1.0)
    shift = chance.between(-SHIFT_BINS, SHIFT_BINS) * is_warped
    at = (bands * warp[:, None] + shift[:, None]).clamp(0.0, BINS - 1.001)
    low = at.long()[:, None, :].expand_as(log)
    part = (at - at.floor())[:, None, :]
    log = log.gather(2, low) * (1.0 - part) + log.gather(2, low + 1) * part
    waves = torch.arange(1, 5, device=log.device)[None, :, None]
    phases = chance.between(0.0, 2.0 * math.pi, 4)[:, :, None]
    sizes = chance.between(-TILT, TILT, 4) * (is_clean & chance.of(share))[:, None]
    tilt = (sizes[:, :, None] * torch.cos(torch.pi * waves * bands / BINS + phases)).sum(dim=1)
    log = log + tilt[:, None, :]
    beside = torch.nn.functional.avg_pool1d(log, 3, 1, 1, count_include_pad=False)
    is_smooth = (is_clean & chance.of(SMOOTH_SHARE * sound.is_changed))[:, None, None]
    return torch.where(is_smooth, beside, log)


def _in_a_room(power: Tensor, is_clean: Tensor, sound: Sound, chance: _Chance) -> Tensor:
    """Return speech with reverberation, which falls by 60 dB in its time."""
    is_in_room = is_clean & chance.of(ROOM_SHARE * sound.is_changed)
    decay = 10.0 ** (-6.0 * 0.01 / chance.between(*REVERBERATION_S))
    late = 10.0 ** (-chance.between(*BENEATH_DB) / 10.0) * is_in_room
    heard = power * ((1.0 - decay) * late)[:, None, None]
    for frames in REVERBERATION_FRAMES:
        before = torch.nn.functional.pad(heard, (0, 0, frames, 0))[:, : power.shape[1]]
        heard = heard + before * (decay**frames)[:, None, None]
    return power + heard


def _others(power: Tensor, is_clean: Tensor, sound: Sound, chance: _Chance) -> Tensor:
    """Return another call of the batch far beneath some of the calls."""
    is_heard = is_clean & chance.of(OTHER_SHARE * sound.is_changed)
    gain = 10.0 ** (chance.between(*OTHER_DB) / 10.0) * is_heard
    return power.roll(1, 0) * gain[:, None, None]


def _gain_controlled(
    power: Tensor, is_own: Tensor, is_clean: Tensor, sound: Sound, chance: _Chance
) -> Tensor:
    is_controlled = is_clean & chance.of(CHANGED_SHARE * sound.is_changed)
    strength = chance.between(*GAIN_STRENGTH) * is_controlled
    kernel = torch.exp(-torch.arange(GAIN_FRAMES, device=power.device) / GAIN_TIME)
    level = power.sum(dim=2)[:, None, :]
    behind = torch.nn.functional.pad(level, (GAIN_FRAMES - 1, 0))
    weights = (kernel / kernel.sum()).flip(0)[None, None, :]
    smooth = torch.nn.functional.conv1d(behind, weights)[:, 0]
    mean = (smooth * is_own).sum(dim=1, keepdim=True) / is_own.sum(dim=1, keepdim=True)
    gain = (smooth / (mean + FLOOR) + 1e-3) ** -strength[:, None]
    return power * gain[:, :, None]


def _masked(features: Tensor, lengths: Tensor, sound: Sound, chance: _Chance) -> Tensor:
    if not sound.is_changed:
        return features
    bands = torch.arange(BINS, device=features.device)[None, None, :]
    begin = chance.whole(0, BINS, BAND_MASKS)
    size = chance.whole(1, MASK_BINS + 1, BAND_MASKS) * chance.of(BAND_MASKED, BAND_MASKS)
    is_band = (bands >= begin[:, :, None]) & (bands < (begin + size)[:, :, None])
    time = torch.arange(features.shape[1], device=features.device)[None, None, :]
    begin = (chance.between(0.0, 1.0, TIME_MASKS) * lengths[:, None]).long()
    size = chance.whole(1, MASK_FRAMES + 1, TIME_MASKS) * chance.of(TIME_MASKED, TIME_MASKS)
    is_time = (time >= begin[:, :, None]) & (time < (begin + size)[:, :, None])
    is_masked = is_band.any(dim=1)[:, None, :] | is_time.any(dim=1)[:, :, None]
    return features.masked_fill(is_masked, 0.0)


# --- the features of the recogniser, for a batch -------------------------------------------


def normalised(power: Tensor, is_own: Tensor) -> Tensor:
    """Return what `airhilt.assistant.asr.features.normalised` returns of each call of a batch.

    Parameters
    ----------
    power
        Mel power, shape (calls, frames, `BINS`).
    is_own
        Frames that a call has, shape (calls, frames): the first ones, ten at least.
    """
    is_counted = is_near_speech(power, is_own)[:, :, None]
    counts = is_counted.sum(dim=1, keepdim=True)
    mean = (power.mean(dim=2, keepdim=True) * is_counted).sum(dim=1, keepdim=True) / counts
    white = torch.as_tensor(WHITE, device=power.device)
    log = torch.log(power + FLOOR + QUIET * mean * white)
    return log - (log * is_counted).sum(dim=1, keepdim=True) / counts


def is_near_speech(power: Tensor, is_own: Tensor) -> Tensor:
    """Return what `airhilt.assistant.asr.features.is_near_speech` returns of each call."""
    levels_db = 10.0 * torch.log10(_smooth(power.mean(dim=2), is_own) + FLOOR)
    lengths = is_own.sum(dim=1)
    ascending = torch.where(is_own, levels_db, torch.inf).sort(dim=1).values
    loud_db = ascending.gather(1, (lengths - LOUD_FRAMES).clamp(min=0)[:, None])
    at = 0.1 * (lengths - 1)[:, None]
    low, high = ascending.gather(1, at.long()), ascending.gather(1, at.ceil().long())
    quiet_db = low + (high - low) * (at - at.floor())
    is_loud = ((levels_db >= (loud_db + quiet_db) / 2.0) & is_own).float()[:, None]
    click = LONGEST_CLICK_FRAMES
    is_run = -torch.nn.functional.max_pool1d(-is_loud, click, 1)
    is_speech = torch.nn.functional.max_pool1d(
        torch.nn.functional.pad(is_run, (click - 1, click - 1)), click, 1
    )
    is_near = torch.nn.functional.max_pool1d(is_speech, 2 * NEAR_FRAMES + 1, 1, NEAR_FRAMES)[:, 0]
    has_pauses = (loud_db - quiet_db >= LEAST_RANGE_DB) & is_speech[:, 0].any(dim=1, keepdim=True)
    return torch.where(has_pauses, is_near > 0.0, True) & is_own


def _smooth(levels: Tensor, is_own: Tensor) -> Tensor:
    """Return the mean of five frames, with a call mirrored at its ends."""
    count = levels.shape[1]
    last = is_own.sum(dim=1, keepdim=True) - 1
    time = torch.arange(-2, count + 2, device=levels.device)[None, :]
    mirrored = torch.where(time < 0, -1 - time, time)
    mirrored = torch.where(mirrored > last, 2 * last + 1 - mirrored, mirrored)
    around = levels.gather(1, mirrored.clamp(0, count - 1))
    return torch.nn.functional.avg_pool1d(around[:, None], 5, 1)[:, 0]
