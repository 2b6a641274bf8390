"""Looks again only where a picture has changed.

A camera that stands still sees the same background in every picture, and in the air pictures are
often the same to the bit though the camera has moved. Each tile of a picture is compared with its
state at the last look, and its findings stay until a pixel has changed. Then the detector looks at
the whole tile again; or only at windows about the changes, if these are small and it sees parts of
a picture as well as the whole.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol, runtime_checkable

import numpy as np

from airhilt.assistant.vision.changes import changed_blocks, windows_about
from airhilt.assistant.vision.detector import Detector, DetectsShots, Found, Picture, Shot, once
from airhilt.assistant.vision.tiling import Tile, merged, pieces_of, tiles_of
from airhilt.imaging.boxes import centre, shared_area

if TYPE_CHECKING:
    from airhilt.assistant.vision.shared_looks import SharedLooks

MOST_IN_WINDOWS = 0.5
"""Share of a tile in windows above which the detector looks at the whole tile."""


@runtime_checkable
class SeesParts(Detector, Protocol):
    """A detector that finds nearly the same in a part of a picture as in the whole."""

    def detect_in(self, picture: Picture, part: Tile, shot: Shot) -> Sequence[Found]:
        """Return what is in a part of a picture, with boxes as they are in the picture.

        It raises what `Detector.detect` does.
        """


class Look(NamedTuple):
    """Result of a look at a tile: windows that the detector looked at, and all that is in it."""

    windows: tuple[Tile, ...]
    found: tuple[Found, ...]


class _Looked(NamedTuple):
    """State of a tile when its parts were last looked at."""

    history: str
    """Hash of the pictures that it depends on."""
    pixels: KeptPixels
    found: tuple[Found, ...]


class SeenPicture(NamedTuple):
    """A picture that a camera has sent."""

    shape: tuple[int, int, int]
    """Rows, columns and 3 colours."""
    sha256: str
    """SHA-256 of the pixels; empty if nobody asks for it."""
    read: Callable[[], Picture]
    """Returns the pixels."""
    is_made: bool = True
    """True if the pixels are there to be read, False if reading makes them."""

    @classmethod
    def of(cls, pixels: Picture) -> SeenPicture:
        """Return the picture of these pixels, which may change later."""
        rows, columns, colours = pixels.shape
        kept = pixels.copy()
        return cls((rows, columns, colours), "", lambda: kept)


class _Layer(NamedTuple):
    """Windows of a tile that show one picture."""

    read: Callable[[], Picture]
    windows: Sequence[Tile]


class KeptPixels:
    """A tile as it was when its parts were last looked at, first in a whole picture."""

    def __init__(self, tile: Tile, picture: SeenPicture) -> None:
        self._tile = tile
        self._whole = Tile(0, 0, tile.height, tile.width)
        self._layers: list[_Layer] = []
        self.add(picture, [self._whole])

    def add(self, picture: SeenPicture, windows: Sequence[Tile]) -> None:
        """Put windows of a later picture over what there is."""
        tile = self._tile
        self._layers.append(_Layer(lambda: tile.of(picture.read()), windows))
        if picture.is_made:
            self.read()

    def read(self) -> Picture:
        """Return the pixels; they must not be written to."""
        if len(self._layers) > 1:
            pixels = np.empty((self._whole.height, self._whole.width, 3), dtype=np.uint8)
            for layer in self._seen_layers():
                shown = layer.read()
                for window in layer.windows:
                    window.of(pixels)[...] = window.of(shown)
            self._layers = [_Layer(lambda: pixels, [self._whole])]
        return self._layers[0].read()

    def _seen_layers(self) -> list[_Layer]:
        """Return the layers that later ones do not cover, the oldest first."""
        free = np.ones((self._whole.height, self._whole.width), dtype=bool)
        seen = []
        for layer in reversed(self._layers):
            if any(window.of(free).any() for window in layer.windows):
                seen.append(layer)
                for window in layer.windows:
                    window.of(free)[...] = False
            if not free.any():
                break
        return seen[::-1]


class Gate:
    """Asks a detector only about changes, for any number of cameras.

    Small pictures are looked at in one piece, big ones in tiles.

    Parameters
    ----------
    looks
        Looks that runs share, of pictures with a SHA-256; None if each is taken anew.
    """

    def __init__(self, detector: Detector, looks: SharedLooks | None = None) -> None:
        self._detector = detector
        self._looks = looks
        self._looked: dict[tuple[str, Tile], _Looked] = {}

    def look(self, shot: Shot, picture: Picture) -> list[Found]:
        """Return what is in the next picture of a camera, by falling confidence."""
        return self.look_at(shot, SeenPicture.of(picture))

    def look_at(self, shot: Shot, picture: SeenPicture) -> list[Found]:
        """Return what is in a picture whose pixels may not be needed; otherwise as `look`."""
        tiles = tiles_of(picture.shape)
        found = [self._look_at(shot, tile, picture) for tile in tiles]
        if len(tiles) == 1:
            return list(found[0])
        return merged([
            piece
            for tile, these in zip(tiles, found, strict=True)
            for piece in pieces_of(these, tile, picture.shape)
        ])  # fmt: skip

    def _look_at(self, shot: Shot, tile: Tile, picture: SeenPicture) -> tuple[Found, ...]:
        last = self._looked.get((shot.camera, tile))
        history = _history("" if last is None else last.history, picture.sha256)

        def take() -> Look:
            pixels, part = tile.of(picture.read()), _part(shot, tile)
            return self._anew(part, pixels) if last is None else self._again(last, part, pixels)

        if self._looks is None or not picture.sha256:
            look = take()
        else:
            look = self._looks.get(history, tile, picture.shape, take)
        if last is None or look.windows == (Tile(0, 0, tile.height, tile.width),):
            history = _history("", picture.sha256)  # What was before has no part in it any more.
            last = _Looked(history, KeptPixels(tile, picture), look.found)
        elif look.windows:
            last.pixels.add(picture, look.windows)
            last = _Looked(history, last.pixels, look.found)
        self._looked[shot.camera, tile] = last
        return last.found

    def _anew(self, shot: Shot, pixels: Picture) -> Look:
        detector, (rows, columns) = self._detector, pixels.shape[:2]
        found = (
            detector.detect_shot(pixels, shot)
            if isinstance(detector, DetectsShots)
            else detector.detect(pixels)
        )
        return Look((Tile(0, 0, rows, columns),), tuple(found))

    def _again(self, last: _Looked, shot: Shot, pixels: Picture) -> Look:
        blocks = changed_blocks(last.pixels.read(), pixels)
        if not blocks.any():
            return Look((), last.found)
        detector, (rows, columns) = self._detector, pixels.shape[:2]
        if not isinstance(detector, SeesParts):
            return self._anew(shot, pixels)
        windows = windows_about(blocks, [one.box for one in last.found], rows, columns)
        if sum(each.height * each.width for each in windows) > MOST_IN_WINDOWS * rows * columns:
            return self._anew(shot, pixels)
        seen = [
            one
            for window in windows
            for one in detector.detect_in(pixels, window, shot)
            if window.holds(centre(one.box))
        ]
        return Look(tuple(windows), tuple(_together(last.found, seen, windows)))


def _history(before: str, sha256: str) -> str:
    return hashlib.sha256(f"{before} {sha256}".encode()).hexdigest()


def _part(shot: Shot, tile: Tile) -> Shot:
    mask = None if shot.own_aircraft is None else tile.of(shot.own_aircraft)
    return shot._replace(left=tile.left, top=tile.top, own_aircraft=mask)


def _together(
    before: Sequence[Found], seen: Sequence[Found], windows: Sequence[Tile]
) -> list[Found]:
    outside = [
        one for one in before if not any(shared_area(one.box, window.box) for window in windows)
    ]
    return once(sorted((*seen, *outside), key=lambda found: -found.confidence))
