"""Looks again only where a picture has changed.

A camera that stands still sees the same background in every picture. Each picture is compared
with what was last looked at, in cells of `GRID_PX`. A detector that says how far it sees has
answers that depend on the pixels within its reach: cells within reach of a change are looked at
anew, in windows that hold their surroundings too, and what was found elsewhere stays.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from airhilt.boxes import centre, moved
from airhilt.messages import Box, CameraView
from airhilt.units import SECOND_NS
from airhilt.workers.vision.detector import GRID_PX, Detector, Found, Picture

EDGE_PX = 1.0

Cells = npt.NDArray[np.bool_]
Slices = tuple[slice, slice]
"""Of rows and columns."""


@dataclass(frozen=True)
class GateSettings:
    """When and where to look again."""

    least_change: int = 2
    """Levels of 255 by which a pixel must change."""
    reach_cells: int = 2
    """So far from a change may a detector's answers change."""
    context_cells: int = 4
    """So far beyond that a window goes: what is looked at anew sees as much as it always does."""
    most_windows: int = 4
    most_area: float = 0.7
    """Share of the picture in windows from which the whole is looked at."""
    whole_every_s: float = 1.0
    """The whole picture is looked at again after so much time, if it has changed since."""

    @classmethod
    def of_reach(cls, reach_px: float) -> GateSettings:
        """Return the settings for a detector that sees no further than that."""
        cells = math.ceil(reach_px / GRID_PX)
        return cls(reach_cells=cells, context_cells=2 * cells)


WHOLE = GateSettings(most_windows=0)
"""The whole picture, unless nothing has changed."""


@runtime_checkable
class SeesNear(Protocol):
    """A detector that says how far it sees."""

    @property
    def reach_px(self) -> float | None:
        """From there on what is in a picture hardly matters to an answer; None: not known."""
        ...


def gate_of(detector: Detector) -> GateSettings:
    """Return when parts of a picture are enough for a detector."""
    reach_px = detector.reach_px if isinstance(detector, SeesNear) else None
    return WHOLE if reach_px is None else GateSettings.of_reach(reach_px)


@dataclass
class _Looked:
    """What a camera has seen."""

    view: CameraView
    picture: Picture
    """Each pixel as it was when it was last looked at."""
    found: list[Found]
    whole_ns: int
    is_patched: bool = False
    """Parts were looked at since the whole was."""


class Gate:
    """Puts a detector behind a watch for changes, for any number of cameras.

    It gives what the detector gives for whole pictures if that sees no further than the settings
    say. What it sees a little of further away changes its confidences a little.
    """

    def __init__(self, detector: Detector, settings: GateSettings) -> None:
        self._detector = detector
        self._settings = settings
        self._looked: dict[str, _Looked] = {}

    def look(self, camera: str, view: CameraView, t_ns: int, picture: Picture) -> list[Found]:
        """Return what is in the next picture of a camera, the surest first.

        Parameters
        ----------
        t_ns
            End of the exposure.

        Raises
        ------
        airhilt.errors.VisionError
            The detector has failed.
        """
        last = self._looked.get(camera)
        if last is None or last.picture.shape != picture.shape:
            return self._look_at_all(camera, view, t_ns, picture)
        if last.view != view:
            # In the air, pictures are often the same to the bit though the camera has moved.
            if last.is_patched or not np.array_equal(last.picture, picture):
                return self._look_at_all(camera, view, t_ns, picture)
            last.view = view
        changed = changed_cells(last.picture, picture, self._settings.least_change)
        is_due = t_ns - last.whole_ns >= self._settings.whole_every_s * SECOND_NS
        if is_due and (last.is_patched or changed.any()):
            return self._look_at_all(camera, view, t_ns, picture)
        if changed.any() and not self._look_at_changes(last, picture, changed):
            return self._look_at_all(camera, view, t_ns, picture)
        return list(last.found)

    def _look_at_all(
        self, camera: str, view: CameraView, t_ns: int, picture: Picture
    ) -> list[Found]:
        found = list(self._detector.detect(picture))
        self._looked[camera] = _Looked(view, picture.copy(), found, t_ns)
        return list(found)

    def _look_at_changes(self, last: _Looked, picture: Picture, changed: Cells) -> bool:
        """Bring what was found up to date, and return whether windows are enough for that."""
        affected = grown(changed, self._settings.reach_cells)
        kept = last.found
        while met := [found for found in kept if affected[cells_of(found.box, affected)].any()]:
            kept = [found for found in kept if found not in met]
            for found in met:
                affected[cells_of(found.box, affected)] = True
        windows = windows_of(grown(affected, self._settings.context_cells))
        size = sum(affected[window].size for window in windows)
        if (
            len(windows) > self._settings.most_windows
            or size > self._settings.most_area * affected.size
        ):
            return False
        seen: list[Found] = []
        for window in windows:
            here = self._look_through(window, picture, affected)
            if any(_is_cut(found.box, window, picture) for found in here):
                return False
            seen += here
        last.found = sorted(kept + seen, key=lambda found: -found.confidence)
        for window in windows:
            pixels = in_pixels(window)
            last.picture[pixels] = picture[pixels]
        last.is_patched = True
        return True

    def _look_through(self, window: Slices, picture: Picture, affected: Cells) -> list[Found]:
        """Return what is in a window, with its middle where the answer may have changed."""
        pixels = in_pixels(window)
        looked = self._detector.detect(np.ascontiguousarray(picture[pixels]))
        top, left = pixels[0].start, pixels[1].start
        placed = [found._replace(box=moved(found.box, left, top)) for found in looked]
        return [found for found in placed if _is_in(found, affected)]


