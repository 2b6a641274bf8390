"""The command that checks scenario files, and flies them without an assistant."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from airhilt.cli.output import echo, echo_json, tell
from airhilt.cli.parameters import allow_path_option, json_array_option
from airhilt.errors import AirhiltError, ScenarioError
from airhilt.host.text import counted

if TYPE_CHECKING:
    from airhilt.cosim.dry_flight import DryFlights
    from airhilt.scenario import Scenario

SHOWN_PROBLEMS = 20
"""Number of problems of a file that are shown."""
SHOWN_SEEDS = 20
"""Number of seeds without a conflict that are named."""


@click.command(
    epilog="""\b
Examples:
  airhilt validate my_scenario.json
  airhilt validate --dry-fly 10 s02a_converging s01a_tight_timing
"""
)
@click.argument("files", metavar="SCENARIO...", nargs=-1, required=True)
@click.option(
    "--dry-fly",
    "seeds",
    type=click.IntRange(1, 10_000),
    metavar="N",
    help="Fly seeds 0 to N-1 without assistant, equipment, cameras and speech, and say how often "
    "the conflict comes about.",
)
@json_array_option
@allow_path_option
def validate(
    files: tuple[str, ...], seeds: int | None, as_json: bool, allowed: tuple[Path, ...]
) -> None:
    """Check scenarios, and put all their actors where they begin.

    Exit code 1 if a dry flight brings no conflict about as the scenario declares it.
    """
    scenarios = [_checked(file, allowed) for file in files]
    rows: list[dict[str, Any]] = []
    is_uneventful = False
    for file, scenario in zip(files, scenarios, strict=True):
        row: dict[str, Any] = {"file": file, "scenario": scenario.name}
        if not as_json:
            echo(f"{file}: valid: {scenario.name}, {len(scenario.actors)} actors")
        if seeds is not None:
            flown = _flown(scenario, seeds)
            row["dry_flight"] = _document(flown)
            if not as_json:
                echo(_line(flown))
            _tell_uneventful(flown)
            is_uneventful |= bool(flown.uneventful)
        rows.append(row)
    if as_json:
        echo_json(json.dumps(rows, indent=2))
    if is_uneventful:
        sys.exit(1)


def _checked(file: str, allowed: tuple[Path, ...]) -> Scenario:
    from airhilt.cosim.setup import require_runnable
    from airhilt.world.checks.radio import units_on_guard
    from airhilt.world.checks.texts import doubtful_texts
    from airhilt.world.loading import load

    try:
        scenario = load(file, allowed)
    except ScenarioError as error:
        shown, more = error.problems[:SHOWN_PROBLEMS], len(error.problems) - SHOWN_PROBLEMS
        tail = [f"... and {more} more"] if more > 0 else []
        raise AirhiltError("\n".join([*shown, *tail])) from None
    require_runnable(scenario)
    for unit in units_on_guard(scenario):
        tell(f"warning: {file}: {unit}")
    for doubt in doubtful_texts(scenario):
        tell(f"warning: {file}: {doubt}; a difference that is meant is declared in failures")
    return scenario


def _flown(scenario: Scenario, seeds: int) -> DryFlights:
    """Fly the seeds of a scenario, with a bar where standard error is a terminal."""
    from rich.console import Console
    from rich.progress import track

    from airhilt.cosim.dry_flight import DryFlights, fly_dry

    console = Console(stderr=True)
    if not console.is_terminal:
        tell(f"{scenario.name}: flying {counted(seeds, 'seed')}")
    flights = track(
        fly_dry(scenario, range(seeds)),
        description=scenario.name,
        total=seeds,
        console=console,
        transient=True,
        disable=not console.is_terminal,
    )
    declared = scenario.conflict.unassisted if scenario.conflict else None
    return DryFlights(scenario=scenario.name, declared=declared, flights=tuple(flights))


def _document(flown: DryFlights) -> dict[str, Any]:
    return {
        "declared": flown.declared,
        "seeds": len(flown.flights),
        "came_about": flown.came_about,
        "outcomes": dict(flown.outcomes),
        "closest_approach": None if flown.closest is None else flown.closest.model_dump(),
        "flights": [flight.model_dump() for flight in flown.flights],
    }


def _line(flown: DryFlights) -> str:
    """Return how often the conflict came about, what came of it, and how near it was."""
    of = f"{flown.came_about} of {counted(len(flown.flights), 'seed')}"
    what = "no conflict declared, one" if flown.declared is None else f"conflict ({flown.declared})"
    outcomes = ", ".join(f"{name} {count}" for name, count in flown.outcomes.most_common())
    parts = [f"{what} in {of}", outcomes]
    if (closest := flown.closest) is not None:
        spread = f"{closest.min_m:.0f} / {closest.median_m:.0f} / {closest.max_m:.0f} m"
        parts.append(f"closest approach min / median / max {spread}")
        if closest.p5_m is not None and closest.p95_m is not None:
            parts.append(f"5th / 95th percentile {closest.p5_m:.0f} / {closest.p95_m:.0f} m")
    return f"{flown.scenario}: {'; '.join(parts)}"


def _tell_uneventful(flown: DryFlights) -> None:
    if seeds := flown.uneventful:
        named = ", ".join(map(str, seeds[:SHOWN_SEEDS]))
        more = f" and {len(seeds) - SHOWN_SEEDS} more" if len(seeds) > SHOWN_SEEDS else ""
        tell(
            f"warning: {flown.scenario}: no conflict as declared with {counted(len(seeds), 'seed')}"
            f" of {len(flown.flights)}: {named}{more}"
        )


COMMAND = validate
