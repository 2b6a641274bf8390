"""Output of a run on the terminal: a line while it goes on, the numbers at its end."""

from __future__ import annotations

import time
from pathlib import Path

from rich.console import Console
from rich.live import Live
from rich.table import Table
from rich.text import Text

from airhilt.cosim.observer import Observer, Snapshot
from airhilt.host.text import LONGEST_LINE, readable
from airhilt.messages import Advisory, Severity
from airhilt.metrics.summary import Summary
from airhilt.metrics.summary_rows import latency, summary_rows

PLAIN_PERIOD_S = 5.0
"""Time between two lines where standard error is no terminal, in s."""
REFRESHES_A_SECOND = 8
STYLES = {
    Severity.INFO: "",
    Severity.ADVISORY: "cyan",
    Severity.CAUTION: "yellow",
    Severity.WARNING: "bold red",
}


class ProgressLine(Observer):
    """Shows time, speed against real time, separation and the last advisory, on standard error."""

    def __init__(self, title: str) -> None:
        self._console = Console(stderr=True, highlight=False)
        self._title = title
        self._live: Live | None = None
        self._snapshot: Snapshot | None = None
        self._begun = time.monotonic()
        self._printed = self._begun

    def __enter__(self) -> ProgressLine:
        if self._console.is_terminal:
            self._live = Live(
                get_renderable=self._line,
                console=self._console,
                refresh_per_second=REFRESHES_A_SECOND,
                transient=True,
            )
            self._live.start()
        return self

    def __exit__(self, *_: object) -> None:
        if self._live is not None:
            self._live.stop()

    def snapshot(self, snapshot: Snapshot) -> None:
        """Show how the run is doing."""
        if self._snapshot is None:
            self._begun = time.monotonic()
        self._snapshot = snapshot
        if self._live is None and time.monotonic() - self._printed > PLAIN_PERIOD_S:
            self._printed = time.monotonic()
            self._console.print(self._line(), soft_wrap=True)

    def notice(self, text: str) -> None:
        """Print a line that stays."""
        line = readable(f"airhilt: {text}", LONGEST_LINE)
        self._console.print(Text(line, style="yellow"), soft_wrap=True)

    def _line(self) -> Text:
        snapshot = self._snapshot
        if snapshot is None:
            return Text(f"{self._title}: getting ready")
        parts = [Text(part) for part in snapshot.texts(time.monotonic() - self._begun)]
        if snapshot.advisory is not None:
            parts.append(_advisory_text(snapshot.advisory))
        line = Text("  |  ").join(parts)
        line.no_wrap, line.overflow = True, "ellipsis"
        return line


def _advisory_text(advisory: Advisory) -> Text:
    text = readable(f"{advisory.severity.value} {advisory.message}")
    return Text(text, style=STYLES[advisory.severity])


def print_summary(summary: Summary, folder: Path) -> None:
    """Print the numbers that a researcher quotes, on standard output."""
    console = Console(highlight=False, soft_wrap=True)
    table = Table(show_header=False, box=None, pad_edge=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column()
    for label, value in summary_rows(summary):
        table.add_row(Text(readable(label)), Text(readable(value)))
    console.print(table)
    console.print(_latency_table(summary))
    console.print(f"run folder: {folder}", markup=False)


def _latency_table(summary: Summary) -> Table:
    table = Table("latency", "n", "p50", "p95", "max", box=None, pad_edge=False)
    for column in table.columns[1:]:
        column.justify = "right"
    for stage, statistics in summary.latencies.items():
        times = map(latency, (statistics.p50_s, statistics.p95_s, statistics.max_s))
        table.add_row(stage, str(statistics.n), *times)
    return table
