"""Figures of the page."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from airhilt.report.figures import COLOURS, MARKERS, PANEL, Figures
from airhilt.sweep.evaluation.tables import Cell, Quantity, Table

WIDTH_IN, HEIGHT_IN = 5.6, 3.8


@dataclass(frozen=True)
class Scatter:
    """Two columns of a table against each other, with their intervals.

    Rows that begin with the same cell, one after the other, are one series.
    """

    name: str
    table: str
    x: str
    y: str

    def draw(self, name: str, table: Table, figures: Figures) -> None:
        """Draw the figure under a name."""
        with figures.drawing(name, WIDTH_IN, HEIGHT_IN) as figure:
            background = {"boxstyle": "square,pad=60", "facecolor": PANEL, "edgecolor": "none"}
            figure.text(0.5, 0.5, " ", bbox=background, zorder=-1)
            axes = figure.subplots()
            for place, (label, points) in enumerate(self._series(table)):
                _plot(axes, place, label, points)
            axes.set(xlabel=self.x, ylabel=self.y)
            axes.grid(visible=True)
            figure.legend(loc="outside right upper")

    def _series(self, table: Table) -> Iterator[tuple[str, list[tuple[Quantity, Quantity]]]]:
        x, y = table.columns.index(self.x), table.columns.index(self.y)
        for label, rows in groupby(table.rows, key=lambda row: row[0]):
            yield str(label), [pair for row in rows if (pair := _known(row[x], row[y]))]


def _known(x: Cell, y: Cell) -> tuple[Quantity, Quantity] | None:
    """Return two cells if both have a number."""
    if isinstance(x, Quantity) and isinstance(y, Quantity) and None not in (x.value, y.value):
        return x, y
    return None


def _plot(axes: Any, place: int, label: str, points: list[tuple[Quantity, Quantity]]) -> None:
    colour = COLOURS[place % len(COLOURS)]
    limits = {"color": colour, "linewidth": 0.8, "alpha": 0.5}
    for x, y in points:
        if x.low is not None:
            axes.plot([x.low, x.high], [y.value, y.value], **limits)
        if y.low is not None:
            axes.plot([x.value, x.value], [y.low, y.high], **limits)
    axes.plot([x.value for x, _ in points], [y.value for _, y in points], color=colour,
              label=label, marker=MARKERS[place % len(MARKERS)], markersize=5,
              linewidth=1.0)  # fmt: skip
