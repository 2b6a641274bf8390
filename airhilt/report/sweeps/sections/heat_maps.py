"""Heat maps: what comes of each pair of values of two parameters, for each assistant."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from airhilt.metrics.measures import (
    AVOIDED,
    FIRST_DETECTION,
    IN_TIME,
    MISSED,
    TIME_TO_FIRST_WARNING,
    WORD_ERRORS,
    Measure,
)
from airhilt.report.figures import DIM, PANEL, Figures
from airhilt.report.sweeps.axes import Axis, heat_map_axes
from airhilt.report.sweeps.data import SweepData
from airhilt.report.sweeps.figure_section import HERE, figure_json, section_json
from airhilt.report.sweeps.sections import SweepSection
from airhilt.report.sweeps.words import short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame

MEASURES = (TIME_TO_FIRST_WARNING, MISSED, AVOIDED, IN_TIME, WORD_ERRORS, FIRST_DETECTION)
COLUMNS = 3
"""Panels beside each other."""
DARK = 0.55
"""Luminance below which a colour needs white text."""
WHITE, BLACK = "#fffffe", "#000001"
"""Colours of text on a colour; a file leaves out plain black, which a page would then choose."""


class _Cells:
    """A measure for each pair of values of two parameters, for the runs of one assistant."""

    def __init__(self, measure: Measure, axes: tuple[Axis, Axis], runs: DataFrame) -> None:
        x, y = axes
        across = [x.among(runs, level) for level in x.levels]
        measured = runs[[name for name in measure.columns if name in runs]]
        self.values = np.full((len(y.levels), len(x.levels)), np.nan)
        self.counts = np.zeros(self.values.shape, dtype=int)
        for row, level in enumerate(y.levels):
            down = y.among(runs, level)
            for column, here in enumerate(across):
                found = measure.estimate(measured[here & down])
                self.counts[row, column] = found.n
                if found.value is not None:
                    self.values[row, column] = found.value


def content(sweep: SweepData, figures: Figures) -> dict[str, Any] | None:
    """Return the heat maps, None without two parameters to draw them over."""
    axes = heat_map_axes(sweep.axes())
    if axes is None:
        return None
    found = []
    for family, runs in sweep.families():
        for measure in MEASURES:
            panels = {
                assistant: _Cells(measure, axes, runs[runs["assistant"] == assistant])
                for assistant in sweep.assistants
            }
            panels = {name: cells for name, cells in panels.items() if cells.counts.any()}
            if panels:
                name = figures.name_for("heat_map", measure.name, family)
                width_in = _draw(figures, name, measure, axes, panels)
                choice = {"Measure": measure.title, "Family": family}
                found.append(figure_json(sweep, name, measure.label, width_in, choice))
    x, y = axes
    return section_json(
        "heat_maps",
        f"{y.title} and {x.title[0].lower()}{x.title[1:]}",
        "Each cell is over all runs with its two values: all seeds and all other parameters. The "
        "small number counts the runs that have a value; a dash stands where none has.",
        found,
    )


def _draw(
    figures: Figures,
    name: str,
    measure: Measure,
    axes: tuple[Axis, Axis],
    panels: dict[str, _Cells],
) -> float:
    """Draw a panel for each assistant, in one scale of colours; return the width in inches."""
    columns = min(COLUMNS, len(panels))
    rows = -(-len(panels) // columns)
    x, y = axes
    size_in = max(2.6, 0.55 * len(x.levels) + 0.7), max(2.0, 0.42 * len(y.levels) + 0.8)
    width_in, height_in = size_in[0] * columns + 1.1, size_in[1] * rows + 0.3
    every = np.concatenate([cells.values.ravel() for cells in panels.values()])
    limits = (0.0, 100.0) if measure.kind == "share" else (np.nanmin(every), np.nanmax(every))
    with figures.drawing(name, width_in, height_in) as figure:
        import matplotlib as mpl

        norm = mpl.colors.Normalize(*limits)
        colours = mpl.cm.ScalarMappable(norm, mpl.colormaps["viridis"].resampled(64))
        grid = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
        for place, axes_ in enumerate(grid.flat):
            if place >= len(panels):
                axes_.set_visible(False)
                continue
            assistant, cells = list(panels.items())[place]
            _panel(axes_, cells, measure, colours)
            axes_.set_title(assistant)
            axes_.set_xticks(range(len(x.levels)), [level.label for level in x.levels])
            axes_.set_yticks(range(len(y.levels)), [level.label for level in y.levels])
            if len(x.levels) > 6 or max(len(level.label) for level in x.levels) > 5:
                axes_.tick_params(axis="x", labelrotation=45)
        figure.supxlabel(x.label, fontsize=9)
        figure.supylabel(y.label, fontsize=9)
        bar = figure.colorbar(colours, ax=grid, label=measure.label, shrink=0.9, pad=0.02)
        bar.outline.set_visible(False)
    return width_in


def _panel(axes: Axes, cells: _Cells, measure: Measure, colours: Any) -> None:
    from matplotlib.patches import Rectangle

    rows, columns = cells.values.shape
    axes.set(xlim=(-0.5, columns - 0.5), ylim=(-0.5, rows - 0.5))
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0)
    for row, column in np.ndindex(rows, columns):
        value = float(cells.values[row, column])
        if np.isnan(value):
            axes.text(column, row, "–", ha="center", va="center", color=DIM, in_layout=False)
            continue
        red, green, blue, _ = colours.to_rgba(value)
        place, colour = (column - 0.5, row - 0.5), (red, green, blue)
        axes.add_patch(Rectangle(place, 1, 1, facecolor=colour, edgecolor=PANEL, linewidth=1.2))
        luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue
        ink = WHITE if luminance < DARK else BLACK
        own: dict[str, Any] = {"ha": "center", "va": "center", "color": ink, "in_layout": False}
        axes.text(column, row + 0.1, short(value, measure.unit), fontsize=8.5, **own)
        axes.text(column, row - 0.28, f"n={cells.counts[row, column]}", fontsize=5.5, **own)


SECTION = SweepSection("heat_maps", order=30, module=HERE, content=content)
