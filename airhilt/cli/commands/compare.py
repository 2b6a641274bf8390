"""The command that compares two runs, two sweeps, or two assistants of one sweep."""

from __future__ import annotations

import json
from pathlib import Path

import click

from airhilt.cli.output import tell
from airhilt.cli.parameters import FILE, PATH


def _pair(
    _: click.Context, _parameter: click.Parameter, text: str | None
) -> tuple[str, str] | None:
    """Return the two names of a text."""
    if text is None:
        return None
    names = [name.strip() for name in text.split(",")]
    if len(names) != 2 or not all(names):
        raise click.BadParameter(f"{text!r}: expected two names, such as reference,paper")
    return names[0], names[1]


@click.command(
    epilog="""\b
Examples:
  airhilt compare runs/before runs/after
  airhilt compare sweeps/before sweeps/after --out difference.html
  airhilt compare sweeps/s01a --assistants paper,reference
"""
)
@click.argument("first", type=PATH)
@click.argument("second", required=False, type=PATH)
@click.option(
    "--assistants", metavar="NAME,NAME", callback=_pair, help="Two assistants of one sweep."
)
@click.option("--json", "as_json", is_flag=True, help="Print it as JSON.")
@click.option(
    "--out", type=FILE, metavar="FILE", help="Write a page of it: one HTML file that opens offline."
)
def compare(
    first: Path,
    second: Path | None,
    assistants: tuple[str, str] | None,
    as_json: bool,
    out: Path | None,
) -> None:
    """Compare two runs, two sweeps, or two assistants of one sweep.

    Runs of sweeps are paired by everything but what differs: scenario, seed and parameters.
    """
    from airhilt.report.comparison import compare as found_by

    found = found_by(first, second, assistants, tell)
    if as_json:
        click.echo(json.dumps(found.as_json(), indent=2))
    else:
        from airhilt.cli.comparison_tables import print_comparison

        print_comparison(found)
    if out is not None:
        from airhilt.report.comparison.page import write_comparison

        click.echo(write_comparison(found, out), err=as_json)


COMMAND = compare
