"""The page of an evaluation: its tables, and where their rows are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from airhilt.report.assembly import Assembly
from airhilt.report.evaluation import tables
from airhilt.report.page_section import PageSection

SHARED = ("page",)
SECTION = PageSection("tables", order=10, module=tables.__file__)


def render(evaluation: Mapping[str, Any]) -> str:
    """Return the page of an evaluation as HTML.

    Parameters
    ----------
    evaluation
        Content of ``evaluation.json``.
    """
    title = f"Evaluation {evaluation['preset']}, {evaluation['seeds']} seeds"
    data = {"title": title, "notes": [], "sections": {SECTION.name: tables.content(evaluation)}}
    return Assembly("evaluation", title, SHARED, [SECTION], data).page()
