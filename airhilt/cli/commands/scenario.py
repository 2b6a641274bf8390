"""The commands of ``airhilt scenario``: import."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import click

from airhilt.cli.output import echo
from airhilt.cli.parameters import FILE
from airhilt.errors import RunFolderError, ScenarioError
from airhilt.host.text import counted

SHOWN_NOTES = 20
"""Number of notes on what is left out that are shown."""


@click.group(
    epilog="""\b
Examples:
  airhilt scenario import trace_full_abc123.json --out recorded.json
"""
)
def scenario() -> None:
    """Make scenarios."""


@scenario.command(
    "import",
    epilog="""\b
Examples:
  airhilt scenario import trace_full_abc123.json --out recorded.json
  airhilt scenario import states.parquet --from 600 --until 1200 --only DLH4X --out recorded.json
  airhilt scenario import frames.txt --format avr --airport LSZH --qnh 1021 --out recorded.json
""",
)
@click.argument("file", type=FILE)
@click.option("--out", required=True, type=FILE, help="The scenario, a .json.")
@click.option(
    "--format",
    "form",
    type=click.Choice(["readsb", "opensky", "sbs", "avr", "traffic"]),
    help="Format of the file.  [default: what it looks like]",
)
@click.option(
    "--from",
    "from_s",
    type=click.FloatRange(min=0.0),
    default=0.0,
    metavar="S",
    help="Begin so long after the first record.",
)
@click.option(
    "--until",
    "until_s",
    type=click.FloatRange(min=0.0),
    default=math.inf,
    metavar="S",
    help="End so long after the first record.",
)
@click.option(
    "--only",
    multiple=True,
    metavar="NAME",
    help="Take this aircraft, by its address or callsign. Can be repeated.",
)
@click.option("--airport", metavar="NAME", help="Airport of the scene.  [default: en route]")
@click.option("--aircraft", metavar="TYPE", help="Type of all aircraft.  [default: the most alike]")
@click.option(
    "--longest-gap",
    "longest_gap_s",
    type=click.FloatRange(min=1.0),
    default=120.0,
    show_default=True,
    metavar="S",
    help="Longest time between two positions of a track.",
)
@click.option(
    "--qnh",
    "qnh_hpa",
    type=click.FloatRange(870.0, 1085.0),
    default=1013.25,
    show_default=True,
    metavar="HPA",
    help="Pressure at sea level, for altitudes that fit an airport.",
)
@click.option("--drop-bad", is_flag=True, help="Leave out records that cannot be right.")
@click.option("--overwrite", is_flag=True, help="Replace the file.")
def import_(
    file: Path, out: Path, form: str | None, drop_bad: bool, overwrite: bool, **given: Any
) -> None:
    """Make a scenario of recorded traffic.

    Each aircraft follows its record until a command or an advisory takes it off.
    """
    from airhilt.host.files import replace_file
    from airhilt.world.tracks.importing import Wanted, scenario_of
    from airhilt.world.tracks.reading import read_traffic
    from airhilt.world.tracks.record import TracksError

    if out.exists() and not overwrite:
        raise ScenarioError(f"{out} exists already; --overwrite replaces it")
    traffic = read_traffic(file, form)
    if traffic.bad and not drop_bad:
        more = len(traffic.bad) - 1
        tail = f" (and {more} more)" if more else ""
        raise TracksError(f"{file}: {traffic.bad[0]}{tail}; --drop-bad leaves out such records")
    name = re.sub(r"[^A-Za-z0-9_.-]", "_", out.stem)[:40]
    imported = scenario_of(traffic, Wanted(name, **given))
    notes = [*(f"left out: {bad}" for bad in traffic.bad), *imported.notes]
    if traffic.without_altitude:
        left_out = counted(traffic.without_altitude, "position")
        notes.append(f"{left_out} without an altitude left out")
    for note in notes[:SHOWN_NOTES]:
        echo(f"note: {note}", err=True)
    if len(notes) > SHOWN_NOTES:
        echo(f"note: and {len(notes) - SHOWN_NOTES} more", err=True)
    try:
        replace_file(out, (json.dumps(imported.document) + "\n").encode())
    except OSError as error:
        raise RunFolderError(f"{out}: cannot be written: {error.strerror}") from None
    count = len(imported.scenario.actors)
    echo(f"{out}: {count} aircraft, {imported.scenario.duration_s:g} s")


COMMAND = scenario
