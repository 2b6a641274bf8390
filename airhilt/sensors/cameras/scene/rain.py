"""Rain: what it takes from the visibility, and the streaks before the lens."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from airhilt.sim.streams import stream

HEAVY_MM_H = 50.0
STREAKS = 260
"""Number of streaks in a picture of 640 by 360 pixels, in heavy rain."""
PATTERNS = 8


def rain_visibility_m(rain_mm_h: float) -> float:
    """Return the meteorological visibility in rain.

    Notes
    -----
    11.6 km R ** -0.63 for widespread rain of R mm/h: D. Atlas, Journal of Meteorology 10 (1953)
    486-488.
    """
    return math.inf if rain_mm_h <= 0.0 else 11_600.0 * rain_mm_h**-0.63


class Streaks:
    """Streaks of drops, drawn once and then used in turn."""

    def __init__(self, size: tuple[int, int], rain_mm_h: float, name: str) -> None:
        width, height = size
        draws = stream(0, f"rain/{name}")
        count = round(STREAKS * math.sqrt(min(rain_mm_h / HEAVY_MM_H, 1.5)) * width * height
                      / (640 * 360))  # fmt: skip
        self._patterns = [self._pattern(width, height, count, draws) for _ in range(PATTERNS)]

    @staticmethod
    def _pattern(
        width: int, height: int, count: int, draws: np.random.Generator
    ) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.float32]]:
        """Return pixels of a flat picture that streaks cover, and how much of each."""
        length = draws.uniform(0.03, 0.1, size=count) * height
        column = draws.uniform(0.0, width, size=count)
        row = draws.uniform(-0.1, 1.0, size=count) * height
        strength = draws.uniform(0.08, 0.3, size=count)
        steps = np.arange(int(0.1 * height) + 1)
        rows = row[:, None] + steps
        columns = column[:, None] + 0.12 * steps
        inside = (
            (steps < length[:, None]) & (rows >= 0) & (rows < height)
            & (columns >= 0) & (columns < width)
        )  # fmt: skip
        flat = rows[inside].astype(np.intp) * width + columns[inside].astype(np.intp)
        pixels, first = np.unique(flat, return_index=True)
        cover = np.broadcast_to(strength[:, None], inside.shape)[inside][first]
        return pixels, cover.astype(np.float32)

    def fall(self, picture: npt.NDArray[np.uint8], number: int, bright: float) -> None:
        """Draw the streaks of a picture of some number over it."""
        pixels, cover = self._patterns[number * 5 % PATTERNS]
        flat = picture.reshape(-1, 3)
        seen = flat[pixels].astype(np.float32)
        seen += (np.float32(bright) - seen) * cover[:, None]
        flat[pixels] = seen.astype(np.uint8)
