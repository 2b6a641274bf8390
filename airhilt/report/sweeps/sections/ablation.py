"""Bars: what comes of each assistant, and of each setting that is no number."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from airhilt.metrics.estimates import Estimate
from airhilt.metrics.measures import AVOIDED, IN_TIME, NOMINAL_NUISANCE, NUISANCE, WARNED, Measure
from airhilt.report.figures import COLOURS, INK, Figures
from airhilt.report.sweeps.axes import Axis, axis_of
from airhilt.report.sweeps.data import SweepData
from airhilt.report.sweeps.figure_section import HERE, figure_json, section_json
from airhilt.report.sweeps.sections import SweepSection
from airhilt.report.sweeps.words import short

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame

MOST_BARS = 80
"""Greatest number of bars in a panel; more of them cannot be read."""
BAR_IN = 0.24
"""Height of a bar, in inches."""
OPACITY = 0.75
Series = dict[str, "DataFrame"]


def content(sweep: SweepData, figures: Figures) -> dict[str, Any] | None:
    """Return the bars, None if no run has finished."""
    found = []
    for family, runs in sweep.families():
        for axis in _groupings(sweep, family, runs):
            series: Series = {"": runs}
            if axis.name != "assistant" and len(sweep.assistants) > 1:
                series = {name: runs[runs["assistant"] == name] for name in sweep.assistants}
            if len(axis.levels) * len(series) > MOST_BARS:
                continue
            measures = [each for each in _measures(runs) if each.estimate(runs).n]
            if not measures:
                continue
            name = figures.name_for("bars", axis.name, family)
            width_in = _draw(figures, name, measures, axis, series)
            choice = {"By": axis.title, "Family": family}
            found.append(figure_json(sweep, name, f"By {axis.title.lower()}", width_in, choice))
    return section_json(
        "ablation",
        "Comparison",
        "With 95 % intervals over the scenarios, or over the seeds of one scenario. "
        "Avoided is counted among the runs in which somebody was warned or the conflict came "
        "about.",
        found,
    )


def _groupings(sweep: SweepData, family: str, runs: DataFrame) -> list[Axis]:
    """Return what the runs are put into groups by: assistant first, then settings and names."""
    axes = [axis for axis in sweep.axes() if not axis.is_numeric]
    names = ("family", "scenario") if family == "all" else ("scenario",)
    axes += [axis_of(name, sweep.finished[name].replace("", None), "") for name in names]
    several = [axis for axis in axes if len({*axis.places.loc[runs.index]} - {-1}) > 1]
    return several or [axis_of("assistant", sweep.finished["assistant"], "")]


def _measures(runs: DataFrame) -> tuple[Measure, ...]:
    has_nominal = bool(runs["nominal"].fillna(False).any())
    return AVOIDED, WARNED, IN_TIME, NOMINAL_NUISANCE if has_nominal else NUISANCE


def _draw(
    figures: Figures, name: str, measures: list[Measure], axis: Axis, series: Series
) -> float:
    """Draw a panel for each measure; return the width in inches."""
    levels = [
        level
        for level in axis.levels
        if any(axis.among(runs, level).any() for runs in series.values())
    ]
    width_in = 2.3 * len(measures) + 0.07 * max(len(level.label) for level in levels) + 0.3
    height_in = BAR_IN * len(levels) * (len(series) + 0.6) + 1.0
    with figures.drawing(name, width_in, max(height_in, 1.6)) as figure:
        grid = figure.subplots(1, len(measures), sharey=True, squeeze=False)
        for axes, measure in zip(grid.flat, measures, strict=True):
            for place, runs in enumerate(series.values()):
                bars = [measure.estimate(runs[axis.among(runs, level)]) for level in levels]
                _bars(axes, measure, bars, place, len(series))
            axes.set_title(measure.title)
            axes.set_xlabel(f"{measure.unit}")
            axes.set_yticks(range(len(levels)), [level.label for level in levels])
            axes.set_ylim(len(levels) - 0.4, -0.6)
            axes.tick_params(axis="y", length=0, labelcolor=INK)
            axes.grid(axis="x")
            if measure.kind == "share":
                axes.set_xlim(0.0, 128.0)
                axes.set_xticks([0, 25, 50, 75, 100])
            else:
                axes.set_xlim(0.0, max(1.3 * axes.get_xlim()[1], 1.0))
        if len(series) > 1:
            from matplotlib.patches import Patch

            handles = [Patch(color=_colour(place), label=label, alpha=OPACITY)
                       for place, label in enumerate(series)]  # fmt: skip
            figure.legend(handles=handles, loc="outside lower center", ncols=min(4, len(series)))
    return width_in


def _colour(place: int) -> str:
    return COLOURS[place % len(COLOURS)]


def _bars(axes: Axes, measure: Measure, bars: list[Estimate], place: int, among: int) -> None:
    thick = 0.8 / among
    for level, found in enumerate(bars):
        y = level - 0.4 + thick * (place + 0.5)
        if found.value is None:
            axes.annotate("–", (0, y), (4, 0), textcoords="offset points", va="center")
            continue
        axes.barh(y, found.value, thick * 0.86, color=_colour(place), alpha=OPACITY)
        end = found.value
        if found.low is not None and found.high is not None:
            axes.plot([found.low, found.high], [y, y], color=INK, linewidth=1.1)
            end = max(end, found.high)
        text = short(found.value, measure.unit)
        axes.annotate(text, (end, y), (4, 0), textcoords="offset points", va="center", fontsize=7.5)


SECTION = SweepSection("ablation", order=25, module=HERE, content=content)
