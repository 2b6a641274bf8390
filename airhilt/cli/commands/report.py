"""The command that makes the report of a run or of a sweep."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from airhilt.cli.output import tell
from airhilt.cli.parameters import FILE, folder_argument
from airhilt.errors import AirhiltError
from airhilt.host.files import replace_file
from airhilt.host.text import counted

if TYPE_CHECKING:
    from airhilt.record.sweep_folder import SweepFolder

QUIET_S = 2.0
"""Time for which figures are drawn without a word."""
PERIOD_S = 5.0
"""Time between two lines on the figures."""


@click.command(
    epilog="""\b
Examples:
  airhilt report runs/s02a_headon-0-20260101T120000
  airhilt report RUN --out headon.html
  airhilt report SWEEP
  airhilt report SWEEP --csv runs.csv
  airhilt report RUN --csv people.csv
"""
)
@folder_argument
@click.option(
    "--out",
    type=FILE,
    metavar="FILE",
    help="Where to write it.  [default: report.html in the folder]",
)
@click.option(
    "--csv",
    type=FILE,
    metavar="FILE",
    help="Write the table of a sweep, or of the people of a run, as CSV instead.",
)
def report(folder: Path, out: Path | None, csv: Path | None) -> None:
    """Make the report of a run or of a sweep: one HTML file that opens offline.

    The figures of a sweep are in its folder too, under figures, as SVG and as PDF.
    """
    from airhilt.record import open_run
    from airhilt.record.sweep_folder import SweepFolder, is_sweep
    from airhilt.report.people_csv import write_people_csv

    if csv is not None and out is not None:
        raise click.UsageError("--out, --csv: expected one of them")
    has_runs = is_sweep(folder)
    if csv is not None:
        if has_runs:
            _write_csv(SweepFolder.open(folder, tell), csv)
        else:
            write_people_csv(open_run(folder, tell), csv)
        click.echo(csv)
    elif has_runs:
        from airhilt.report.sweeps import write_sweep_report

        click.echo(write_sweep_report(folder, out, _Progress(), tell))
    else:
        from airhilt.report import write_report

        click.echo(write_report(folder, out, tell))


class _Progress:
    """Tells how many figures have been drawn, where that takes longer than a moment."""

    def __init__(self) -> None:
        self._due_s = time.monotonic() + QUIET_S

    def __call__(self, drawn: int) -> None:
        """Tell the number of figures drawn."""
        if time.monotonic() >= self._due_s:
            click.echo(f"{counted(drawn, 'figure')} drawn", err=True)
            self._due_s = time.monotonic() + PERIOD_S


def _write_csv(sweep: SweepFolder, path: Path) -> None:
    """Write ``sweep.parquet`` as CSV; what is null is empty."""
    from pyarrow import BufferOutputStream
    from pyarrow.csv import write_csv

    sink = BufferOutputStream()
    write_csv(sweep.table(), sink)
    try:
        replace_file(path, sink.getvalue().to_pybytes())
    except OSError as error:
        raise AirhiltError(f"{path}: cannot be written: {error.strerror or error}") from None


COMMAND = report
