"""Curves: what comes of each value of a parameter, with 95 % confidence bands."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from airhilt.metrics.estimates import Estimate
from airhilt.metrics.measures import (
    AVOIDED,
    FIRST_DETECTION,
    IN_TIME,
    LOST,
    MISSED,
    NUISANCE,
    TIME_TO_FIRST_WARNING,
    WORD_ERRORS,
    Measure,
)
from airhilt.report.figures import COLOURS, MARKERS, Figures
from airhilt.report.sweeps.axes import Axis, Level
from airhilt.report.sweeps.data import SweepData
from airhilt.report.sweeps.figure_section import HERE, figure_json, section_json
from airhilt.report.sweeps.sections import SweepSection

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame

MEASURES = (
    TIME_TO_FIRST_WARNING, IN_TIME, MISSED, AVOIDED, LOST, NUISANCE, WORD_ERRORS, FIRST_DETECTION,
)  # fmt: skip
WIDTH_IN, HEIGHT_IN = 6.4, 3.4
MOST_CHARACTERS = 40
"""Characters of all labels of an axis for which there is room beside each other."""
Curve = list[tuple[Level, Estimate]]


def content(sweep: SweepData, figures: Figures) -> dict[str, Any] | None:
    """Return the curves, None without a numeric parameter."""
    found = []
    for axis in (axis for axis in sweep.axes() if axis.is_numeric):
        for family, runs in sweep.families():
            for measure in MEASURES:
                curves = _curves(measure, axis, runs, sweep.assistants)
                if not curves:
                    continue
                name = figures.name_for("curve", measure.name, axis.name, family)
                _draw(figures, name, measure, axis, curves)
                choice = {"Over": axis.title, "Measure": measure.title, "Family": family}
                caption = f"{measure.label} over {axis.title[0].lower()}{axis.title[1:]}"
                found.append(figure_json(sweep, name, caption, WIDTH_IN, choice))
    return section_json(
        "curves",
        "Curves",
        "Each point is over all runs with that value, with its 95 % interval over the "
        "scenarios, or over the seeds of one scenario.",
        found,
    )


def _curves(
    measure: Measure, axis: Axis, runs: DataFrame, assistants: list[str]
) -> dict[str, Curve]:
    """Return the points of each assistant for which more than one is known."""
    curves: dict[str, Curve] = {}
    for assistant in assistants:
        own = runs[runs["assistant"] == assistant]
        points = [(level, measure.estimate(own[axis.among(own, level)]))
                  for level in axis.levels]  # fmt: skip
        known = [(level, found) for level, found in points if found.value is not None]
        if len(known) > 1:
            curves[assistant] = known
    return curves


def _draw(
    figures: Figures, name: str, measure: Measure, axis: Axis, curves: dict[str, Curve]
) -> None:
    with figures.drawing(name, WIDTH_IN, HEIGHT_IN) as figure:
        axes = figure.subplots()
        for place, (assistant, curve) in enumerate(curves.items()):
            _curve(axes, place, assistant, curve)
        if axis.is_logarithmic:
            axes.set_xscale("log")
        axes.set_xticks([level.position for level in axis.levels],
                        [level.label for level in axis.levels])  # fmt: skip
        axes.minorticks_off()
        if sum(len(level.label) for level in axis.levels) > MOST_CHARACTERS:
            axes.tick_params(axis="x", labelrotation=45)
        axes.grid(axis="y")
        axes.set(xlabel=axis.label, ylabel=measure.label)
        if measure.kind == "share":
            axes.set_ylim(-3.0, 103.0)
        elif measure.kind == "per_hour":
            axes.set_ylim(bottom=0.0)
        if len(curves) > 1:
            figure.legend(loc="outside right upper")


def _curve(axes: Axes, place: int, assistant: str, curve: Curve) -> None:
    colour = COLOURS[place % len(COLOURS)]
    xs = np.array([level.position for level, _ in curve])
    found = np.array([(each.value, each.low, each.high) for _, each in curve], dtype=np.float64)
    axes.plot(xs, found[:, 0], color=colour, label=assistant,
              marker=MARKERS[place % len(MARKERS)], markersize=5)  # fmt: skip
    axes.fill_between(xs, found[:, 1], found[:, 2], color=colour, alpha=0.16, linewidth=0)


SECTION = SweepSection("curves", order=40, module=HERE, content=content)
