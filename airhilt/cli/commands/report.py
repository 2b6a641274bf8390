"""The command that makes the report of a run."""

from __future__ import annotations

from pathlib import Path

import click


@click.command(
    epilog="""\b
Examples:
  airhilt report runs/s02a_headon-0-20260101T120000
  airhilt report RUN --out headon.html
"""
)
@click.argument("run_folder", metavar="RUN", type=click.Path(path_type=Path))
@click.option(
    "--out",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Where to write it.  [default: report.html in the run folder]",
)
def report(run_folder: Path, out: Path | None) -> None:
    """Make the report of a run: one HTML file that opens offline."""
    from airhilt.report import write_report

    click.echo(write_report(run_folder, out))


COMMAND = report
