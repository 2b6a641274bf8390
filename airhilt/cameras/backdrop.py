"""The still world behind everything in a camera's pictures, drawn anew only where it has moved.

A camera that moves little against what it sees shows the same for some pictures: en route hardly
anything changes, and on an approach the horizon stays while the ground in front passes by. So the
picture is kept in bands of rows, and a band is drawn anew once anything in it would be out of its
place by more than `KEPT_PX`.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from airhilt.cameras.mesh import Floats
from airhilt.cameras.renderers import Renderer, Samples
from airhilt.cameras.view import NEAR_M, View, Window

KEPT_PX = 0.25
"""A pixel of the world shows it as it was when it was within this of its place."""
BAND_ROWS = 24
PROBE_PX = 8
"""Of each square of this side the nearest point is watched."""
SKY_M = 1e7
SAMPLES_AT_ONCE = 2_500_000


class Backdrop:
    """The world as one camera sees it.

    Parameters
    ----------
    samples
        Along each side of a pixel.
    finish
        Called with colours, distances and view of each picture that has been drawn whole.

    Attributes
    ----------
    colour, distance_m
        As in `airhilt.cameras.renderers.Samples`; they change when the camera looks again.
    drawn
        How often any of it has been drawn.
    """

    def __init__(
        self,
        renderer: Renderer,
        samples: int,
        finish: Callable[[npt.NDArray[np.uint8], Floats, View], None] | None = None,
    ) -> None:
        self._renderer = renderer
        self._samples = samples
        self._finish = finish
        self._is_first = True
        self.colour = np.zeros((0, 0, 3), dtype=np.uint8)
        self.distance_m = np.zeros((0, 0), dtype=np.float32)
        self.drawn = 0
        self._views: list[View] = []
        self._points = np.zeros((0, 0, 3))
        self._places = np.zeros((0, 0, 2))

    def look(self, view: View) -> None:
        """Draw what has moved since it was drawn."""
        if not self._views:
            self._draw_all(view)
        if self._has(view):
            return
        moved = np.flatnonzero(self._moved_px(view) > KEPT_PX)
        if len(moved):
            self._draw(view, int(moved[0]), int(moved[-1]) + 1)

    def _has(self, view: View) -> bool:
        """Return whether all has been drawn from just there."""
        return all(kept.pose is view.pose for kept in self._views)

    def _draw_all(self, view: View) -> None:
        lens = view.intrinsics
        rows, columns = lens.height_px, lens.width_px
        bands = -(-rows // BAND_ROWS)
        self.colour = np.empty((rows, columns, 3), dtype=np.uint8)
        self.distance_m = np.empty((rows, columns), dtype=np.float32)
        self._views = [view] * bands
        watched = (BAND_ROWS // PROBE_PX) * -(-columns // PROBE_PX)
        self._points = np.zeros((bands, watched, 3))
        self._places = np.zeros((bands, watched, 2))
        self._draw(view, 0, bands)
        if self._finish is not None:
            self._finish(self.colour, self.distance_m, view)

    def _draw(self, view: View, first: int, end: int) -> None:
        """Draw bands, as many at once as take no more than a moderate amount of memory."""
        rows, columns = self.distance_m.shape
        samples = self._samples
        at_once = max(SAMPLES_AT_ONCE // (BAND_ROWS * columns * samples**2), 1)
        for band in range(first, end, at_once):
            past = min(band + at_once, end)
            window = Window(0, band * BAND_ROWS, columns, min(past * BAND_ROWS, rows))
            drawn = resolved(self._renderer.world(view, window, samples), samples)
            self.colour[window.slices] = drawn.colour
            self.distance_m[window.slices] = drawn.distance_m
            self._views[band:past] = [view] * (past - band)
            self._watch(view, band, past, drawn.distance_m)
        self.drawn += 1

    def _watch(self, view: View, first: int, end: int, distance_m: Floats) -> None:
        """Remember the nearest point of each square, as if it were in the middle."""
        rows, columns = distance_m.shape
        across, down = -(-columns // PROBE_PX), (end - first) * BAND_ROWS // PROBE_PX
        padded = np.full((down * PROBE_PX, across * PROBE_PX), SKY_M, dtype=np.float32)
        np.minimum(distance_m, SKY_M, out=padded[:rows, :columns])
        nearest = padded.reshape(down, PROBE_PX, across * PROBE_PX).min(axis=1)
        nearest = nearest.reshape(down, across, PROBE_PX).min(axis=2)
        half = np.float32(PROBE_PX / 2)
        column = np.arange(across, dtype=np.float32)[None, :] * PROBE_PX + half
        row = np.arange(down, dtype=np.float32)[:, None] * PROBE_PX + half
        row += np.float32(first * BAND_ROWS)
        points = (view.directions(column, row) * nearest).transpose(1, 2, 0)
        points = points + np.asarray(view.pose.position_m)
        places = np.stack(np.broadcast_arrays(column, row), axis=-1)
        self._points[first:end] = points.reshape(end - first, -1, 3)
        self._places[first:end] = places.reshape(end - first, -1, 2)

    def _moved_px(self, view: View) -> npt.NDArray[np.float64]:
        """Return by how much anything is out of its place at most, for each band."""
        inside = view.in_camera(self._points)
        inside[..., 2] = np.maximum(inside[..., 2], NEAR_M)
        apart = np.abs(view.pixels(inside) - self._places)
        return np.asarray(apart.max(axis=(1, 2)))


def resolved(drawn: Samples, samples: int) -> Samples:
    """Return the pixels of samples: their mean colours, and the distance of one in the middle."""
    if samples == 1:
        return drawn
    rows, columns = (side // samples for side in drawn.distance_m.shape)
    fine = drawn.colour.reshape(rows, samples, columns, samples, 3)
    colour = np.round(fine.mean(axis=(1, 3), dtype=np.float32)).astype(np.uint8)
    middle = samples // 2
    return Samples(colour, np.ascontiguousarray(drawn.distance_m[middle::samples, middle::samples]))
