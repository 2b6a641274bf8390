"""Comparisons as tables on the terminal."""

from __future__ import annotations

from collections.abc import Iterator

from rich.console import Console
from rich.table import Table
from rich.text import Text

from airhilt.host.text import LONGEST_LINE, readable
from airhilt.report.comparison.runs import RunComparison
from airhilt.report.comparison.sweeps import SweepComparison
from airhilt.report.comparison.words import measure_row, metric_row

FILE_WIDTH = 120
"""Characters of a line where standard output is no terminal."""


def print_comparison(found: RunComparison | SweepComparison) -> None:
    """Print the lines and tables of a comparison on standard output."""
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = FILE_WIDTH
    for each in _sweeps(found) if isinstance(found, SweepComparison) else _runs(found):
        console.print(Text(readable(each, LONGEST_LINE)) if isinstance(each, str) else each)


def _sweeps(found: SweepComparison) -> Iterator[Table | str]:
    alone_first, alone_second = found.without_partner
    alone = f"{alone_first} of {found.first}, {alone_second} of {found.second}"
    by = ", ".join(found.paired_by)
    clusters = "" if found.clusters == found.pairs else f" in {found.clusters} clusters"
    yield f"{found.pairs} pairs{clusters} by {by}; without a partner: {alone}"
    for name, (one, other) in found.differing.items():
        yield f"{name}: {one} and {other}"
    for family, differences in found.families.items():
        table = _table(
            f"family {family}", [found.first, found.second, "difference", "", "p", "pairs"]
        )
        for each in differences:
            row = measure_row(each)
            table.add_row(
                row["title"],
                row["first"][0],
                row["second"][0],
                *row["difference"],
                row["p_value"],
                str(row["pairs"]),
            )
        yield table


def _runs(found: RunComparison) -> Iterator[Table | str]:
    if found.parted_s is None:
        yield "all events are the same"
    else:
        yield f"the first event that differs is at {found.parted_s:.2f} s"
    for name, (one, other) in found.settings.items():
        yield f"{name}: {one} and {other}"
    if found.metrics:
        table = _table("", ["unit", found.first, found.second, "difference"])
        for each in found.metrics:
            row = metric_row(each)
            texts = (row[name] for name in ("name", "unit", "first", "second", "difference"))
            table.add_row(*(Text(readable(text)) for text in texts))
        yield table
    yield f"{found.equal_metrics} metrics have the same value in both"


def _table(title: str, heads: list[str]) -> Table:
    table = Table(box=None, pad_edge=False)
    table.add_column(Text(title))
    for head in heads:
        table.add_column(Text(head), justify="right")
    return table
