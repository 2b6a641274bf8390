"""Looks again only where a picture has changed.

A camera that stands still sees the same background in every picture, and in the air pictures are
often the same to the bit though the camera has moved. Each tile of a picture is compared with its
state at the last look, and its findings stay until a pixel has changed. Then the detector looks at
the whole tile again; or only at windows about the changes, if these are small and it sees parts of
a picture as well as the whole.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol, runtime_checkable

from airhilt.assistant.vision.changes import changed_blocks, windows_about
from airhilt.assistant.vision.detector import (
    Detector,
    DetectsShots,
    Found,
    Picture,
    Shot,
    once,
)
from airhilt.assistant.vision.tiling import Tile, merged, pieces_of, tiles_of
from airhilt.imaging.boxes import centre, shared_area

MOST_IN_WINDOWS = 0.5
"""Share of a tile in windows above which the detector looks at the whole tile."""


@runtime_checkable
class SeesParts(Detector, Protocol):
    """A detector that finds nearly the same in a part of a picture as in the whole."""

    def detect_in(self, picture: Picture, part: Tile) -> Sequence[Found]:
        """Return what is in a part of a picture, with boxes as they are in the picture.

        It raises what `Detector.detect` does.
        """
        ...


class _Looked(NamedTuple):
    """State of a tile when its parts were last looked at."""

    pixels: Picture
    found: tuple[Found, ...]


class Gate:
    """Asks a detector only about changes, for any number of cameras.

    Small pictures are looked at in one piece, big ones in tiles.
    """

    def __init__(self, detector: Detector) -> None:
        self._detector = detector
        self._looked: dict[tuple[str, Tile], _Looked] = {}

    def look(self, shot: Shot, picture: Picture) -> list[Found]:
        """Return what is in the next picture of a camera, by falling confidence.

        Raises
        ------
        airhilt.errors.VisionError
            The detector has failed.
        """
        tiles = tiles_of(picture)
        found = [self._look_at(shot, tile, picture) for tile in tiles]
        if len(tiles) == 1:
            return list(found[0])
        return merged([
            piece
            for tile, these in zip(tiles, found, strict=True)
            for piece in pieces_of(these, tile, picture)
        ])  # fmt: skip

    def _look_at(self, shot: Shot, tile: Tile, picture: Picture) -> tuple[Found, ...]:
        """Return what is in a tile, with boxes as they are in it."""
        pixels, part = tile.of(picture), _part(shot, tile)
        last = self._looked.get((shot.camera, tile))
        looked = self._anew(part, pixels) if last is None else self._again(last, part, pixels)
        self._looked[shot.camera, tile] = looked
        return looked.found

    def _anew(self, shot: Shot, pixels: Picture) -> _Looked:
        kept, detector = pixels.copy(), self._detector
        if isinstance(detector, DetectsShots):
            return _Looked(kept, tuple(detector.detect_shot(kept, shot)))
        return _Looked(kept, tuple(detector.detect(kept)))

    def _again(self, last: _Looked, shot: Shot, pixels: Picture) -> _Looked:
        blocks = changed_blocks(last.pixels, pixels)
        if not blocks.any():
            return last
        detector, (rows, columns) = self._detector, pixels.shape[:2]
        if not isinstance(detector, SeesParts):
            return self._anew(shot, pixels)
        windows = windows_about(blocks, [one.box for one in last.found], rows, columns)
        if sum(each.height * each.width for each in windows) > MOST_IN_WINDOWS * rows * columns:
            return self._anew(shot, pixels)
        seen = [
            one
            for window in windows
            for one in detector.detect_in(pixels, window)
            if window.holds(centre(one.box))
        ]
        kept = last.pixels.copy()
        for window in windows:
            window.of(kept)[...] = window.of(pixels)
        return _Looked(kept, tuple(_together(last.found, seen, windows)))


def _part(shot: Shot, tile: Tile) -> Shot:
    """Return the origin of a tile."""
    mask = shot.own_aircraft
    return shot._replace(
        left=tile.left,
        top=tile.top,
        own_aircraft=None
        if mask is None
        else mask[tile.top : tile.top + tile.height, tile.left : tile.left + tile.width],
    )


def _together(
    before: Sequence[Found], seen: Sequence[Found], windows: Sequence[Tile]
) -> list[Found]:
    """Return what is seen in windows and what was outside of them, by falling confidence."""
    outside = [
        one for one in before if not any(shared_area(one.box, window.box) for window in windows)
    ]
    return once(sorted((*seen, *outside), key=lambda found: -found.confidence))
