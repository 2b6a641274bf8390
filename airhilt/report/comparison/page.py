"""The page of a comparison."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from airhilt.host.text import readable
from airhilt.report.assembly import assemble, write_page
from airhilt.report.comparison import runs, sweeps
from airhilt.report.comparison.runs import RunComparison
from airhilt.report.comparison.sweeps import MeasureDifference, SweepComparison
from airhilt.report.comparison.words import measure_row, metric_row
from airhilt.report.figures import COLOURS, DIM, MARKERS, Figures
from airhilt.report.page_section import PageSection

Json = dict[str, Any]

SHARED = ("page",)
WIDTH_IN = 6.8
SECTIONS = {
    "sweeps": PageSection("sweeps", order=10, module=sweeps.__file__),
    "runs": PageSection("runs", order=10, module=runs.__file__),
}
"""The section of each kind of comparison; its template is beside its module."""


def write_comparison(comparison: RunComparison | SweepComparison, page: Path) -> Path:
    """Write the page of a comparison: one HTML file that opens offline; else as `write_page`."""
    figures = Figures()
    own = comparison.as_json()
    if isinstance(comparison, SweepComparison):
        own["drawn"] = _draw(comparison, figures)
        own["families"] = [
            {"name": name, "rows": [measure_row(each) for each in found]}
            for name, found in comparison.families.items()
        ]
    else:
        names = (comparison.first, comparison.second)
        own["metrics"] = [metric_row(each) for each in comparison.metrics]
        own["runs"] = [
            {"name": name, "events": events}
            for name, events in zip(names, comparison.events, strict=True)
        ]
    title = f"{readable(comparison.second)} compared with {readable(comparison.first)}"
    data = {"title": title, "notes": [], "sections": {comparison.kind: own}}
    sections = [SECTIONS[comparison.kind]]
    html = assemble("comparison", title, SHARED, sections, data, figures.markup)
    write_page(page, html)
    return page


def _draw(comparison: SweepComparison, figures: Figures) -> str:
    """Draw the differences of all percentages; return the figure's name."""
    series = {
        family: [each for each in found if each.measure.unit == "%" and each.difference.n]
        for family, found in comparison.families.items()
    }
    titles = list(dict.fromkeys(each.measure.title for own in series.values() for each in own))
    if not titles:
        return ""
    height_in = 0.16 * len(titles) * (len(series) + 1.5) + 1.1
    with figures.drawing("differences", WIDTH_IN, height_in) as figure:
        axes = figure.subplots()
        axes.axvline(0.0, color=DIM, linewidth=1.0)
        for place, (family, found) in enumerate(series.items()):
            shift = (place - (len(series) - 1) / 2.0) * 0.8 / len(series)
            _points(axes, place, family, [(titles.index(each.measure.title) + shift, each)
                                          for each in found])  # fmt: skip
        axes.set_yticks(range(len(titles)), titles)
        axes.set_ylim(len(titles) - 0.4, -0.6)
        axes.grid(axis="x")
        axes.set_xlabel(f"{comparison.second} less {comparison.first} (percentage points)")
        if len(series) > 1:
            figure.legend(loc="outside right upper")
    return "differences"


def _points(
    axes: Any, place: int, family: str, found: list[tuple[float, MeasureDifference]]
) -> None:
    colour = COLOURS[place % len(COLOURS)]
    for y, each in found:
        limits = each.difference.low, each.difference.high
        if None not in limits:
            axes.plot(limits, [y, y], color=colour, linewidth=1.4)
    axes.plot([each.difference.value for _, each in found], [y for y, _ in found], color=colour,
              marker=MARKERS[place % len(MARKERS)], markersize=5, linestyle="none",
              label=family)  # fmt: skip
