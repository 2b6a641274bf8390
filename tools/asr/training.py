"""Settings of a training of the recogniser, and the options that give them."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Training:
    """Settings of a training.

    Attributes
    ----------
    build
        Folder with ``pieces.txt`` and the prepared shards in ``train``.
    into
        Folder of the checkpoint; a training goes on from the one that is there.
    batch_frames
        Frames of a batch, about.
    without
        Lineage that is left out; empty for none.
    begin_with
        Folder of `keep` whose weights a new training begins with; None: random ones.
    bfloat16
        Whether convolutions are computed in bfloat16, which accelerators and processors with
        AVX512-BF16 do faster.
    device
        Device of torch: ``cpu`` or ``cuda``. On an accelerator, the same seed gives weights that
        differ a little from run to run, because it sums in another order each time.
    minutes
        Time in which the training ends, if it is not done before: the learning rate then falls
        with the time instead of with the steps. Over zero; what an interrupted training took
        counts.
    adamw
        Whether AdamW trains all weights, instead of Muon the matrices inside. Muon computes in
        bfloat16, with which a step takes 14 s on a processor that does not know it.
    """

    build: Path
    into: Path
    steps: int
    rate: float = 1.5e-3
    seed: int = 0
    batch_frames: int = 12_000
    without: str = ""
    begin_with: Path | None = None
    bfloat16: bool = False
    device: str = "cpu"
    minutes: float = math.inf
    adamw: bool = False

    def __post_init__(self) -> None:
        """Refuse a training of no time."""
        if not self.minutes > 0.0:
            raise SystemExit(f"training: --minutes {self.minutes:g}; expected more than 0")


def add_options(
    parser: argparse.ArgumentParser,
    steps: int,
    *,
    rate: float = Training.rate,
    batch_frames: int = Training.batch_frames,
) -> None:
    """Add the options of a training, as `Training` has them."""
    parser.add_argument("--steps", type=int, default=steps)
    parser.add_argument("--rate", type=float, default=rate, help="highest learning rate")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--batch-frames", type=int, default=batch_frames, help="frames of a batch")
    parser.add_argument("--bfloat16", action="store_true", help="faster on CUDA and AVX512-BF16")
    parser.add_argument("--adamw", action="store_true", help="without Muon, which needs bfloat16")
    parser.add_argument("--device", default="cpu", help="device of torch, such as cuda")
    parser.add_argument("--minutes", type=float, default=math.inf, help="end within so long")


def options_of(given: Mapping[str, Any]) -> list[str]:
    """Return the arguments that `add_options` reads as these values."""
    arguments = []
    for name, value in given.items():
        option = f"--{name.replace('_', '-')}"
        if value is True:
            arguments.append(option)
        elif value is not False:
            arguments += [option, str(value)]
    return arguments
