"""Sizes of bodies."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol


class Size(Protocol):
    """Length, width and height, which `Dimensions` and those of an aircraft type both have."""

    @property
    def length_m(self) -> float: ...  # noqa: D102
    @property
    def span_m(self) -> float: ...  # noqa: D102
    @property
    def height_m(self) -> float: ...  # noqa: D102


@dataclass(frozen=True, slots=True, kw_only=True)
class Dimensions:
    """The box around something, lined up with its heading.

    Raises
    ------
    ValueError
        A value is not a finite number above 0.
    """

    length_m: float
    span_m: float
    height_m: float
    """Its extent along the heading, across it, and up."""

    def __post_init__(self) -> None:
        for name in ("length_m", "span_m", "height_m"):
            value = getattr(self, name)
            if not 0.0 < value < math.inf:
                raise ValueError(f"{name} is {value}; expected a finite number above 0")
