"""``pictures/``: the key pictures of a run.

There is a small one of each camera at the start, and one of the first detection, of the first
warning and of the closest approach.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection
from contextlib import suppress
from pathlib import Path
from typing import Literal, NamedTuple, get_args

from airhilt.errors import RendererError, RunFolderError, writing_to_run
from airhilt.host.files import make_folder
from airhilt.imaging.boxes import size_px
from airhilt.imaging.matching import matches
from airhilt.messages import (
    SPEAK_MIN_LEVEL,
    Advisory,
    CameraFrame,
    CameraTruth,
    Detections,
    Message,
    SightingTruth,
    Status,
)
from airhilt.sim.payload import Payload
from airhilt.units import SECOND_NS

Occasion = Literal["start", "first_detection", "first_warning", "closest_approach"]
OCCASIONS: tuple[Occasion, ...] = get_args(Occasion)
START_WIDTH_PX = 320
"""Width of the pictures of the start, in px."""
MOST_WAITING_BYTES = 64_000_000
"""Largest size of all pictures that wait for their detections, in bytes."""
NAME = re.compile(rf"({'|'.join(OCCASIONS)})-(.+)-([0-9]+)\.(?:png|jpg)")


class PictureName(NamedTuple):
    """The occasion, camera and number of a file in ``pictures/``."""

    occasion: Occasion
    camera: str
    seq: int

    @classmethod
    def of(cls, path: Path) -> PictureName | None:
        """Return the name that a file has, None if it is no picture of a run."""
        found = NAME.fullmatch(path.name)
        if found is None:
            return None
        occasion = next(known for known in OCCASIONS if known == found[1])
        return cls(occasion, found[2], int(found[3]))

    def path(self, folder: Path) -> Path:
        """Return the path of the file."""
        suffix = "jpg" if self.occasion == "start" else "png"
        return folder / f"{self.occasion}-{self.camera}-{self.seq}.{suffix}"


class Picture(NamedTuple):
    """One picture, the actors that are really in it, and the advisory that was active then."""

    header: CameraFrame
    pixels: Payload
    sightings: tuple[SightingTruth, ...] = ()
    advisory: Advisory | None = None


class WaitingPictures:
    """Pictures that wait for their detections, the oldest first."""

    def __init__(self) -> None:
        self._pictures: list[Picture] = []

    def add(self, picture: Picture) -> list[Picture]:
        """Add a picture, and return those that have no room any more."""
        self._pictures.append(picture)
        crowded_out = []
        size = sum(len(one.pixels) for one in self._pictures)
        while size > MOST_WAITING_BYTES and len(self._pictures) > 1:
            crowded_out.append(self._pictures.pop(0))
            size -= len(crowded_out[-1].pixels)
        return crowded_out

    def up_to(self, camera: str, seq: int) -> list[Picture]:
        """Take out a camera's pictures up to one; no detector will look at those before it."""
        kept: list[Picture] = []
        taken: list[Picture] = []
        for picture in self._pictures:
            header = picture.header
            is_over = header.camera == camera and header.seq <= seq
            (taken if is_over else kept).append(picture)
        self._pictures = kept
        return taken

    def everything(self) -> list[Picture]:
        """Take out all pictures."""
        taken, self._pictures = self._pictures, []
        return taken


