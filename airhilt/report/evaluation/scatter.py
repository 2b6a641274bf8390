"""Figures of the tables of an evaluation: two of their columns against each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any

from airhilt.report.figures import COLOURS, MARKERS, PANEL, Figures

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Cells = Mapping[str, Any]
WIDTH_IN, HEIGHT_IN = 6.4, 4.0
BACKGROUND = {"boxstyle": "square,pad=60", "facecolor": PANEL, "edgecolor": "none"}


def draw(figures: Figures, name: str, table: Mapping[str, Any], *, on_panel: bool = True) -> None:
    """Draw the figure of a table, which is as JSON has it, under a name.

    Each point has its intervals, and each series of several a band along them. A figure that is not
    on a panel of a page has a background of its own.
    """
    wanted = table["figure"]
    with figures.drawing(name, WIDTH_IN, HEIGHT_IN) as figure:
        if not on_panel:
            figure.text(0.5, 0.5, " ", bbox=BACKGROUND, zorder=-1)
        axes = figure.subplots()
        for place, (label, points) in enumerate(_series(table, wanted["x"], wanted["y"])):
            _plot(axes, place, label, points)
        axes.set(xlabel=wanted["x"], ylabel=wanted["y"])
        if wanted["x_scale"] == "symlog":
            _scale_by_logarithm(axes)
        axes.grid(visible=True)
        if axes.lines:
            figure.legend(loc="outside right upper")


def _scale_by_logarithm(axes: Axes) -> None:
    """Let the x axis, of rates, go by the logarithm from 1 on, and begin a little below 0."""
    from matplotlib.ticker import SymmetricalLogLocator

    axes.set_xscale("symlog", linthresh=1.0)
    axes.set_xlim(left=-0.2)
    axes.xaxis.set_major_locator(SymmetricalLogLocator(base=10.0, linthresh=1.0, subs=(1.0, 3.0)))
    axes.xaxis.set_major_formatter("{x:g}")


def _series(
    table: Mapping[str, Any], x_name: str, y_name: str
) -> Iterator[tuple[str, list[tuple[Cells, Cells]]]]:
    """Yield the points of rows that begin with the same cell, one after the other."""
    x, y = (table["columns"].index(name) for name in (x_name, y_name))
    for label, rows in groupby(table["rows"], key=lambda row: row[0]):
        points = [(row[x], row[y]) for row in rows]
        known = [pair for pair in points if all(_is_known(cell) for cell in pair)]
        if known:
            yield str(label), known


def _is_known(cell: Any) -> bool:
    return isinstance(cell, Mapping) and cell["value"] is not None


def _plot(axes: Axes, place: int, label: str, points: Sequence[tuple[Cells, Cells]]) -> None:
    colour = COLOURS[place % len(COLOURS)]
    limits: dict[str, Any] = {"color": colour, "linewidth": 0.8, "alpha": 0.5}
    for x, y in points:
        if x["low"] is not None:
            axes.hlines(y["value"], x["low"], x["high"], **limits)
        if y["low"] is not None:
            axes.vlines(x["value"], y["low"], y["high"], **limits)
    xs, ys = ([one["value"] for one in axis] for axis in zip(*points, strict=True))
    axes.plot(xs, ys, color=colour, label=label, marker=MARKERS[place % len(MARKERS)],
              markersize=5, linewidth=1.2)  # fmt: skip
    lows, highs = ([y[end] for _, y in points] for end in ("low", "high"))
    if len(points) > 1 and None not in (*lows, *highs):
        axes.fill_between(xs, lows, highs, color=colour, alpha=0.12, linewidth=0)
