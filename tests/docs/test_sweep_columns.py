"""The table of metrics in the documentation is that of the summary."""

from __future__ import annotations

import sweep_columns


def test_the_table_of_the_page_is_that_of_the_summary() -> None:
    text = sweep_columns.PAGE.read_text(encoding="utf-8")
    assert len(sweep_columns.TABLE.findall(text)) == 1
    assert sweep_columns.with_table(text) == text, "run python tools/sweep_columns.py"
