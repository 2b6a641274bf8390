"""Batches of a training of the recogniser: which calls, mixed anew each time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from airhilt.assistant.asr.features import BINS, FLOOR
from mel_shards import MelCalls
from mixing import ANY, CLEAR, EASY, Drawn, Mixer

EASY_SHARE = 0.05
"""Part of a training from random weights, at its beginning, that has short, clear calls only."""
CLEAR_SHARE = 0.2
"""Part of it in which no call has much noise."""
NEIGHBOURS = 0.02
"""Share of the calls, those of about one length, that a batch is drawn from."""
EASY_FRAMES = 450
"""Frames of the longest call that is easy."""
SILENT_SHARE = 0.3
"""Share of the batches with a call in which nobody speaks."""
SILENT_FRAMES = (30, 500)
"""Fewest and most frames of a call in which nobody speaks; it is no longer than the others."""


class Batch(NamedTuple):
    """Calls of about one length, and what is said in them."""

    features: Tensor
    """Shape (calls, frames, bins); calls that are shorter end with zeros."""
    lengths: Tensor
    """Frames of each call."""
    units: Tensor
    """Units of all calls, one after another."""
    sizes: Tensor
    """Number of units of each call."""


class Batches:
    """The batches of a training: each follows from the seed, its step, and its share of the way.

    So a training that goes on sees what it would have seen.

    Parameters
    ----------
    calls
        At least one.
    noise
        Mel powers of receivers' noise, as `Mixer` takes them.
    frames
        Frames of a batch, about.
    device
        Device of torch on which calls are kept and mixed.
    """

    def __init__(
        self,
        calls: MelCalls,
        noise: NDArray[np.float32],
        frames: int,
        seed: int,
        device: str = "cpu",
    ) -> None:
        self._lengths, self._units, self._is_received = (
            calls.lengths, calls.units, calls.is_received
        )  # fmt: skip
        self._begins = np.concatenate([[0], np.cumsum(calls.lengths)])
        order = np.argsort(calls.lengths, kind="stable")
        is_short = (calls.lengths[order] < EASY_FRAMES) & ~calls.is_received[order]
        self._all = order
        self._easy = order[is_short] if is_short.any() else order
        self._frames, self._seed = frames, seed
        silence = torch.full((SILENT_FRAMES[1], BINS), float(np.log(FLOOR)), dtype=torch.float16)
        logarithms = torch.cat([torch.from_numpy(calls.logarithms), silence]).to(device)
        self._mixer = Mixer(logarithms, torch.from_numpy(noise).to(device))

    def batch(self, step: int, share: float) -> Batch:
        """Return the batch of a step that is so far on the way of the training, in [0, 1].

        A call is drawn by the chance of its length, and with it others of about that length: as
        many as fill the batch. So each call is drawn as often as any other.
        """
        rng = np.random.default_rng([self._seed, step])
        easy = share < EASY_SHARE
        chosen = self._choose(self._easy if easy else self._all, rng)
        begins, lengths = self._begins[chosen], self._lengths[chosen]
        is_received = self._is_received[chosen]
        units = [self._units[each] for each in chosen]
        has_silence = not easy and rng.random() < SILENT_SHARE
        if has_silence:
            begins = np.append(begins, self._begins[-1])
            longest = min(SILENT_FRAMES[1], max(SILENT_FRAMES[0], int(lengths.max())))
            lengths = np.append(lengths, rng.integers(SILENT_FRAMES[0], longest + 1))
            is_received = np.append(is_received, False)
            units.append(())
        is_silent = np.zeros(len(begins), np.bool_)
        is_silent[len(chosen) :] = True
        sound = EASY if easy else CLEAR if share < CLEAR_SHARE else ANY
        features, own = self._mixer.mix(
            Drawn(*map(torch.from_numpy, (begins, lengths, is_received, is_silent))),
            sound,
            torch.Generator().manual_seed(int(rng.integers(2**62))),
        )
        return Batch(
            features,
            own.cpu(),
            torch.tensor([unit for each in units for unit in each], dtype=torch.long),
            torch.tensor([len(each) for each in units]),
        )

    def _choose(self, drawn_from: NDArray[np.int64], rng: np.random.Generator) -> NDArray[np.int64]:
        """Return which calls a batch has."""
        ends = np.cumsum(self._lengths[drawn_from])
        middle = int(np.searchsorted(ends, rng.integers(ends[-1]), side="right"))
        count = max(1, self._frames // int(self._lengths[drawn_from[middle]]))
        around = max(count, round(NEIGHBOURS * len(drawn_from)))
        begin = min(max(0, middle - around // 2), max(0, len(drawn_from) - around))
        near = drawn_from[begin : begin + around]
        return rng.permutation(near)[:count]
