"""The command that conducts an experiment with people."""

from __future__ import annotations

from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

import click

from airhilt.cli.output import tell, tell_page
from airhilt.cli.parameters import FILE, FOLDER
from airhilt.cli.station_flags import PageOptions, refuse_page_options, station_options

if TYPE_CHECKING:
    from airhilt.station.participant_progress import Progress
    from airhilt.station.plan import Trial


@click.command(
    epilog="""\b
Examples:
  airhilt experiment plan.json
  airhilt experiment plan.json --participant P01
  airhilt schema --experiment > plan.schema.json
"""
)
@click.argument("plan_file", metavar="PLAN", type=FILE)
@click.option(
    "--participant",
    metavar="ID",
    help="Open the page that leads this one through, and the others of the same team.",
)
@click.option(
    "--out",
    type=FOLDER,
    metavar="DIR",
    help="Folder of the experiment; what it has already is not run again.  [default: the name of "
    "PLAN under experiments/]",
)
@station_options
def experiment(
    plan_file: Path, participant: str | None, out: Path | None, page: PageOptions
) -> None:
    """Lead participants through trials at seats, in an order that is counterbalanced.

    Without --participant, the order of each is printed with what is done. The tables are written
    in any case: experiment.csv has a row a finished trial, reactions.csv a row a reaction to an
    advisory; both are there as .parquet too.
    """
    from airhilt.configuration import read_configuration
    from airhilt.station.plan import plan_of

    if participant is None:
        refuse_page_options("--participant")
    plan = plan_of(read_configuration(plan_file), str(plan_file))
    plan.check()
    folder = (out or Path("experiments") / plan_file.stem).resolve()

    from airhilt.station.conductor import Conductor
    from airhilt.station.experiment_tables import write_tables
    from airhilt.station.participant_progress import Progress

    if participant is not None:
        address = page.address()

        from airhilt.station.experiment_app import experiment_app
        from airhilt.station.server import serve

        team = [Progress(plan, folder, name) for name in plan.team_of(participant)]
        app = experiment_app(Conductor(team, page.of_another_page()))
        serve(app, address, opened=tell_page, notice=tell, browser=not page.no_browser)
    teams = plan.teams if participant is None else (plan.team_of(participant),)
    for name in chain(*teams):
        progress = Progress(plan, folder, name)
        click.echo(f"{name}: " + ", ".join(_shown(progress, trial) for trial in progress.trials))
    if participant is None and len(teams) % plan.balance:
        led = "participants" if plan.seats is None else "teams"
        tell(
            f"the order is not balanced with {len(teams)} {led}; expected {plan.balance}, or a "
            "multiple"
        )
    rows = write_tables(plan, folder)
    click.echo(f"{rows.trials} finished trials: {folder / 'experiment.csv'}, experiment.parquet")
    click.echo(f"{rows.reactions} reactions: {folder / 'reactions.csv'}, reactions.parquet")
    click.echo(f"{rows.calls} calls: {folder / 'calls.csv'}, calls.parquet")


def _shown(progress: Progress, trial: Trial) -> str:
    return f"{trial.name} (done)" if progress.is_done(trial) else trial.name


COMMAND = experiment
