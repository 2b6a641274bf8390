"""The axes of figures: parameters of a sweep and their levels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

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


class Level(NamedTuple):
    """One value of a parameter in words, or a bin of values.

    Its position is the value, or the mean of those in the bin; a place in the order for what is no
    number.
    """

    label: str
    position: float


@dataclass(frozen=True)
class Axis:
    """One parameter with its levels, in rising order."""

    name: str
    unit: str
    is_numeric: bool
    levels: tuple[Level, ...]
    places: Series
    """Place of each run among the levels, -1 where the run leaves the parameter to its scenario."""
    distinct: int
    """Number of different values; more than there are levels if these are bins."""

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
        return np.asarray(self.places.loc[runs.index] == self.levels.index(level))


def axis_of(name: str, values: Series, unit: str) -> Axis:
    """Return a parameter as an axis; many numbers are put into bins."""
    present = values.dropna()
    is_numeric = len(present) > 0 and present.dtype.kind in "iuf"
    keys = present.astype("float64") if is_numeric else present.map(_label)
    distinct = sorted(set(keys))
    places = keys.map({key: place for place, key in enumerate(distinct)})
    levels = [Level(str(key), float(place)) for place, key in enumerate(distinct)]
    if is_numeric and len(distinct) > MOST_LEVELS:
        limits = np.unique(np.quantile(keys, np.linspace(0.0, 1.0, BINS + 1)))
        places[:] = np.searchsorted(limits[1:-1], keys, side="right")
        names = [number_text(float(f"{limit:.3g}")) for limit in limits]
        means = keys.groupby(places).mean()
        levels = [Level("–".join(ends), means[n]) for n, ends in enumerate(pairwise(names))]
    elif is_numeric:
        levels = [Level(number_text(number), number) for number in distinct]
    places = places.reindex(values.index, fill_value=-1)
    return Axis(name, unit, is_numeric, tuple(levels), places, len(distinct))


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


def _unevenness(places: NDArray[np.float64]) -> float:
    """Return the spread of the steps between places, by their mean."""
    steps = np.diff(places)
    return float(steps.std() / steps.mean())


def _label(value: Any) -> str:
    if isinstance(value, bool | np.bool_):
        return "yes" if value else "no"
    return str(value)
