"""The commands of ``airhilt airport``: list, show, import."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from airhilt.cli.output import echo, echo_json
from airhilt.cli.parameters import FILE, json_array_option, json_option
from airhilt.errors import ScenarioError


@click.group(
    epilog="""\b
Examples:
  airhilt airport list                      what airports there are
  airhilt airport show KDCA --out kdca.svg  draw one
  airhilt airport import KBOS --runways runways.csv --frequencies airport-frequencies.csv
"""
)
def airport() -> None:
    """List, draw and make airports."""


@airport.command(
    "list",
    epilog="""\b
Examples:
  airhilt airport list
  airhilt airport list --json
""",
)
@json_array_option
def list_airports(as_json: bool) -> None:
    """Name the airports that ship with AIRHILT."""
    from airhilt.host import library
    from airhilt.world.surface.airport import load_airport

    airports = [load_airport(name) for name in library.names("airports")]
    if as_json:
        rows = [
            {"icao": item.icao, "name": item.name, "runways": [r.name for r in item.runways]}
            for item in airports
        ]
        click.echo(json.dumps(rows, indent=2, ensure_ascii=False))
        return
    width = max((len(item.name) for item in airports), default=0)
    for item in airports:
        runways = "  ".join(runway.name for runway in item.runways)
        click.echo(f"{item.icao:4}  {item.name:{width}}  {runways}")


@airport.command(
    epilog="""\b
Examples:
  airhilt airport show KDCA
  airhilt airport show KDCA --out kdca.svg
  airhilt airport show ./my_airport.json --out my_airport.png
  airhilt airport show KDCA --json
"""
)
@click.argument("name", metavar="NAME_OR_FILE")
@click.option("--out", type=FILE, metavar="FILE", help="Draw it: an .svg or a .png.")
@json_option
def show(name: str, out: Path | None, as_json: bool) -> None:
    """Say what an airport has: runways, holds, exits, stands; or draw it.

    The names that it prints are those that scenarios use.
    """
    from airhilt.world.surface.airport import load_airport, read_airport
    from airhilt.world.surface.layout import Layout

    path = Path(name)
    layout = Layout(read_airport(path) if path.suffix == ".json" else load_airport(name))
    if out is not None:
        from airhilt.world.surface.chart import draw

        click.echo(draw(layout, out), err=as_json)
    if as_json:
        from airhilt.world.surface.description import describe

        echo_json(json.dumps(describe(layout), indent=2, ensure_ascii=False))
    elif out is None:
        from airhilt.world.surface.description import as_lines

        for line in as_lines(layout):
            echo(line)


@airport.command(
    "import",
    epilog="""\b
Examples:
  airhilt airport import KBOS --runways runways.csv --frequencies airport-frequencies.csv
  airhilt airport import lszh --runways runways.csv --frequencies airport-frequencies.csv \\
      --name Zürich --out lszh.json
""",
)
@click.argument("ident")
@click.option("--runways", required=True, type=FILE, help="runways.csv of OurAirports.")
@click.option(
    "--frequencies", required=True, type=FILE, help="airport-frequencies.csv of OurAirports."
)
@click.option("--name", help="Name of the airport, which those files leave out.  [default: IDENT]")
@click.option(
    "--variation",
    "variation_deg",
    type=click.FloatRange(-180.0, 180.0),
    metavar="DEGREES",
    help="Magnetic variation, east positive.  [default: World Magnetic Model 2025]",
)
@click.option(
    "--year", type=float, default=2025.0, show_default=True, help="Year of the magnetic variation."
)
@click.option("--out", type=FILE, metavar="FILE", help="[default: IDENT.json, in lower case]")
@click.option("--overwrite", is_flag=True, help="Replace the file.")
def import_(ident: str, out: Path | None, overwrite: bool, **given: Any) -> None:
    """Make an airport file from the files of OurAirports.

    Runways and frequencies are theirs; taxiways, holds, apron, tower and cameras are invented,
    and the file says so.
    """
    from airhilt.world.surface.draft import write_airport
    from airhilt.world.surface.importer import import_airport

    target = out or Path(f"{ident.lower()}.json")
    if target.exists() and not overwrite:
        raise ScenarioError(f"{target} exists already; --overwrite replaces it")
    made = import_airport(ident, **given)
    write_airport(made, target)
    click.echo(target)
    echo(
        f'note: a scenario in the same folder uses it by "airport": "{target.name}"; '
        f"`airhilt airport show {target}` draws it",
        err=True,
    )
    if note := made.sources["runways"].note:
        for line in note.split("; "):
            echo(f"note: {line}", err=True)


COMMAND = airport
