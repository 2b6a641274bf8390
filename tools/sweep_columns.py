"""Writes the table of metrics in docs/sweep-columns.md from the models of the summary.

python tools/sweep_columns.py
"""

from __future__ import annotations

import re
from pathlib import Path

from airhilt.metrics.columns import Column, metric_columns

PAGE = Path(__file__).resolve().parents[1] / "docs" / "sweep-columns.md"
TABLE = re.compile(r"(<!-- metrics -->\n).*?(?=<!-- end -->)", re.DOTALL)
"""The table, after a comment that says of what it is."""


def table() -> str:
    """Return the table of all metrics, in Markdown."""
    rows = [
        f"| `{each.name}` | {each.type} | {each.unit} | {_meaning(each)} |"
        for each in metric_columns()
    ]
    return "\n".join(["| column | type | unit | meaning |", "|---|---|---|---|", *rows, ""])


def _meaning(column: Column) -> str:
    """Return the description of a column without the part that its name begins with."""
    part, _, rest = column.description.partition(": ")
    return rest if rest and column.name.startswith(part.replace(" ", "_")) else column.description


def with_table(text: str) -> str:
    """Return a page with its table written anew."""
    return TABLE.sub(lambda found: found[1] + table(), text)


if __name__ == "__main__":
    PAGE.write_text(with_table(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
