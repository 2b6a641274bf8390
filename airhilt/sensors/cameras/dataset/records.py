"""The record of an export: one line of JSON a picture, from which all formats are written."""

from __future__ import annotations

import io
import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from airhilt._version import __version__
from airhilt.errors import CameraError
from airhilt.host.files import replace_file
from airhilt.imaging.masks import Mask, runs_of
from airhilt.messages import VisibleClass
from airhilt.sensors.cameras.dataset.pictures import Picture
from airhilt.sensors.cameras.frame import Frame, Sighting
from airhilt.units import DEGREE, SECOND_NS

FIRST_CLASSES: tuple[VisibleClass, ...] = ("airplane", "truck", "bird", "deer", "coyote")
"""Classes whose categories have the ids from 1, so that data sets of AIRHILT's own kinds agree.

Classes of other kinds follow in the order of their names."""
QUALITY = 95
"""Quality of the JPEGs; colours are not subsampled."""
FAINTEST_PX = 0.5
"""Least area, in pixels, of a body that is annotated."""
SETTINGS = "export.json"
LINES = "pictures.jsonl"


class Records:
    """The pictures of an export so far; an export that was stopped goes on behind them.

    Attributes
    ----------
    settings
        What the pictures were made with; an export with others does not go on.
    count
        Number of pictures.

    Raises
    ------
    CameraError
        The folder holds something else, or an export with other settings.
    """

    def __init__(self, folder: Path, settings: Mapping[str, Any]) -> None:
        self.folder = folder
        self.settings = json.loads(json.dumps({"version": __version__, **settings}))
        self.count = 0
        if folder.exists() and any(folder.iterdir()):
            self._require_same()
            self.count = self._drop_unfinished_line()

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """Return the record of each picture: ``image`` and ``annotations``, as in COCO."""
        with (self.folder / LINES).open(encoding="utf-8") as lines:
            for line in lines:
                yield json.loads(line)

    def add(self, picture: Picture, has_depth: bool) -> None:
        """Write a picture and what is true of it."""
        number = self.count + 1
        name = f"images/{number:06}.jpg"
        image = {"id": number, "file_name": name, **_about(picture)}
        if has_depth:
            image["depth"] = f"depth/{number:06}.npz"
            _write(self.folder / image["depth"], _npz(picture.frame))
        _write(self.folder / name, _jpeg(picture.frame))
        if not self.count:
            replace_file(self.folder / SETTINGS, json.dumps(self.settings).encode())
        line = {"image": image, "annotations": _annotations(picture)}
        with (self.folder / LINES).open("a", encoding="utf-8") as lines:
            lines.write(json.dumps(line, separators=(",", ":")) + "\n")
        self.count = number

    def balance(self) -> Balance:
        """Return how many pictures, worlds and bodies of each class there are in each split."""
        return Balance.of(self)

    def _require_same(self) -> None:
        path = self.folder / SETTINGS
        if not path.is_file():
            raise CameraError(
                f"{self.folder} is not empty; expected a new folder, or one of an export to go on "
                "with: choose another --out"
            )
        found = json.loads(path.read_bytes())
        for name in sorted({*found, *self.settings}):
            if found.get(name) != self.settings.get(name):
                raise CameraError(
                    f"{self.folder} holds an export with {name} {found.get(name)!r}; expected "
                    f"{self.settings.get(name)!r} to go on with it: choose another --out"
                )

    def _drop_unfinished_line(self) -> int:
        path = self.folder / LINES
        data = path.read_bytes() if path.is_file() else b""
        whole = data[: data.rfind(b"\n") + 1]
        if whole != data:
            replace_file(path, whole)
        return whole.count(b"\n")


