"""Exports pictures with their truth to a folder, and goes on with an export that was stopped."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from airhilt.errors import CameraError
from airhilt.sensors.cameras.dataset import coco, datasheet, mot, yolo
from airhilt.sensors.cameras.dataset.pictures import Picture
from airhilt.sensors.cameras.dataset.records import Balance, Records

FORMATS: Mapping[str, Callable[[Records], None]] = {
    "coco": coco.write,
    "yolo": yolo.write,
    "mot": mot.write,
}


def export(
    take: Callable[[int], Iterable[Picture]],
    folder: Path,
    settings: Mapping[str, Any],
    formats: Sequence[str] = ("coco",),
    has_depth: bool = False,
) -> Balance:
    """Write pictures and the truth about them, and return how many of what there are.

    If the export stops early, the annotations of the pictures written so far are complete, and the
    next export to that folder goes on. Nothing is written before the first picture.

    Parameters
    ----------
    take
        Returns the pictures behind a number of first ones.
    settings
        What the pictures are made with.

    Raises
    ------
    AirhiltError
        The folder holds something else or cannot be written, or pictures cannot be drawn.
    """
    try:
        records = Records(folder, settings)
        try:
            for picture in take(records.count):
                records.add(picture, has_depth)
        finally:
            if records.count:
                for write in (*(FORMATS[name] for name in formats), datasheet.write):
                    write(records)
    except OSError as error:
        raise CameraError(
            f"{folder}: cannot be written: {error.strerror}; make room, or choose another --out"
        ) from None
    return records.balance() if records.count else Balance()
