"""Looks again only where a picture has changed.

A camera that stands still sees the same background in every picture, and in the air pictures are
often the same to the bit though the camera has moved. Each tile of a picture is compared with its
state at the last look, and its findings stay until a pixel has changed. Then the detector looks at
the whole tile again; or only at windows about the changes, if these are small and it sees parts of
a picture as well as the whole.

All of a picture changes when its camera moves. Then such a detector looks at the whole tile now and
then. In between it looks at windows about what is followed, and about what the motion of the camera
does not explain: colours that were not within a pixel of their places in the last picture, which is
moved by the turn of the camera that its header tells.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol, runtime_checkable

import numpy as np

from airhilt.assistant.vision.changes import (
    blocks_beyond_motion,
    blocks_of,
    changed_blocks,
    windows_about,
)
from airhilt.assistant.vision.detector import Detector, DetectsShots, Found, Picture, Shot, once
from airhilt.assistant.vision.tiling import Tile, merged, pieces_of, tiles_of
from airhilt.imaging.boxes import area, centre, moved, shared_area, within
from airhilt.imaging.pinhole import Pinhole
from airhilt.messages import Box, CameraView
from airhilt.units import SECOND_NS

if TYPE_CHECKING:
    from airhilt.assistant.vision.shared_looks import SharedLooks

MOST_IN_WINDOWS = 0.5
"""Share of a tile in windows above which the detector looks at the whole tile."""
MOST_OF_BODIES = 0.2
"""Share of a tile in windows above which its camera, if it is carried, must have moved."""
SOONEST_WHOLE_NS = 3 * SECOND_NS // 20
"""Least time, in ns, between two looks at the whole of a tile if its camera moves."""
LATEST_WHOLE_NS = SECOND_NS
"""Likewise the longest time, if the tile has changed."""


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
    is_partial: bool = False
    """True if it left out changes that the motion of the camera may explain."""


class _Looked(NamedTuple):
    """State of a tile when its parts were last looked at."""

    history: str
    """Hash of the pictures that it depends on."""
    sha256: str
    """SHA-256 of the last picture."""
    pixels: KeptPixels
    look: Look
    whole_ns: int
    """Time of the last picture of which the whole tile was looked at."""
    view: CameraView | None
    """Pose of the camera in the last picture."""


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
        self._part_detector = detector if isinstance(detector, SeesParts) else None
        self._looks = looks
        self._looked: dict[tuple[str, Tile], _Looked] = {}

    def look(self, shot: Shot, picture: Picture, expected: Sequence[Box] = ()) -> list[Found]:
        """Return what is in the next picture of a camera, by falling confidence.

        Parameters
        ----------
        expected
            Boxes of what is followed, as they should be in this picture.
        """
        return self.look_at(shot, SeenPicture.of(picture), expected)

    def look_at(
        self, shot: Shot, picture: SeenPicture, expected: Sequence[Box] = ()
    ) -> list[Found]:
        """Return what is in a picture whose pixels may not be needed; otherwise as `look`."""
        tiles = tiles_of(picture.shape)
        found = [self._look_at(shot, tile, picture, expected) for tile in tiles]
        if len(tiles) == 1:
            return list(found[0])
        return merged([
            piece
            for tile, these in zip(tiles, found, strict=True)
            for piece in pieces_of(these, tile, picture.shape)
        ])  # fmt: skip

    def _look_at(
        self, shot: Shot, tile: Tile, picture: SeenPicture, expected: Sequence[Box]
    ) -> tuple[Found, ...]:
        last = self._looked.get((shot.camera, tile))
        history = _history("" if last is None else last.history, picture.sha256)
        if last is not None and picture.sha256 and picture.sha256 == last.sha256:
            is_overdue = shot.t_frame_ns - last.whole_ns >= LATEST_WHOLE_NS
            if not (last.look.is_partial and is_overdue):
                return last.look.found
        plan = None if last is None else _plan(last, shot, tile, expected)

        def take() -> Look:
            pixels, part = tile.of(picture.read()), _part(shot, tile)
            if last is None:
                return self._anew(part, pixels)
            if plan is None or self._part_detector is None:
                return self._again(last, part, pixels)
            return self._in_motion(self._part_detector, last, part, pixels, plan)

        if self._looks is None or not picture.sha256:
            look = take()
        else:
            look = self._looks.get(history, tile, picture.shape, plan, take)
        whole_ns = shot.t_frame_ns if last is None else last.whole_ns
        pixels = None if last is None else last.pixels
        if look.windows == (Tile(0, 0, tile.height, tile.width),):
            history = _history("", picture.sha256)  # What was before has no part in it any more.
            pixels, whole_ns = None, shot.t_frame_ns
        elif look.is_partial:
            pixels = None
        elif pixels is not None and look.windows:
            pixels.add(picture, look.windows)
        elif last is not None:
            history = last.history
        pixels = pixels or KeptPixels(tile, picture)
        kept = _Looked(history, picture.sha256, pixels, look, whole_ns, shot.view)
        self._looked[shot.camera, tile] = kept
        return look.found

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
            return last.look._replace(windows=())
        detector, (rows, columns) = self._part_detector, pixels.shape[:2]
        if detector is None:
            return self._anew(shot, pixels)
        before = last.look.found
        windows = windows_about(blocks, [one.box for one in before], rows, columns)
        if _are_small(windows, rows, columns):
            return Look(tuple(windows), _with_windows(detector, shot, before, pixels, windows))
        return self._anew(shot, pixels)

    def _in_motion(
        self, detector: SeesParts, last: _Looked, shot: Shot, pixels: Picture, plan: _Plan
    ) -> Look:
        old, (rows, columns) = last.pixels.read(), pixels.shape[:2]
        changed = changed_blocks(old, pixels)
        if plan.is_overdue and (last.look.is_partial or changed.any()):
            return self._anew(shot, pixels)
        if not changed.any():
            return last.look._replace(windows=())
        before = last.look.found
        places = [*plan.expected, *(one.box for one in before)]
        windows = windows_about(changed, places, rows, columns)
        if _are_small(windows, rows, columns, MOST_OF_BODIES):
            found = _with_windows(detector, shot, before, pixels, windows)
            return Look(tuple(windows), found, last.look.is_partial)
        followed = blocks_of(places, rows, columns)
        new = blocks_beyond_motion(old, pixels, plan.motion_px)
        for blocks in (new | followed, followed):
            windows = windows_about(blocks, places, rows, columns)
            if _are_small(windows, rows, columns):
                found = _with_windows(detector, shot, before, pixels, windows)
                return Look(tuple(windows), found, is_partial=True)
            if plan.is_due:
                break
        return self._anew(shot, pixels)


class _Plan(NamedTuple):
    """Inputs of a look at a tile of a camera that moves, besides pictures."""

    expected: list[Box]
    """Boxes of what is followed, within the tile."""
    motion_px: tuple[int, int]
    """Way right and down from places in the picture to the same places in the last one."""
    is_due: bool
    """The whole tile may be looked at."""
    is_overdue: bool
    """The whole tile must be looked at if it has changed."""


def _plan(last: _Looked, shot: Shot, tile: Tile, expected: Sequence[Box]) -> _Plan | None:
    """Return the plan of a look at a tile; None if its camera stands."""
    if shot.view is None or last.view is None or shot.view.carrier is None:
        return None
    there = [within(moved(box, -tile.left, -tile.top), tile.width, tile.height) for box in expected]
    age_ns = shot.t_frame_ns - last.whole_ns
    return _Plan(
        [box for box in there if area(box) > 0.0],
        _motion_px(last.view, shot.view),
        age_ns >= SOONEST_WHOLE_NS,
        age_ns >= LATEST_WHOLE_NS,
    )


def _motion_px(before: CameraView, after: CameraView) -> tuple[int, int]:
    """Return where the middle of a picture was before the camera turned, right and down of it."""
    if before == after:
        return 0, 0
    lens = Pinhole(before)
    ahead = lens.axes.T @ Pinhole(after).axes[:, 2]
    column, row = lens.pixel(*ahead) or (float(before.width_px), float(before.height_px))
    return round(column - lens.centre_px[0]), round(row - lens.centre_px[1])


def _are_small(
    windows: Sequence[Tile], rows: int, columns: int, most: float = MOST_IN_WINDOWS
) -> bool:
    """Return whether windows have no more than a share of a tile."""
    return sum(each.height * each.width for each in windows) <= most * rows * columns


def _with_windows(
    detector: SeesParts,
    shot: Shot,
    before: Sequence[Found],
    pixels: Picture,
    windows: Sequence[Tile],
) -> tuple[Found, ...]:
    """Return what was found before outside of windows, and what is in the windows now."""
    seen = [
        one
        for window in windows
        for one in detector.detect_in(pixels, window, shot)
        if window.holds(centre(one.box))
    ]
    return tuple(_together(before, seen, windows))


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
