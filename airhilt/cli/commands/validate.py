"""The command that checks a scenario file."""

from __future__ import annotations

from pathlib import Path

import click

from airhilt.cli.output import echo, tell
from airhilt.cli.parameters import allow_path_option
from airhilt.errors import AirhiltError, ScenarioError

SHOWN_PROBLEMS = 20
"""Number of problems of a file that are shown."""


@click.command(
    epilog="""\b
Examples:
  airhilt validate my_scenario.json
"""
)
@click.argument("file")
@allow_path_option
def validate(file: str, allowed: tuple[Path, ...]) -> None:
    """Check a scenario file, and put all its actors where they begin."""
    from airhilt.cosim.setup import require_runnable
    from airhilt.world.checks.texts import doubtful_texts
    from airhilt.world.loading import load

    try:
        scenario = load(file, allowed)
    except ScenarioError as error:
        shown, more = error.problems[:SHOWN_PROBLEMS], len(error.problems) - SHOWN_PROBLEMS
        tail = [f"... and {more} more"] if more > 0 else []
        raise AirhiltError("\n".join([*shown, *tail])) from None
    require_runnable(scenario)
    for doubt in doubtful_texts(scenario):
        tell(f"warning: {file}: {doubt}; a difference that is meant is declared in failures")
    echo(f"{file}: valid: {scenario.name}, {len(scenario.actors)} actors")


COMMAND = validate
