"""The page of an evaluation: its tables with their figures, and where their rows are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from airhilt.report.assembly import assemble
from airhilt.report.figures import COLOURS, MARKERS, Figures
from airhilt.report.page_section import PageSection

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHARED = ("page",)
WIDTH_IN, HEIGHT_IN = 7.2, 4.2
SECTION = PageSection("tables", order=10, module=__file__)


def render(evaluation: Mapping[str, Any], figures: Figures) -> str:
    """Return the page of an evaluation, from its ``evaluation.json``, as HTML.

    Its figures are drawn among some that can be written as files as well.
    """
    title = f"Evaluation {evaluation['preset']}, {evaluation['seeds']} seeds"
    own = {
        "tables": [
            {
                **table,
                "rows": [[_text(cell) for cell in row] for row in table["rows"]],
                "figure": _figure(table, figures),
            }
            for table in evaluation["tables"]
        ],
        "sweeps": evaluation["sweeps"],
        "options": evaluation["options"],
    }
    data = {"title": title, "notes": [], "sections": {SECTION.name: own}}
    return assemble("evaluation", title, SHARED, [SECTION], data)


def _figure(table: Mapping[str, Any], figures: Figures) -> str:
    """Return the figure of a table as it stands in the page, empty if it has none."""
    curves = table["curves"]
    if not curves:
        return ""
    name = figures.name_for(table["name"])
    with figures.drawing(name, WIDTH_IN, HEIGHT_IN) as figure:
        axes = figure.subplots()
        for place, (series, points) in enumerate(curves["series"].items()):
            _curve(axes, place, series, points)
        axes.set_xscale("symlog", linthresh=1.0)
        axes.set_xlim(left=-0.2)
        axes.set_ylim(-0.03, 1.03)
        axes.grid()
        axes.set(xlabel=curves["x_label"], ylabel=curves["y_label"])
        figure.legend(loc="outside right upper")
    return figures.markup[name]


def _curve(axes: Axes, place: int, series: str, points: Sequence[Mapping[str, Any]]) -> None:
    known = [one for one in points if None not in (one["x"]["value"], one["y"]["value"])]
    if not known:
        return
    colour = COLOURS[place % len(COLOURS)]
    xs, ys = ([one[axis]["value"] for one in known] for axis in "xy")
    axes.plot(xs, ys, color=colour, label=series, marker=MARKERS[place % len(MARKERS)],
              markersize=5)  # fmt: skip
    for one, x, y in zip(known, xs, ys, strict=True):
        if one["x"]["low"] is not None:
            axes.hlines(y, one["x"]["low"], one["x"]["high"], color=colour, alpha=0.4)
        if one["y"]["low"] is not None:
            axes.vlines(x, one["y"]["low"], one["y"]["high"], color=colour, alpha=0.4)
    low, high = ([one["y"][end] for one in known] for end in ("low", "high"))
    if len(known) > 1 and None not in (*low, *high):
        axes.fill_between(xs, low, high, color=colour, alpha=0.12, linewidth=0)


def _text(cell: Any) -> str:
    return str(cell["text"] if isinstance(cell, dict) else cell)
