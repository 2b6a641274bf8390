"""The landscape behind everything in a camera's pictures, drawn anew only where it has moved.

A camera that moves little against what it sees shows the same for some pictures: en route hardly
anything changes, and on an approach the horizon stays while the ground in front passes by. So the
picture is kept in bands of rows, and drawn anew once anything in it would be out of its place by
more than `KEPT_PX`: all bands that soon would be are then drawn at once, so that pictures are the
same as the last one for as long as can be.

A fixed camera's picture is drawn with many samples a pixel, which takes 0.4 to 2.3 s of CPU, and
kept for all processes of a user: each run has a process of its own that draws.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from airhilt.host.caches import CacheFolder
from airhilt.imaging.view import NEAR_M, Intrinsics, View, Window
from airhilt.sensors.cameras.renderers import Renderer, Samples
from airhilt.shapes.mesh import Floats

COMPRESSION = 1
"""Level of zlib: 720 rows take 1.4 instead of 6.5 MB, for 35 ms to write and 10 ms to read."""
KEPT_PX = 0.5
"""Greatest distance, in pixels, by which anything that is kept may be out of its place."""
SOON_PX = 0.35
"""Distance, in pixels, from which a band is drawn together with others that must be."""
BAND_ROWS = 24
PROBE_PX = 8
"""Side of the squares in which the nearest point is watched, in pixels."""
SKY_M = 1e7
SAMPLES_AT_ONCE = 2_500_000


class Drawing(NamedTuple):
    """Bands that were drawn together: the first one, and the one behind the last."""

    view: View
    first: int
    end: int


class Background:
    """The landscape as one camera sees it.

    Parameters
    ----------
    finish
        Called with colours, distances and view of each picture that has been drawn whole.
    kept_as
        Identity of the landscape, by which the picture of a camera that stands still is kept;
        empty: it is not.

    Attributes
    ----------
    colour, distance_m
        Arrays as in `airhilt.sensors.cameras.renderers.Samples`; each look changes them.
    drawn
        Number of times that any part of it has been drawn.
    drawings
        Drawings of a moving camera of which bands are left, the oldest first.
    """

    def __init__(
        self,
        renderer: Renderer,
        samples: int,
        finish: Callable[[npt.NDArray[np.uint8], Floats, View], None] | None = None,
        kept_as: str = "",
    ) -> None:
        self._renderer = renderer
        self._samples = samples
        self._finish = finish
        self._kept_as = kept_as
        self.colour = np.zeros((0, 0, 3), dtype=np.uint8)
        self.distance_m = np.zeros((0, 0), dtype=np.float32)
        self.drawn = 0
        self.drawings: tuple[Drawing, ...] = ()
        self._views: list[View] = []
        self._towards = self._places = self._points = np.zeros((3, 0, 0))

    def look(self, view: View) -> None:
        """Draw what has moved since it was drawn."""
        if not self._views:
            self._draw_all(view)
        if all(kept.pose is view.pose for kept in self._views):
            return
        moved_px = self._moved_px(view)
        if moved_px.max() > KEPT_PX:
            soon = np.flatnonzero(moved_px > SOON_PX)
            self._draw(view, int(soon[0]), int(soon[-1]) + 1)

    def resume(self, drawings: Sequence[Drawing]) -> None:
        """Draw these drawings again; without any, forget what has been drawn."""
        self.drawings = ()
        self._views = []
        if drawings:
            self._begin(drawings[0].view)
        for view, first, end in drawings:
            self._draw(view, first, end)

    def _begin(self, view: View) -> None:
        lens = view.intrinsics
        rows, columns = lens.height_px, lens.width_px
        bands = -(-rows // BAND_ROWS)
        self.colour = np.empty((rows, columns, 3), dtype=np.uint8)
        self.distance_m = np.empty((rows, columns), dtype=np.float32)
        self._views = [view] * bands
        self._aim(lens, bands)

    def _draw_all(self, view: View) -> None:
        self._begin(view)
        if not self._kept_as:
            self._draw_whole(view)
            return
        kept = kept_background(self._kept_as, view, self._samples, lambda: self._draw_whole(view))
        self.colour, self.distance_m = kept
        self._watch(view, 0, len(self._views), self.distance_m)
        self.drawn += 1

    def _draw_whole(self, view: View) -> Samples:
        self._draw(view, 0, len(self._views))
        if self._finish is not None:
            self._finish(self.colour, self.distance_m, view)
        return Samples(self.colour, self.distance_m)

    def _draw(self, view: View, first: int, end: int) -> None:
        """Draw bands, as many at once as take no more than a moderate amount of memory."""
        rows, columns = self.distance_m.shape
        samples = self._samples
        at_once = max(SAMPLES_AT_ONCE // (BAND_ROWS * columns * samples**2), 1)
        for band in range(first, end, at_once):
            past = min(band + at_once, end)
            window = Window(0, band * BAND_ROWS, columns, min(past * BAND_ROWS, rows))
            drawn = resolved(self._renderer.landscape(view, window, samples), samples)
            self.colour[window.slices] = drawn.colour
            self.distance_m[window.slices] = drawn.distance_m
            self._views[band:past] = [view] * (past - band)
            self._watch(view, band, past, drawn.distance_m)
        left = [
            each
            for each in self.drawings
            if any(kept is each.view for kept in self._views[each.first : each.end])
        ]
        self.drawings = (*left, Drawing(view, first, end))
        self.drawn += 1

    def _aim(self, lens: Intrinsics, bands: int) -> None:
        """Choose what is watched: squares in the order of their bands, of shape (3, bands, n)."""
        across = PROBE_PX * (np.arange(-(-lens.width_px // PROBE_PX)) + 0.5) - lens.width_px / 2.0
        down = PROBE_PX * (np.arange(bands * BAND_ROWS // PROBE_PX) + 0.5) - lens.height_px / 2.0
        columns, rows = (place.reshape(bands, -1) for place in np.meshgrid(across, down))
        self._places = np.stack((columns, rows, np.full_like(rows, lens.focal_px)))
        self._towards = self._places / np.linalg.norm(self._places, axis=0)
        self._points = np.zeros_like(self._places)

    def _watch(self, view: View, first: int, end: int, distance_m: Floats) -> None:
        """Store each square's nearest depth, at the middle of the square."""
        nearest = _nearest(distance_m, (end - first) * BAND_ROWS // PROBE_PX)
        inside = self._towards[:, first:end] * nearest.reshape(end - first, -1)
        points = (view.axes @ inside.reshape(3, -1)).reshape(inside.shape)
        self._points[:, first:end] = points + _column(view.pose.position_m)

    def _moved_px(self, view: View) -> npt.NDArray[np.float64]:
        """Return by how much anything is out of its place at most, for each band."""
        offset = self._points - _column(view.pose.position_m)
        x, y, z = (view.axes.T @ offset.reshape(3, -1)).reshape(offset.shape)
        scale = view.intrinsics.focal_px / np.maximum(z, NEAR_M)
        columns, rows, _ = self._places
        apart = np.maximum(np.abs(x * scale - columns), np.abs(y * scale - rows))
        return np.asarray(apart.max(axis=1))


def _column(vector: tuple[float, float, float]) -> npt.NDArray[np.float64]:
    return np.asarray(vector).reshape(3, 1, 1)


def _nearest(distance_m: Floats, down: int) -> Floats:
    """Return the nearest distance in each square; a column has ``down`` squares."""
    rows, columns = distance_m.shape
    across = -(-columns // PROBE_PX)
    beyond = (0, down * PROBE_PX - rows), (0, across * PROBE_PX - columns)
    if beyond != ((0, 0), (0, 0)):
        distance_m = np.pad(distance_m, beyond, constant_values=np.inf)
    nearest = distance_m.reshape(down, PROBE_PX, -1).min(axis=1)
    # Rows are compared fast, neighbours in a row are not: turned, they are rows too.
    turned = np.ascontiguousarray(nearest.T).reshape(across, PROBE_PX, down)
    return np.asarray(np.minimum(turned.min(axis=1).T, np.float32(SKY_M)))


def resolved(drawn: Samples, samples: int) -> Samples:
    """Return the pixels of samples: their mean colours, and the distance of one in the middle."""
    if samples == 1:
        return drawn
    rows, columns = (side // samples for side in drawn.distance_m.shape)
    # Sums of whole numbers: the mean of NumPy over two short axes is seven times slower.
    summed = drawn.colour.reshape(rows, samples, -1).sum(axis=1, dtype=np.uint16)
    total = summed.reshape(rows, columns, samples, 3)
    total = sum((total[:, :, column] for column in range(1, samples)), start=total[:, :, 0])
    colour = np.round(total / np.float32(samples**2)).astype(np.uint8)
    middle = samples // 2
    return Samples(colour, np.ascontiguousarray(drawn.distance_m[middle::samples, middle::samples]))


def kept_background(
    landscape: str, view: View, samples: int, draw: Callable[[], Samples]
) -> Samples:
    """Return the picture of a camera that stands still, drawn if it is not in the cache."""

    def packed() -> bytes:
        drawn = draw()
        return zlib.compress(drawn.colour.tobytes() + drawn.distance_m.tobytes(), COMPRESSION)

    key = json.dumps([landscape, view.key, samples])
    content = zlib.decompress(CacheFolder("backgrounds").get(key, packed))
    shape = view.intrinsics.height_px, view.intrinsics.width_px
    pixels = shape[0] * shape[1]
    colour = np.frombuffer(content, np.uint8, 3 * pixels)
    distance = np.frombuffer(content, np.float32, pixels, offset=3 * pixels)
    return Samples(colour.reshape(*shape, 3), distance.reshape(shape))
