"""The command that opens the page on which runs are chosen, started and looked at."""

from __future__ import annotations

from pathlib import Path

import click

from airhilt.cli.output import tell, tell_page
from airhilt.cli.parameters import FOLDER
from airhilt.cli.station_flags import PageOptions, station_options


@click.command(
    epilog="""\b
Examples:
  airhilt station
  airhilt station --runs experiments --scenarios my_scenarios
  airhilt station --port 9000 --no-browser
"""
)
@station_options
@click.option(
    "--runs",
    type=FOLDER,
    default=Path("runs"),
    show_default=True,
    help="Folder of the run folders: new runs are written there, and those in it are listed.",
)
@click.option(
    "--scenarios",
    type=FOLDER,
    multiple=True,
    metavar="DIR",
    help="A folder whose scenario files are offered as well; may be given again. No other file is "
    "read.",
)
def station(page: PageOptions, runs: Path, scenarios: tuple[Path, ...]) -> None:
    """Open the page on which runs are chosen, started, stopped and looked at.

    A run that is started there is a process of its own, in real time. It goes on when the station
    ends, and a station that is started again with the same --runs finds it.
    """
    address = page.address()

    from airhilt.engine_families import ASSISTANTS
    from airhilt.station.debriefs import Debriefs
    from airhilt.station.home import home_app
    from airhilt.station.scenario_choices import ScenarioChoices
    from airhilt.station.server import serve
    from airhilt.station.started_runs import StartedRuns

    started = StartedRuns(runs.resolve(), page.of_another_page())
    debriefs = Debriefs(started)
    app = home_app(ScenarioChoices(scenarios), started, debriefs, [*ASSISTANTS.names(), "none"])
    try:
        serve(app, address, opened=tell_page, notice=tell, browser=not page.no_browser)
    finally:
        debriefs.close()
        for run in started.runs():
            if started.state(run) != "ended":
                tell(f"{run.name} goes on; kill -INT {run.process} ends it")


COMMAND = station
