"""The page of an evaluation: its tables, and where their rows are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from airhilt.report.assembly import assemble
from airhilt.report.page_section import PageSection

SHARED = ("page",)
SECTION = PageSection("tables", order=10, module=__file__)


def render(evaluation: Mapping[str, Any]) -> str:
    """Return the page of an evaluation, from its ``evaluation.json``, as HTML."""
    title = f"Evaluation {evaluation['preset']}, {evaluation['seeds']} seeds"
    own = {
        "tables": [
            {**table, "rows": [[_text(cell) for cell in row] for row in table["rows"]]}
            for table in evaluation["tables"]
        ],
        "sweeps": evaluation["sweeps"],
        "options": evaluation["options"],
    }
    data = {"title": title, "notes": [], "sections": {SECTION.name: own}}
    return assemble("evaluation", title, SHARED, [SECTION], data)


def _text(cell: Any) -> str:
    return str(cell["text"] if isinstance(cell, dict) else cell)
