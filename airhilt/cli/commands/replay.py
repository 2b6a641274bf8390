"""The command that runs a run again and compares."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click

from airhilt.cli.output import echo
from airhilt.cli.parameters import json_option, run_argument


@click.command(
    epilog="""\b
Examples:
  airhilt replay runs/s02a_headon-0-20260101T120000
  airhilt replay RUN --json
"""
)
@run_argument
@json_option
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
