"""The pages of sweeps and comparisons, as a browser shows them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from airhilt.report.comparison import compare
from airhilt.report.comparison.page import write_comparison
from airhilt.report.sweeps import write_sweep_report
from breadth import mostly_slow
from devtools import Page
from sweep_tables import grid, sweep_row, write_sweep

pytestmark = pytest.mark.browser

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)>"
LEFT_OUT = (
    "warned_in_time", "missed", "lost", "radio_wer", "first_detection_range_m", "nuisance_alerts",
)  # fmt: skip
"""Columns without which there are fewer figures to draw."""


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    rows = grid(["s01a_tight_timing"], ["reference", "paper"], seeds=2,
                snrs=(0.0, 10.0), visibilities=(400.0, 10000.0))  # fmt: skip
    rows = [{name: row[name] for name in row if name not in LEFT_OUT} for row in rows]
    rows.append({**rows[0], "key": "e" * 64, "seed": 9, "status": "failed", "cause": HOSTILE})
    rows[1]["folder"] = "runs/kept"
    return write_sweep_report(write_sweep(tmp_path_factory.mktemp("sweep") / "sweep", rows))


@pytest.fixture(scope="module")
def many(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sweep of 2,000 runs without anything to draw curves of."""
    rows = [
        sweep_row("s01a_x", "reference", seed, nuisance_alerts=seed % 7) for seed in range(2_000)
    ]
    return write_sweep_report(write_sweep(tmp_path_factory.mktemp("many") / "sweep", rows))


def texts(page: Page, selector: str) -> Any:
    return page.evaluate(
        f"[...document.querySelectorAll({selector!r})].map((each) => each.textContent)"
    )


def shown_figures(page: Page, section: str) -> Any:
    return page.evaluate(
        f"[...document.querySelectorAll('#{section} figure:not([hidden])')]"
        ".map((figure) => figure.dataset.figure)"
    )


def choose(page: Page, section: str, place: int, value: str) -> None:
    page.evaluate(
        f"(() => {{ const select = document.querySelectorAll('#{section} select')[{place}];"
        f"select.value = {value!r}; select.dispatchEvent(new Event('change')); }})()"
    )


def fill(page: Page, column: str, text: str) -> None:
    page.evaluate(
        f"(() => {{ const box = document.querySelector('[aria-label=\"Filter {column}\"]');"
        f"box.value = {text!r}; box.dispatchEvent(new Event('input')); }})()"
    )


def count(page: Page) -> Any:
    return page.evaluate("document.getElementById('runs-count').textContent")


def test_one_figure_of_each_section_is_shown_and_a_choice_shows_another(
    page: Page, report: Path
) -> None:
    page.open(report)
    assert shown_figures(page, "heat_maps") == ["heat_map_time_to_first_warning_s01a"]
    choose(page, "heat_maps", 0, "Avoided")
    assert shown_figures(page, "heat_maps") == ["heat_map_avoided_s01a"]
    choose(page, "curves", 0, "Visibility")
    assert shown_figures(page, "curves") == ["curve_time_to_first_warning_visibility_m_s01a"]


def test_a_figure_takes_the_colours_of_the_page(page: Page, report: Path) -> None:
    colour = "getComputedStyle(document.querySelector('#curves figure:not([hidden]) text')).fill"
    page.open(report)
    light = page.evaluate(colour)
    page.open(report, dark=True)
    assert page.evaluate(colour) != light


def test_hostile_text_is_shown_as_text(page: Page, report: Path) -> None:
    page.open(report)
    assert page.evaluate("document.querySelectorAll('img').length") == 0
    assert HOSTILE in texts(page, "#failures td.text")


def test_the_table_sorts_filters_and_links(page: Page, report: Path) -> None:
    page.open(report)
    assert count(page) == "17 runs"
    fill(page, "assistant", "paper")
    assert count(page) == "8 of 17 runs"
    fill(page, "visibility_m", ">= 1000")
    assert count(page) == "4 of 17 runs"
    page.evaluate("document.getElementById('runs-clear').click()")
    assert count(page) == "17 runs"
    links = page.evaluate(
        "[...document.querySelectorAll('#runs-table a')].map((a) => a.getAttribute('href'))"
    )
    assert links == ["runs/kept/"]


def test_a_click_on_a_head_sorts_and_another_turns_it_round(page: Page, many: Path) -> None:
    page.open(many)
    head = (
        "[...document.querySelectorAll('#runs-table thead button')]"
        ".find((button) => button.textContent.startsWith('seed'))"
    )
    seeds = (
        "[...document.querySelectorAll('#runs-table tbody tr:not(.gap)')]"
        ".slice(0, 2).map((row) => row.cells[3].textContent)"
    )
    page.evaluate(f"{head}.click()")
    assert page.evaluate(seeds) == ["0", "1"]
    page.evaluate(f"{head}.click()")
    assert page.evaluate(seeds) == ["1999", "1998"]


def test_only_the_rows_that_are_seen_are_drawn(page: Page, many: Path) -> None:
    page.open(many)
    assert count(page) == "2,000 runs"
    drawn = "document.querySelectorAll('#runs-table tbody tr').length"
    assert page.evaluate(drawn) < 100
    page.evaluate(
        "(() => { const table = document.getElementById('runs-window');"
        "table.scrollTop = table.scrollHeight; table.dispatchEvent(new Event('scroll')); })()"
    )
    assert page.evaluate(drawn) < 100
    last = "[...document.querySelectorAll('#runs-table tbody tr:not(.gap)')].at(-1).cells[0].title"
    assert page.evaluate(last) == page.evaluate("given.sections.runs.keys.at(-1)")


@pytest.mark.parametrize("dark", mostly_slow([False, True], False))
def test_the_pages_fit_a_telephone(page: Page, report: Path, tmp_path: Path, dark: bool) -> None:
    found = compare(report.parent, None, ("paper", "reference"))
    for each in (report, write_comparison(found, tmp_path / "comparison.html")):
        page.open(each, width=390, dark=dark)
        assert page.evaluate("document.documentElement.scrollWidth") <= 390
