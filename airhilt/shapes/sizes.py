"""Sizes of bodies."""

from __future__ import annotations

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
    """The box around something, lined up with its heading: along it, across it, and up."""

    length_m: float
    span_m: float
    height_m: float
