"""The people at the seats of a run, as a browser shows them."""

from __future__ import annotations

from pathlib import Path

import pytest

from airhilt.report import write_report
from devtools import Page
from seats import logged, message, said, tower

pytestmark = pytest.mark.browser
ROW = "[...document.querySelectorAll('#people-calls-table tbody tr:first-child td')]"


def test_each_call_of_a_person_is_in_the_report(page: Page, tmp_path: Path) -> None:
    words = "American one two three, runway zero one, cleared to land"
    given = [
        message("seat/Washington_Tower", 1.0, is_taken=True),
        said("Washington_Tower", 5.0, words),
    ]
    logged(tower(20.0), tmp_path / "run", ["tower"], given)
    page.open(write_report(tmp_path / "run"))
    shown = page.evaluate(f"{ROW}.map((one) => one.textContent)")
    assert [shown[at] for at in (1, 2, 3, 4, 10)] == [
        "Washington Tower", "typed", "119.100 MHz", words, "no",
    ]  # fmt: skip
    assert shown[11].endswith(" s")
