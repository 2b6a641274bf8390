"""The command that runs a scenario."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

import click

from airhilt.cli.output import echo_json, tell
from airhilt.cli.parameters import CommandWithFlags, allow_path_option, one_scenario
from airhilt.cli.station_flags import PageOptions, refuse_page_options, station_options

if TYPE_CHECKING:
    from airhilt.options import Options
    from airhilt.scenario import Scenario


def _flags() -> list[click.Parameter]:
    from airhilt.cli.run_flags import run_flags

    return run_flags()


@click.command(
    cls=CommandWithFlags,
    flags=_flags,
    flags_at=2,
    epilog="""\b
Examples:
  airhilt cosim s02a_headon
  airhilt cosim --scenario my.json --seed 7 --latency lognormal --out runs/mine
  airhilt cosim --scenario s02a_headon --assistant none --json
  airhilt cosim --scenario s02a_headon_tcas --crews observed --seed 3
  airhilt cosim --scenario s01b_nominal --seat tower
  airhilt cosim --scenario s02a_headon --view --pace realtime --share-truth
  airhilt cosim --scenario s02a_headon --endpoint tcp/127.0.0.1:7447 --attach decision
""",
)
@click.argument("named", metavar="[NAME_OR_FILE]", required=False)
@click.option(
    "--scenario",
    metavar="NAME_OR_FILE",
    help="A scenario of `airhilt list`, or a JSON file; NAME_OR_FILE alone is the same.",
)
@allow_path_option
@click.option(
    "--json",
    "as_json",
    is_flag=True,
    help="Print summary.json on standard output, everything else on standard error.",
)
@click.option("--view", is_flag=True, help="Show the run in the browser as it goes on.")
@station_options
@click.pass_context
def cosim(
    context: click.Context,
    /,
    named: str | None,
    scenario: str | None,
    allowed: tuple[Path, ...],
    as_json: bool,
    view: bool,
    page: PageOptions,
    **_: object,
) -> None:
    """Run a scenario and leave a run folder."""
    from airhilt.cli.live_page import live_page
    from airhilt.cli.progress import ProgressLine, print_summary
    from airhilt.cli.run_flags import options_given
    from airhilt.cosim.setup import check_given
    from airhilt.cosim.simulation import run
    from airhilt.scenario.seats import seats_of
    from airhilt.world.loading import load

    options = options_given(context)
    has_page = view or bool(options.seat)
    if not has_page:
        refuse_page_options("--view or --seat")
    name = one_scenario(named, scenario)
    loaded = load(name, allowed)
    if has_page:
        options = _for_page(loaded, options)
        page.address()  # The process of the page would complain too late.
    check_given(loaded, options)
    with ExitStack() as stack:
        if has_page:
            seats = seats_of(options.seat, loaded)
            stack.enter_context(live_page(options.endpoint, options.tls, seats, page.arguments()))
        tell("starting; the run folder appears in a moment")
        with ProgressLine(name) as progress:
            result = run(loaded, options, progress)
        if as_json:
            echo_json(result.summary.model_dump_json(indent=2))
            click.echo(f"run folder: {result.folder}", err=True)
        else:
            print_summary(result.summary, result.folder)


def _for_page(scenario: Scenario, options: Options) -> Options:
    """Return options of a run with a page: with an endpoint, and instruments of its pilots."""
    from airhilt.bus.session import free_endpoint
    from airhilt.scenario.seats import seats_of

    if options.endpoint is None and options.tls is None:
        options = options.model_copy(update={"endpoint": free_endpoint()})
    seats = seats_of(options.seat, scenario)
    if any(actor.callsign in seats for actor in scenario.actors):
        options = options.model_copy(update={"cockpit": True})
    return options


COMMAND = cosim