class Balance:
    """Numbers of pictures, worlds and bodies of a data set.

    Attributes
    ----------
    bodies
        Number of bodies by split and class.
    pictures, worlds
        Numbers by split.
    """

    def __init__(self) -> None:
        self.bodies: Counter[tuple[str, VisibleClass]] = Counter()
        self.pictures: Counter[str] = Counter()
        self.worlds: Counter[str] = Counter()

    @classmethod
    def of(cls, records: Iterable[Mapping[str, Any]]) -> Balance:
        """Return that of some pictures."""
        found, worlds = cls(), set()
        for record in records:
            image = record["image"]
            found.pictures[image["split"]] += 1
            worlds.add((image["split"], image["world"]))
            found.bodies.update((image["split"], each["class"]) for each in record["annotations"])
        found.worlds.update(split for split, _ in worlds)
        return found

    @property
    def classes(self) -> tuple[VisibleClass, ...]:
        """Classes of the data set; a category's id is its place here, from 1."""
        others = {label for _, label in self.bodies} - set(FIRST_CLASSES)
        return (*FIRST_CLASSES, *sorted(others))

    def table(self) -> list[list[str]]:
        """Return the numbers in rows, the first of which has the names of the splits."""
        splits = sorted(self.pictures)
        rows = [("pictures", self.pictures), ("worlds", self.worlds)]
        return [
            ["", *splits],
            *([name, *(str(counts[split]) for split in splits)] for name, counts in rows),
            *([label, *(str(self.bodies[split, label]) for split in splits)]
              for label in self.classes),
        ]  # fmt: skip


def run_lengths(mask: Mask) -> dict[str, list[int]]:
    """Return a mask as COCO's uncompressed run lengths: column by column, the first one free."""
    counts = runs_of(np.ascontiguousarray(mask.T)) or (mask.size,)
    return {"size": list(mask.shape), "counts": list(counts)}


def _write(path: Path, data: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    replace_file(path, data)


def _jpeg(frame: Frame) -> bytes:
    buffer = io.BytesIO()
    image = Image.fromarray(frame.colour)
    image.save(buffer, format="JPEG", quality=QUALITY, subsampling=0)
    return buffer.getvalue()


def _npz(frame: Frame) -> bytes:
    """Return the depths along the optical axis, in m, as float32; infinite in the sky."""
    view = frame.view
    x, y = view.on_focal_plane(*view.sample_places(view.whole, 1))
    depth = frame.distance_m / np.sqrt(x * x + y * y + np.float32(1.0))
    buffer = io.BytesIO()
    np.savez_compressed(buffer, depth_m=depth)
    return buffer.getvalue()


def _about(picture: Picture) -> dict[str, Any]:
    frame, lens = picture.frame, picture.frame.view.intrinsics
    own = {}
    if picture.carrier is not None:
        number_of_own = picture.actors.index(picture.carrier) + 1
        own = {"own_aircraft": run_lengths(frame.instance == number_of_own)}
    return {
        "width": lens.width_px,
        "height": lens.height_px,
        "world": picture.world,
        "split": picture.split,
        "sequence": picture.sequence,
        "step": picture.step,
        "t_s": frame.t_ns / SECOND_NS,
        "camera": frame.camera,
        "horizontal_fov_deg": round(lens.horizontal_fov_rad / DEGREE, 3),
        "calibration": {
            "focal_px": lens.focal_px,
            "principal_point_px": [lens.width_px / 2.0, lens.height_px / 2.0],
            "position_m": list(frame.view.pose.position_m),
            "rotation": frame.view.axes.tolist(),
        },
        **picture.about,
        **own,
    }


def _annotations(picture: Picture) -> list[dict[str, Any]]:
    found = []
    for sighting in picture.frame.sightings:
        mask = picture.frame.instance == picture.actors.index(sighting.actor) + 1
        if sighting.pixels >= FAINTEST_PX and mask.any():
            found.append(_annotation(sighting, mask))
    return found


def _annotation(sighting: Sighting, mask: Mask) -> dict[str, Any]:
    left, top, right, bottom = sighting.box
    return {
        "class": sighting.label,
        "bbox": [round(value, 2) for value in (left, top, right - left, bottom - top)],
        "area": int(mask.sum()),
        "segmentation": run_lengths(mask),
        "iscrowd": 0,
        "actor": sighting.actor,
        "range_m": round(sighting.range_m, 1),
        "visible_fraction": round(sighting.visible_fraction, 3),
        "truncation": round(sighting.truncation, 3),
        "transmission": round(sighting.transmission, 4),
    }