class KeyPictures:
    """Writes the key pictures of a run, each as soon as it is known.

    The first detection is the first one that matches one of the `actors`: the pair of the conflict,
    or all. The first warning is the first advisory of CAUTION or above. Its picture is the newest
    that a detector had looked at, of the camera that shows one of the actors largest. Each camera
    that has an actor in view keeps its picture nearest in time to the closest approach up to now,
    `closest_ns`.
    """

    def __init__(
        self, folder: Path, *, actors: Collection[str], closest_ns: Callable[[], int | None]
    ) -> None:
        self._folder = folder
        self._actors = frozenset(actors)
        self._closest_ns = closest_ns
        self._sightings: dict[str, tuple[SightingTruth, ...]] = {}
        self._waiting = WaitingPictures()
        self._is_watched = False
        self._newest: dict[str, Picture] = {}
        self._looked_at: dict[str, Picture] = {}
        self._nearest: dict[str, Picture] = {}
        self._written: set[Occasion] = set()
        self._is_full = False

    def take(self, key: str, message: Message, payload: Payload) -> None:  # noqa: ARG002
        """Receive a message, truth too; `RunFolderError` if the disk is full or gone."""
        match message:
            case CameraTruth(camera=name):
                self._sightings[name] = message.sightings
            case CameraFrame(camera=name, encoding="rgb8"):
                self._take_picture(Picture(message, payload, self._sightings.get(name, ())))
            case Detections(missed=""):
                self._look(message)
            case Status(modality="vision", state=state):
                self._is_watched = state == "on"
                if not self._is_watched:
                    self._waiting.everything()
            case Advisory(active=True) if message.severity.rank >= SPEAK_MIN_LEVEL.rank:
                self._warned()

    def close(self) -> None:
        """Write the picture of the closest approach; else as `take`."""
        closest_ns = self._closest_ns()
        if closest_ns is None or not self._nearest or self._is_full:
            return

        def worth(picture: Picture) -> tuple[int, float]:
            late_ns = abs(picture.header.t_frame_ns - closest_ns)
            return -round(late_ns / SECOND_NS), self._size_px(picture)

        self._write("closest_approach", max(self._nearest.values(), key=worth))
        self._nearest.clear()

    def _take_picture(self, picture: Picture) -> None:
        name = picture.header.camera
        if name not in self._newest:
            self._write("start", picture)
        if self._is_watched:
            self._waiting.add(picture)
        self._newest[name] = picture
        if self._is_nearer(picture, self._nearest.get(name)):
            self._nearest[name] = picture

    def _is_nearer(self, picture: Picture, kept: Picture | None) -> bool:
        closest_ns = self._closest_ns()
        if closest_ns is None or not self._size_px(picture):
            return False
        return kept is None or abs(picture.header.t_frame_ns - closest_ns) <= abs(
            kept.header.t_frame_ns - closest_ns
        )

    def _look(self, seen: Detections) -> None:
        pictures = self._waiting.up_to(seen.camera, seen.seq)
        if not pictures or pictures[-1].header.seq != seen.seq:
            return
        self._looked_at[seen.camera] = picture = pictures[-1]
        if "first_detection" not in self._written:
            found = matches(picture.sightings, seen.detections)
            if any(one is not None and one.actor in self._actors for one in found):
                self._write("first_detection", picture)

    def _warned(self) -> None:
        able = {**self._newest, **self._looked_at}
        if able and "first_warning" not in self._written:
            self._write("first_warning", max(able.values(), key=self._size_px))

    def _size_px(self, picture: Picture) -> float:
        """Return the size of the largest actor in a picture, in px; 0 if none is visible."""
        seen = (one for one in picture.sightings if one.actor in self._actors and one.pixels > 0.0)
        return max((size_px(one.box) for one in seen), default=0.0)

    def _write(self, occasion: Occasion, picture: Picture) -> None:
        from PIL import Image

        try:
            pixels = bytes(picture.pixels)
        except RendererError:  # It cannot be drawn any more, which the cameras tell themselves.
            return
        self._written.add(occasion)
        header = picture.header
        size = header.view.width_px, header.view.height_px
        image = Image.frombuffer("RGB", size, pixels)
        if occasion == "start" and size[0] > START_WIDTH_PX:
            image = image.resize((START_WIDTH_PX, max(START_WIDTH_PX * size[1] // size[0], 1)))
        path = PictureName(occasion, header.camera, header.seq).path(self._folder)
        try:
            with writing_to_run(path):
                make_folder(self._folder)
                image.save(path)
        except RunFolderError:
            self._is_full = True
            with suppress(OSError):
                path.unlink()
            raise
