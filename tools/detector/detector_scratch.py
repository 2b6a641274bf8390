"""Files in which the training of detectors keeps results that take long to compute."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt
from rich.progress import track

from detector_data import Shot

Pictures = npt.NDArray[np.uint8]


def mark_of(parts: Iterable[bytes]) -> str:
    """Return what changes with all that something is made of, for the name of its file."""
    return hashlib.sha256(b"".join(parts)).hexdigest()[:8]


def contents(folder: Path) -> bytes:
    """Return what changes with the pictures of a folder of `airhilt dataset export`."""
    return (folder / "annotations.json").read_bytes()


def decoded(shots: Sequence[Shot], path: Path) -> Pictures:
    """Return pictures of one size, shape (n, rows, columns, 3), from a file that then has them.

    It only gets its name once all are in it: one that is broken off is begun anew.
    """
    shape = (len(shots), *shots[0].picture().shape)
    if not path.is_file():
        partial = path.with_suffix(".partial")
        pictures = np.memmap(partial, np.uint8, "w+", shape=shape)
        for index, shot in enumerate(track(shots, path.name, transient=True)):
            pictures[index] = shot.picture()
        pictures.flush()
        partial.replace(path)
    return np.memmap(path, np.uint8, "r", shape=shape)
