"""The command that writes a run in a format of other programs."""

from __future__ import annotations

from pathlib import Path

import click

from airhilt.cli.output import tell
from airhilt.cli.parameters import PATH, run_argument
from airhilt.export import FORMATS
from airhilt.export import export as export_run


@click.command(
    epilog="""\b
Examples:
  airhilt export runs/s02a_headon-0-20260101T120000 --to parquet
  airhilt export RUN --to csv --out tables
  airhilt export RUN --to rerun
"""
)
@run_argument
@click.option(
    "--to", "name", required=True, metavar="FORMAT", help=f"One of {', '.join(FORMATS.names())}."
)
@click.option(
    "--out",
    type=PATH,
    metavar="FOLDER",
    help="A folder that is new or empty.  [default: export/FORMAT in the run folder]",
)
def export(run_folder: Path, name: str, out: Path | None) -> None:
    """Write a run in a format of other programs: tables, sound or displays."""
    from airhilt.metrics.result import open_result

    run = open_result(run_folder, tell)
    for path in export_run(run, name, out or run.folder / "export" / name):
        click.echo(path)


COMMAND = export
