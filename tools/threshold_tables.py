"""Writes the tables of rules and thresholds in docs/thresholds.md from the models of the engines.

python tools/threshold_tables.py
"""

from __future__ import annotations

import re
from pathlib import Path

from pydantic import BaseModel

from airhilt.configuration import settings
from airhilt.engine_families import ASSISTANTS

PAGE = Path(__file__).resolve().parents[1] / "docs" / "thresholds.md"
TABLE = re.compile(r"(<!-- thresholds of (\w+) -->\n).*?(?=<!-- end -->)", re.DOTALL)
"""A table, after a comment that says of which engine it is."""


def table(name: str) -> str:
    """Return the table of an engine's configuration, in Markdown."""
    rows = [
        f"| `{'.'.join(place)}` | {_default(field.default)} | {field.description} |"
        for place, field in settings(ASSISTANTS.configuration_model(name))
        if not isinstance(field.default, BaseModel)
    ]
    return "\n".join(["| setting | default | meaning |", "|---|---|---|", *rows, ""])


def with_tables(text: str) -> str:
    """Return a page with its tables written anew."""
    return TABLE.sub(lambda found: found[1] + table(found[2]), text)


def _default(value: object) -> str:
    if isinstance(value, tuple):
        return "all of them"
    return f"{value:g}" if isinstance(value, float) else str(value)


if __name__ == "__main__":
    PAGE.write_text(with_tables(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
