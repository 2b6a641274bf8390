"""The command that checks a scenario file."""

from __future__ import annotations

import click

from airhilt.cli.output import echo
from airhilt.errors import AirhiltError, ScenarioError


@click.command(
    epilog="""\b
Examples:
  airhilt validate my_scenario.json
"""
)
@click.argument("file")
def validate(file: str) -> None:
    """Check a scenario file, and put all its actors where they begin."""
    from airhilt.cosim.option_checks import require_known_equipment
    from airhilt.cosim.setup import TICK_S
    from airhilt.world.actors import build_actors
    from airhilt.world.loading import draw, load
    from airhilt.world.site import ScenarioSite

    try:
        scenario = load(file)
    except ScenarioError as error:
        raise AirhiltError("\n".join(error.problems)) from None
    require_known_equipment(scenario.equipment)
    realised, _ = draw(scenario, 0)
    build_actors(realised, ScenarioSite.of(realised), 0, TICK_S)
    echo(f"{file}: valid: {scenario.name}, {len(scenario.actors)} actors")


COMMAND = validate
