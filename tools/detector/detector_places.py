"""Places in pictures where a detector's first network sees something, and what is really there."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from rich.progress import track

import detector_disturbances
from airhilt.assistant.vision.detector import Found
from airhilt.assistant.vision.detectors.embedded import EmbeddedDetector
from airhilt.assistant.vision.worker import beside
from airhilt.imaging.boxes import centre, overlap, size_px
from airhilt.messages import Box
from detector_data import Body, Shot, read_folder
from detector_disturbances import half_disturbed
from detector_scratch import Pictures, contents, mark_of
from eval_detector import on_faint

LEAST_SCORE, MOST = 0.03, 20
"""Least first score of a place that is learnt from, and most such places in a picture."""
TRUE, FALSE = 0.3, 0.2
"""Overlaps from which a place is that of a body, and up to which it is not."""
NEAR_IT, NEAR_IT_PX = 0.3, 2.0
"""A place is that of a body too if their middles are no farther apart than such a part of the
longest side and so many pixels."""
ALIKE = 2.2
"""Times that the longest sides then differ, at most."""

Floats = npt.NDArray[np.float32]


@dataclass(frozen=True)
class Places:
    """Places in pictures that the first network names.

    Attributes
    ----------
    pictures
        Shape (pictures, rows, columns, 3).
    picture
        Picture of each place, shape (n,).
    boxes, scores
        Answers of the first network, shapes (n, 4) and (n,).
    labels
        0 for nothing, and 1 more than the place in `CLASSES` of what is there.
    truth
        Boxes of the bodies, where there are any; shape (n, 4).
    """

    pictures: Pictures
    picture: npt.NDArray[np.int64]
    boxes: Floats
    scores: Floats
    labels: npt.NDArray[np.int64]
    truth: Floats

    def __len__(self) -> int:
        return len(self.picture)


def places_of(folder: Path, network: Path, scratch: Path, seed: int) -> Places:
    """Return the places of a folder, from ``scratch`` if they are there.

    Every second picture is disturbed.
    """
    limits = repr((LEAST_SCORE, MOST, TRUE, FALSE, NEAR_IT, NEAR_IT_PX, ALIKE, seed)).encode()
    code = Path(detector_disturbances.__file__).read_bytes()
    mark = mark_of([limits, code, network.read_bytes(), contents(folder)])
    kept = scratch / f"{folder.name}-{mark}"
    names, file = kept.with_suffix(".npz"), kept.with_suffix(".u8")
    if not names.is_file():
        draws = seed, int(mark_of([contents(folder)]), 16)
        _write(names, file, read_folder(folder), EmbeddedDetector(network), draws)
    with np.load(names, allow_pickle=False) as data:
        return Places(
            np.memmap(file, np.uint8, "r", shape=tuple(data["shape"])),
            data["picture"],
            data["boxes"].astype(np.float32),
            data["scores"].astype(np.float32),
            data["labels"],
            data["truth"].astype(np.float32),
        )


def _write(
    path: Path,
    file: Path,
    shots: Sequence[Shot],
    detector: EmbeddedDetector,
    seed: tuple[int, ...],
) -> None:
    """Ask the first network about all pictures; ``path`` is there once all are in it."""
    rows: list[tuple[Any, ...]] = []
    shape = (len(shots), *shots[0].picture().shape)
    pictures = np.memmap(file, np.uint8, "w+", shape=shape)
    seen = half_disturbed(shots, seed)
    for index, (shot, picture) in enumerate(track(seen, path.name, len(shots), transient=True)):
        pictures[index] = picture
        rows += [(index, *row) for row in places_in(shot, detector.proposed(picture))]
    pictures.flush()
    names = ("picture", "boxes", "scores", "labels", "truth")
    arrays: dict[str, Any] = dict(zip(names, map(np.array, zip(*rows, strict=True)), strict=True))
    partial = path.with_suffix(".partial")
    with partial.open("wb") as target:
        np.savez(target, shape=shape, **arrays)
    partial.replace(path)


def places_in(shot: Shot, found: Sequence[Found]) -> Iterator[tuple[Box, float, int, Box]]:
    """Yield boxes, scores, labels and boxes of bodies of what teaches something."""
    counting = [body for body in shot.bodies if body.counts]
    sure = [one for one in found if one.confidence >= LEAST_SCORE][:MOST]
    for each in beside(shot.own_aircraft(), sure):
        near = [body for body in counting if is_at(body, each)]
        if near:
            body = max(near, key=lambda body: _likeness(body, each))
            yield each.box, each.confidence, 1 + body.label, body.box
        elif not on_faint(shot.bodies, each) and not any(
            overlap(body.box, each.box) > FALSE for body in counting
        ):
            yield each.box, each.confidence, 0, each.box


def is_at(body: Body, found: Found) -> bool:
    """Return whether a place is that of a body, though its box may be wrong."""
    if overlap(body.box, found.box) >= TRUE:
        return True
    apart = math.dist(centre(body.box), centre(found.box))
    times = size_px(found.box) / body.size_px
    return apart <= NEAR_IT * body.size_px + NEAR_IT_PX and 1.0 / ALIKE <= times <= ALIKE


def _likeness(body: Body, found: Found) -> tuple[float, float]:
    return overlap(body.box, found.box), -math.dist(centre(body.box), centre(found.box))
