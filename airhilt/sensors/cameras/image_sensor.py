"""Effects of lens, sensor and coder on a picture: blur, vignetting, exposure, noise and JPEG."""

from __future__ import annotations

import io
import math

import numpy as np
import numpy.typing as npt
from PIL import Image

from airhilt.imaging.view import Intrinsics
from airhilt.scenario.models import Imaging
from airhilt.sim.streams import stream

IDEAL = Imaging(vignetting=0.0, blur_px=0.0, fixed_pattern=0.0)
"""Lens, sensor and coder that change nothing."""
ONE = 256
"""Fixed-point 1 of the weights of the blur."""
FULL_GAIN = 4096
"""Fixed-point 1 of gains."""
MOST_BLUR_PX = 0.6
"""Greatest deviation of one pass of the blur, in pixels."""
ENCODED = 1.0 / 2.2
"""Power by which encoded levels follow the light, about: IEC 61966-2-1."""
SPARE_PX = 64
"""Pixels by which the pattern of the noise is larger than a picture, to be moved about."""

Pixels = npt.NDArray[np.uint8]
Levels = npt.NDArray[np.uint16]


class ImageSensor:
    """Makes of what falls into a camera the picture that it gives.

    Parameters
    ----------
    name
        Name of the camera, by which its fixed pattern differs from those of others.
    """

    def __init__(self, name: str, lens: Intrinsics, imaging: Imaging) -> None:
        shape = lens.height_px, lens.width_px
        self._imaging = imaging
        draws = stream(0, f"image sensor/{name}")
        x = np.arange(lens.width_px) + 0.5 - lens.width_px / 2.0
        y = np.arange(lens.height_px) + 0.5 - lens.height_px / 2.0
        cosine = lens.focal_px / np.sqrt(x**2 + y[:, None] ** 2 + lens.focal_px**2)
        light = 2.0**imaging.exposure_ev * cosine ** (4.0 * imaging.vignetting)
        pattern = draws.standard_normal((*shape, 3), np.float32)
        light = light[..., None] * (1.0 + imaging.fixed_pattern * pattern)
        gains = np.round(FULL_GAIN * np.maximum(light, 0.0) ** ENCODED)
        self._name, self._gains = name, gains.astype(np.uint32)
        # Kept from picture to picture: getting memory takes longer than computing.
        self._levels, self._spare = np.empty((2, *gains.shape), np.uint16)
        self._pixels = np.empty(gains.shape, np.uint32)
        self._light: Pixels | None = None
        """The last light."""
        self._exposed = np.empty(gains.shape, np.uint8)
        """Picture of the last light, before noise and coding."""
        if imaging.noise_levels > 0.0:
            size = shape[0] + SPARE_PX, shape[1] + SPARE_PX, 3
            grain = draws.standard_normal(size, np.float32)
            self._grain = np.round(imaging.noise_levels * grain).astype(np.int16)

    def expose(self, light: Pixels, number: int) -> Pixels:
        """Return the picture of some light, given in 8-bit sRGB; noise differs by its number."""
        rows = _changed_rows(self._light, light)
        if rows is not None:
            self._expose(light, rows)
            self._light = light.copy()
        if self._imaging.noise_levels > 0.0:
            draws = stream(0, f"noise/{self._name}", number)
            row, column = draws.integers(SPARE_PX, size=2)
            grain = self._grain[row : row + light.shape[0], column : column + light.shape[1]]
            grain = grain[:: draws.choice((-1, 1)), :: draws.choice((-1, 1))]
            return self._coded(np.clip(self._exposed + grain, 0, 255).astype(np.uint8))
        return self._coded(self._exposed.copy())

    def _expose(self, light: Pixels, changed: slice) -> None:
        """Expose anew what changed rows reach: a row further in each pass of the blur."""
        passes = math.ceil((self._imaging.blur_px / MOST_BLUR_PX) ** 2)
        height = len(light)
        first, end = max(changed.start - passes, 0), min(changed.stop + passes, height)
        about = slice(max(first - passes, 0), min(end + passes, height))
        levels, spare = self._levels[about], self._spare[about]
        levels[...] = light[about]
        side = round(ONE * self._imaging.blur_px**2 / max(passes, 1) / 2.0)
        for _ in range(passes):
            _blur(levels, spare, side, 1)
            _blur(levels, spare, side, 0)
        reached = slice(first, end)
        pixels = self._pixels[reached]
        np.multiply(self._levels[reached], self._gains[reached], out=pixels)
        pixels += FULL_GAIN // 2
        pixels //= FULL_GAIN
        np.minimum(pixels, 255, out=pixels)
        self._exposed[reached] = pixels

    def _coded(self, pixels: Pixels) -> Pixels:
        if self._imaging.jpeg_quality is None:
            return pixels
        coded = io.BytesIO()
        Image.fromarray(pixels).save(coded, "JPEG", quality=self._imaging.jpeg_quality)
        return np.array(Image.open(coded))


def _changed_rows(before: Pixels | None, now: Pixels) -> slice | None:
    """Return the rows from the first that has changed to the last; None if none has."""
    if before is None:
        return slice(0, len(now))
    changed = np.flatnonzero((before != now).reshape(len(now), -1).any(axis=1))
    return slice(int(changed[0]), int(changed[-1]) + 1) if len(changed) else None


def _blur(levels: Levels, spare: Levels, side: int, axis: int) -> None:
    """Give each level ``side`` parts in `ONE` of each neighbour along an axis."""
    np.multiply(levels, np.uint16(side), out=spare)
    levels *= np.uint16(ONE - 2 * side)
    sums, shares = np.moveaxis(levels, axis, 0), np.moveaxis(spare, axis, 0)
    sums[1:] += shares[:-1]
    sums[:-1] += shares[1:]
    sums[0] += shares[0]
    sums[-1] += shares[-1]
    levels += np.uint16(ONE // 2)
    levels //= np.uint16(ONE)