def changed_cells(before: Picture, after: Picture, least_change: int) -> Cells:
    """Return in which cells a pixel has changed by some levels or more."""
    rows, columns = (-(-side // GRID_PX) for side in before.shape[:2])
    cells = np.zeros((rows, columns), dtype=bool)
    first = np.arange(0, before.shape[1], GRID_PX)
    for row in range(rows):
        band = slice(row * GRID_PX, (row + 1) * GRID_PX)
        one, other = before[band], after[band]
        if not np.array_equal(one, other):
            change = (np.maximum(one, other) - np.minimum(one, other)).max(axis=0).max(axis=1)
            cells[row] = np.maximum.reduceat(change, first) >= least_change
    return cells


def grown(cells: Cells, by: int) -> Cells:
    """Return cells with all that are up to so many away."""
    return np.asarray(ndimage.maximum_filter(cells, size=2 * by + 1, mode="constant"))


def cells_of(box: Box, cells: Cells) -> Slices:
    """Return which of the cells of a picture a box touches; at least one."""
    rows, columns = cells.shape
    spans = []
    for begin, end, count in ((box[1], box[3], rows), (box[0], box[2], columns)):
        first = min(max(int(begin // GRID_PX), 0), count - 1)
        spans.append(slice(first, min(max(int(-(-end // GRID_PX)), first + 1), count)))
    return spans[0], spans[1]


def windows_of(cells: Cells) -> list[Slices]:
    """Return rectangles that hold all cells and do not meet each other."""
    labels, _ = ndimage.label(cells, structure=np.ones((3, 3)))
    windows: list[Slices] = []
    for window in ndimage.find_objects(labels):
        merged = window
        while met := [other for other in windows if _meet(merged, other)]:
            windows = [other for other in windows if other not in met]
            for other in met:
                merged = _around(merged, other)
        windows.append(merged)
    return windows


def in_pixels(window: Slices) -> Slices:
    """Return a window of cells in pixels; its end may lie outside of the picture."""
    rows, columns = window
    return (
        slice(rows.start * GRID_PX, rows.stop * GRID_PX),
        slice(columns.start * GRID_PX, columns.stop * GRID_PX),
    )


def _meet(one: Slices, other: Slices) -> bool:
    return all(a.start < b.stop and b.start < a.stop for a, b in zip(one, other, strict=True))


def _around(one: Slices, other: Slices) -> Slices:
    rows, columns = (
        slice(min(a.start, b.start), max(a.stop, b.stop)) for a, b in zip(one, other, strict=True)
    )
    return rows, columns


def _is_in(found: Found, cells: Cells) -> bool:
    column, row = centre(found.box)
    return bool(cells[cells_of((column, row, column, row), cells)].all())


def _is_cut(box: Box, window: Slices, picture: Picture) -> bool:
    """Return whether a box ends where the window does, and the picture does not."""
    rows, columns = in_pixels(window)
    return bool(
        (columns.start > 0 and box[0] < columns.start + EDGE_PX)
        or (rows.start > 0 and box[1] < rows.start + EDGE_PX)
        or (columns.stop < picture.shape[1] and box[2] > columns.stop - EDGE_PX)
        or (rows.stop < picture.shape[0] and box[3] > rows.stop - EDGE_PX)
    )
