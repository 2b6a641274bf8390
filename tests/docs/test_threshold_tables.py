"""The tables of thresholds are those of the models."""

from __future__ import annotations

import threshold_tables


def test_the_tables_of_the_page_are_those_of_the_models() -> None:
    text = threshold_tables.PAGE.read_text(encoding="utf-8")
    assert len(threshold_tables.TABLE.findall(text)) == 2
    assert threshold_tables.with_tables(text) == text, "run python tools/threshold_tables.py"
