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
"""Fixed-point 1 of weights and gains."""
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
        gains = np.round(ONE * np.maximum(light, 0.0) ** ENCODED)
        self._gains = gains.astype(np.uint32 if gains.max() > ONE else np.uint16)
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
        pixels = np.multiply(seen, self._gains, dtype=self._gains.dtype)
        pixels += ONE // 2
        pixels //= ONE
        if pixels.dtype != np.uint16:
            np.minimum(pixels, 255, out=pixels)
        if self._imaging.noise_levels > 0.0:
            row, column = number * 37 % SPARE_PX, number * 23 % SPARE_PX
            grain = self._grain[row : row + light.shape[0], column : column + light.shape[1]]
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
    spread = levels * np.uint16(ONE - 2 * side)
    spread += ONE // 2
    ahead, behind = [slice(None)] * 3, [slice(None)] * 3
    ahead[axis], behind[axis] = slice(1, None), slice(None, -1)
    part = levels * np.uint16(side)
    spread[tuple(ahead)] += part[tuple(behind)]
    spread[tuple(behind)] += part[tuple(ahead)]
    for end in (0, -1):
        edge = [slice(None)] * 3
        edge[axis] = slice(0, 1) if end == 0 else slice(-1, None)
        spread[tuple(edge)] += part[tuple(edge)]
    spread //= ONE
    return spread
