"""The command that says whether a run or a sweep is as it was written, and by whom it is signed."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from pathlib import Path

import click

from airhilt.cli.output import echo
from airhilt.cli.parameters import FILE, folder_argument, json_option


@click.command(
    epilog="""\b
Examples:
  airhilt verify runs/s02a_headon-0-20260101T120000
  airhilt verify SWEEP
  airhilt verify RUN --key lab.key.pub
  airhilt verify RUN --json
"""
)
@folder_argument
@click.option(
    "--key",
    type=FILE,
    metavar="PUBLIC",
    help="Public key by which the run or the sweep must be signed.",
)
@json_option
def verify(folder: Path, key: Path | None, as_json: bool) -> None:
    """Say whether every file of a run is as the run wrote it, or the tables of a sweep.

    Without --key this finds damage. Only a signature tells that nobody changed it on purpose.

    Exit code 0: intact, and signed by the key if one is given. 1: damaged, or not signed by the
    key. 3: unfinished, because it was killed or is still going on.
    """
    from airhilt.record.verification import verify as verify_folder

    found = verify_folder(folder, key)
    if as_json:
        click.echo(json.dumps(asdict(found), indent=2))
    else:
        echo(found)
    sys.exit(found.exit_code)


COMMAND = verify
