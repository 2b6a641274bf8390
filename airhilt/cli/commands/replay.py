"""The command that runs a run again and compares."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click

from airhilt.cli.output import echo


@click.command(
    epilog="""\b
Examples:
  airhilt replay runs/s02a_headon-0-20260101T120000
  airhilt replay RUN --json
"""
)
@click.argument("run_folder", metavar="RUN", type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object.")
def replay(run_folder: Path, as_json: bool) -> None:
    """Run a run again with the latencies it had, and say where the two differ.

    Exit code 0: identical. 1: they differ.
    """
    from airhilt.cli.progress import ProgressLine
    from airhilt.cosim.replay import replay as replay_run

    with ProgressLine(f"replay of {run_folder}") as progress:
        verdict = replay_run(run_folder, progress)
    if as_json:
        click.echo(json.dumps(verdict.as_dict(), indent=2))
    else:
        echo(verdict)
    if not verdict.identical:
        sys.exit(1)


COMMAND = replay
