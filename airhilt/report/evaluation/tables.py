"""The section of the tables of an evaluation, and of the sweeps that they are made of."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def content(evaluation: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables with their cells as texts, the sweeps, and the options."""
    found = [
        {**table, "rows": [[_text(cell) for cell in row] for row in table["rows"]]}
        for table in evaluation["tables"]
    ]
    return {
        "tables": found,
        "sweeps": evaluation["sweeps"],
        "options": evaluation["options"],
    }


def _text(cell: Any) -> str:
    return str(cell["text"] if isinstance(cell, dict) else cell)
