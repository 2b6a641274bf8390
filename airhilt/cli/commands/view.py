"""The command that shows a run in the browser."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

import click

from airhilt.cli.output import tell, tell_page
from airhilt.cli.parameters import PATH
from airhilt.cli.station_flags import PageOptions, station_options

if TYPE_CHECKING:
    from airhilt.station.address import Address

WAITING = "waiting for the run at"
"""Beginning of the line that says that the run may begin: nothing of it will be missed."""
MOST_SOUNDS = 100
"""Number of pieces of sound that wait for browsers: 50 s of one frequency."""
LINGER_S = 10.0
"""Time for which the page of a run that is over waits for a browser."""


@click.command(
    epilog="""\b
Examples:
  airhilt view runs/s02a_headon-0-20260101T120000
  airhilt view RUN --port 9000 --no-browser
  airhilt view RUN OTHER
  airhilt view --connect tcp/127.0.0.1:7447
"""
)
@click.argument("run_folder", metavar="[RUN]", required=False, type=PATH)
@click.argument("other", metavar="[OTHER]", required=False, type=PATH)
@click.option("--connect", metavar="ENDPOINT", help="Show a run that goes on at this endpoint.")
@click.option(
    "--tls",
    type=PATH,
    metavar="DIR",
    help="Folder with observer.json of `airhilt keys init`, for a run that goes on.",
)
@click.option(
    "--run", "run_name", metavar="NAME", help="Name of the run, where several share an endpoint."
)
@click.option(
    "--seat",
    "seats",
    multiple=True,
    metavar="NAME",
    help="A seat of the run that a browser may take: tower, ground, the name of another unit, or a "
    "callsign; may be given again. The truth is not shown then.",
)
@station_options
def view(
    run_folder: Path | None,
    other: Path | None,
    connect: str | None,
    tls: Path | None,
    run_name: str | None,
    seats: tuple[str, ...],
    page: PageOptions,
) -> None:
    """Show a run in the browser: traffic, radio, advisories and cameras on one clock.

    A run folder is shown until the command is interrupted, and is not changed. Two are shown side
    by side, on one clock. A run that goes on
    is shown as it happens, until it is over and no browser shows it any more.
    """
    is_live = connect is not None or tls is not None
    if (run_folder is None) != is_live:
        raise click.UsageError("expected a run folder, or --connect ENDPOINT")
    for option, value in (("--seat", seats), ("--run", run_name)):
        if value and not is_live:
            raise click.UsageError(f"{option} would do nothing for a run folder")
    address, browser = page.address(), not page.no_browser
    if run_folder is not None:
        _show_recorded([run_folder, *([] if other is None else [other])], address, browser)
    else:
        _show_live(connect, tls, run_name, seats, address, browser)


def _show_recorded(run_folders: Sequence[Path], address: Address, browser: bool) -> None:
    from airhilt.record import open_run
    from airhilt.station.app import recorded_app
    from airhilt.station.debrief import Debrief
    from airhilt.station.server import serve

    with ExitStack() as stack:
        debriefs = []
        for folder in run_folders:
            debriefs.append(Debrief(open_run(folder, tell)))
            stack.callback(debriefs[-1].close)
        serve(recorded_app(debriefs), address, opened=tell_page, notice=tell, browser=browser)


def _show_live(
    connect: str | None,
    tls: Path | None,
    run_name: str | None,
    asked: tuple[str, ...],
    address: Address,
    browser: bool,
) -> None:
    from airhilt.station.app import live_app
    from airhilt.station.browsers import Browsers
    from airhilt.station.changes import Changes
    from airhilt.station.connection import RunConnection
    from airhilt.station.live import LiveRun
    from airhilt.station.seat_views import SeatViews
    from airhilt.station.server import serve
    from airhilt.station.subscription import Subscription

    click.echo(f"{WAITING} {connect or tls}")
    with ExitStack() as stack:
        connection = RunConnection(
            connect, "operator" if asked else "observer", tls=tls, run=run_name
        )
        stack.callback(connection.close)
        seats = connection.seats(asked, tell)
        changes, sounds = Changes(), Changes(MOST_SOUNDS)
        views = SeatViews(seats)
        run = LiveRun(changes, views, tell)
        subscription = Subscription(
            connection, run.take, run.lost, seats=seats, sounds=sounds if seats else None
        )
        stack.callback(subscription.close)

        def refused(text: str) -> None:
            tell(text)
            subscription.log_refusal(text)

        browsers = Browsers(changes, subscription, views, sounds, refused)
        serve(
            live_app(subscription, browsers),
            address,
            opened=tell_page,
            notice=refused,
            browser=browser,
            is_over=lambda: run.is_over and browsers.has_been_empty(LINGER_S),
        )


COMMAND = view
