"""The axes of figures: parameters of a sweep and their levels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from pandas import DataFrame, Series

Mask = NDArray[np.bool_]

MOST_LEVELS = 12
"""Greatest number of values that are shown one by one; more of them are put into bins."""
BINS = 6
DECIBEL = "dB"
"""Unit that is logarithmic itself."""
TITLES = {
    "snr_db": "Signal-to-noise ratio",
    "visibility_m": "Visibility",
    "assistant": "Assistant",
    "family": "Family",
    "scenario": "Scenario",
}
"""Parameters that have a name in words."""


@dataclass(frozen=True)
class Level:
    """One value of a parameter in words, or a bin of values between two limits.

    Its position is the value, or the mean of those in the bin; a place in the order for what is no
    number.
    """

    label: str
    position: float
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True)
class Axis:
    """One parameter with its levels, in rising order, and the value of each run, or null."""

    name: str
    unit: str
    is_numeric: bool
    levels: tuple[Level, ...]
    values: Series

    @property
    def title(self) -> str:
        """The parameter in words."""
        return TITLES.get(self.name, self.name)

    @property
    def label(self) -> str:
        """Title with the unit."""
        return f"{self.title} ({self.unit})" if self.unit not in ("", "1") else self.title

    @property
    def is_logarithmic(self) -> bool:
        """True if the levels are spaced more evenly by their ratios than by their differences."""
        places = np.array([level.position for level in self.levels])
        if not self.is_numeric or len(places) < 3 or places[0] <= 0.0 or self.unit == DECIBEL:
            return False
        return _unevenness(np.log(places)) < _unevenness(places)

    def among(self, runs: DataFrame, level: Level) -> Mask:
        """Return which of some runs are at a level."""
        return np.asarray(self._at(level).loc[runs.index], dtype=np.bool_)

    def _at(self, level: Level) -> Series:
        if level.low is not None and level.high is not None:
            is_last = level is self.levels[-1]
            below = self.values <= level.high if is_last else self.values < level.high
            return ((self.values >= level.low) & below).fillna(False)
        if self.is_numeric:
            return (self.values == level.position).fillna(False)
        return (self.values.map(_label, na_action="ignore") == level.label).fillna(False)


def axis_of(name: str, values: Series, unit: str) -> Axis:
    """Return a parameter as an axis; many numbers are put into bins."""
    present = values.dropna()
    if not _is_numeric(present):
        labels = sorted({_label(value) for value in present})
        levels = [Level(label, float(place)) for place, label in enumerate(labels)]
        return Axis(name, unit, False, tuple(levels), values)
    numbers = sorted({float(value) for value in present})
    if len(numbers) > MOST_LEVELS:
        return Axis(name, unit, True, _bins(present.to_numpy(dtype=np.float64)), values)
    return Axis(name, unit, True, tuple(Level(number_text(n), n) for n in numbers), values)


def number_text(number: float) -> str:
    """Return a number with at most four significant digits, whole ones without a power of ten."""
    return str(int(number)) if number == int(number) and abs(number) < 1e6 else f"{number:.4g}"


def heat_map_axes(axes: Sequence[Axis]) -> tuple[Axis, Axis] | None:
    """Return the axes of heat maps: SNR and visibility, or the two with the most levels."""
    numeric = [axis for axis in axes if axis.is_numeric]
    named = {axis.name: axis for axis in numeric}
    if "snr_db" in named and "visibility_m" in named:
        return named["snr_db"], named["visibility_m"]
    if len(numeric) < 2:
        return None
    first, second = sorted(numeric, key=lambda axis: -len(axis.levels))[:2]
    return first, second


def _is_numeric(values: Series) -> bool:
    return len(values) > 0 and values.dtype.kind in "iuf"


def _unevenness(places: NDArray[np.float64]) -> float:
    """Return the spread of the steps between places, by their mean."""
    steps = np.diff(places)
    return float(steps.std() / steps.mean())


def _label(value: Any) -> str:
    if isinstance(value, bool | np.bool_):
        return "yes" if value else "no"
    return str(value)


def _bins(numbers: NDArray[np.float64]) -> tuple[Level, ...]:
    limits = np.unique(np.quantile(numbers, np.linspace(0.0, 1.0, BINS + 1)))
    levels = []
    for begin, end in pairwise(float(limit) for limit in limits):
        below = numbers <= end if end == limits[-1] else numbers < end
        inside = numbers[(numbers >= begin) & below]
        label = "–".join(number_text(float(f"{limit:.3g}")) for limit in (begin, end))
        levels.append(Level(label, float(inside.mean()), begin, end))
    return tuple(levels)
