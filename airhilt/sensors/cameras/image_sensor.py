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
        if imaging.noise_levels > 0.0:
            size = shape[0] + SPARE_PX, shape[1] + SPARE_PX, 3
            grain = draws.standard_normal(size, np.float32)
            self._grain = np.round(imaging.noise_levels * grain).astype(np.int16)

    def expose(self, light: Pixels, number: int) -> Pixels:
        """Return the picture of some light, given in 8-bit sRGB; noise differs by its number."""
        seen = light.astype(np.uint16)
        passes = math.ceil((self._imaging.blur_px / MOST_BLUR_PX) ** 2)
        for _ in range(passes):
            side = round(ONE * self._imaging.blur_px**2 / passes / 2.0)
            seen = _blurred(_blurred(seen, side, 1), side, 0)
        pixels = seen * self._gains
        pixels += FULL_GAIN // 2
        pixels //= FULL_GAIN
        np.minimum(pixels, 255, out=pixels)
        if self._imaging.noise_levels > 0.0:
            draws = stream(0, f"noise/{self._name}", number)
            row, column = draws.integers(SPARE_PX, size=2)
            grain = self._grain[row : row + light.shape[0], column : column + light.shape[1]]
            grain = grain[:: draws.choice((-1, 1)), :: draws.choice((-1, 1))]
            return self._coded(np.clip(pixels + grain, 0, 255).astype(np.uint8))
        return self._coded(pixels.astype(np.uint8))

    def _coded(self, pixels: Pixels) -> Pixels:
        if self._imaging.jpeg_quality is None:
            return pixels
        coded = io.BytesIO()
        Image.fromarray(pixels).save(coded, "JPEG", quality=self._imaging.jpeg_quality)
        return np.array(Image.open(coded))


def _blurred(levels: npt.NDArray[np.uint16], side: int, axis: int) -> npt.NDArray[np.uint16]:
    """Return levels with ``side`` parts in `ONE` of each neighbour along an axis."""
    rows = np.moveaxis(levels, axis, 0)
    ahead = np.concatenate((rows[:1], rows[:-1]))
    behind = np.concatenate((rows[1:], rows[-1:]))
    spread = rows * np.uint16(ONE - 2 * side)
    spread += (ahead + behind) * np.uint16(side)
    spread += ONE // 2
    spread //= ONE
    return np.moveaxis(spread, 0, axis)
