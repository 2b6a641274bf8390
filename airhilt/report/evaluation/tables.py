"""The page of an evaluation: its tables with their figures, and where their rows are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from airhilt.report.assembly import assemble
from airhilt.report.evaluation import scatter
from airhilt.report.figures import Figures
from airhilt.report.page_section import PageSection

SHARED = ("page",)
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
    if not table["figure"]:
        return ""
    name = figures.name_for(table["name"])
    scatter.draw(figures, name, table)
    return figures.markup[name]


def _text(cell: Any) -> str:
    return str(cell["text"] if isinstance(cell, dict) else cell)
