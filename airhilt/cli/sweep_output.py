"""Output of a sweep: a bar or lines while it goes on, and its result."""

from __future__ import annotations

import json
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict

import click
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.text import Text

from airhilt.host.files import sha256
from airhilt.host.text import LONGEST_LINE, counted, readable
from airhilt.sweep.engine import SweepObserver, SweepResult
from airhilt.sweep.estimate import Estimate
from airhilt.sweep.outcome import Outcome

LINE_PERIOD_S = 10.0
"""Time between two lines where standard error is no terminal, in s."""


class SweepProgress(SweepObserver):
    """Shows runs done, rate, failures and time left, on standard error.

    Parameters
    ----------
    quiet
        True: only what went wrong.
    """

    def __init__(self, quiet: bool) -> None:
        self._console = Console(stderr=True, highlight=False)
        self._quiet = quiet
        self._bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TextColumn("{task.fields[rate]}"),
            TimeRemainingColumn(),
            console=self._console,
            disable=quiet or not self._console.is_terminal,
        )
        self._signals = self._total = self._done = self._before = self._failed = 0
        self._begun = self._printed = time.monotonic()

    @property
    def stops(self) -> bool:
        """True once the user has asked to stop.

        Raises
        ------
        KeyboardInterrupt
            The user has asked twice. It is raised here and not where the signal came, because
            Python drops what is raised while an object is deleted.
        """
        if self._signals > 1:
            raise KeyboardInterrupt
        return self._signals > 0

    def begun(self, total: int, finished: int, workers: str) -> None:
        """Show how many runs there are, and who does them."""
        self._total, self._done, self._before = total, finished, finished
        self._begun = time.monotonic()
        if not self._quiet:
            had = f", {finished} of them finished before" if finished else ""
            self._console.print(f"{counted(total, 'run')}{had}; {workers}", soft_wrap=True)
        self._bar.add_task("sweep", total=total, completed=finished, rate="")
        self._bar.start()

    def ended(self, outcome: Outcome) -> None:
        """Count a run."""
        self._done += 1
        if outcome.status != "finished":
            self._failed += 1
            self.notice(f"run {outcome.key[:16]} {outcome.status}: {outcome.cause}")
        for task in self._bar.task_ids:
            self._bar.update(task, completed=self._done, rate=self._rate())
        is_due = time.monotonic() - self._printed > LINE_PERIOD_S
        if is_due and not self._quiet and not self._console.is_terminal:
            self._printed = time.monotonic()
            self._console.print(
                f"{self._done} of {self._total} runs, {self._rate()}, {self._left()} left",
                soft_wrap=True,
            )

    def notice(self, text: str) -> None:
        """Print a line that stays."""
        line = readable(f"airhilt: {text}", LONGEST_LINE)
        self._console.print(Text(line, style="yellow"), soft_wrap=True)

    @contextmanager
    def interruptible(self) -> Iterator[None]:
        """Let the first signal stop after the runs in hand, and the second one at once."""

        def handle(*_: object) -> None:
            self._signals += 1
            if self._signals > 2:  # Nobody asks `stops`, such as while a scheduler is looked for.
                raise KeyboardInterrupt
            if self._signals > 1:
                return
            self.notice("stopping: the runs in hand finish first; once more stops at once")

        earlier = {n: signal.signal(n, handle) for n in (signal.SIGINT, signal.SIGTERM)}
        try:
            yield
        finally:
            for number, handler in earlier.items():
                signal.signal(number, handler)

    def __enter__(self) -> SweepProgress:
        return self

    def __exit__(self, *_: object) -> None:
        if not self._bar.disable:
            self._bar.stop()

    def _per_second(self) -> float:
        return (self._done - self._before) / max(time.monotonic() - self._begun, 1e-6)

    def _rate(self) -> str:
        rate = self._per_second()
        words = f"{rate:.1f} runs/s" if rate >= 1.0 else f"{rate * 3600.0:.0f} runs/h"
        return f"{words}, {self._failed} failed" if self._failed else words

    def _left(self) -> str:
        return duration((self._total - self._done) / max(self._per_second(), 1e-9))


@contextmanager
def sweep_progress(name: str, quiet: bool) -> Iterator[SweepProgress]:
    """Show how one sweep of several is doing; it stops after the runs in hand if the user asks."""
    if not quiet:
        click.echo(f"{name}:", err=True)
    with SweepProgress(quiet) as progress, progress.interruptible():
        yield progress


def duration(seconds: float) -> str:
    """Return a time in words, such as ``2 h 05 min``."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60:02} min"


def print_estimate(found: Estimate, as_json: bool) -> None:
    """Print the size of a sweep on standard output."""
    if as_json:
        click.echo(json.dumps(asdict(found), indent=2))
        return
    if found.run_s is None:
        click.echo(f"{counted(found.runs, 'run')}, all of them there already")
        return
    finished = f", {found.finished} of them there already" if found.finished else ""
    rest = f" for the {found.runs - found.finished} that are left" if found.finished else ""
    one = f"{counted(found.runs, 'run')}{finished}; one took {found.run_s:.1f} s and "
    one += f"{found.run_mb:.0f} MB"
    if found.total_s is None or found.at_once is None:
        click.echo(f"{one} here; how long all take depends on the workers of the scheduler")
        return
    click.echo(f"{one}, so about {duration(found.total_s)}, {found.at_once} at a time{rest}")


def print_result(result: SweepResult, again: str, as_json: bool, quiet: bool) -> None:
    """Print what a sweep has come to on standard output.

    Parameters
    ----------
    again
        Command that does what is still to do.
    """
    table = result.folder.table_path
    if as_json:
        outcome = {
            "folder": str(result.folder.path),
            "table": str(table),
            "table_sha256": sha256(table),
            "runs": result.runs,
            "rows": result.rows,
            "failed": result.failed,
            "missing": result.missing,
        }
        click.echo(json.dumps(outcome, indent=2))
        return
    if quiet:
        return
    click.echo(f"{counted(result.rows, 'row')} of {counted(result.runs, 'run')} in {table}")
    if result.failed:
        failed = counted(result.failed, "run")
        click.echo(f"{failed} failed: the causes are in {result.folder.machine_path}")
    if result.missing:
        click.echo(f"still to do: {counted(result.missing, 'run')}, with {again}")
    click.echo(f"sweep folder: {result.folder.path}")
