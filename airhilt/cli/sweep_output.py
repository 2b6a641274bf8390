"""Output of a sweep at its end, and of a dry run."""

from __future__ import annotations

import json
from dataclasses import asdict

import click

from airhilt.cli.output import counted
from airhilt.cli.sweep_progress import duration
from airhilt.host.files import sha256
from airhilt.sweep.engine import SweepResult
from airhilt.sweep.estimate import Estimate


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
