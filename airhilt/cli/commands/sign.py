"""The command that signs a run or a sweep."""

from __future__ import annotations

from pathlib import Path

import click

from airhilt.cli.parameters import FILE, folder_argument


@click.command(
    epilog="""\b
Examples:
  airhilt keys sign lab.key                     make a key first
  airhilt sign RUN --key lab.key
  airhilt sign SWEEP --key lab.key
  airhilt verify RUN --key lab.key.pub          what others do
"""
)
@folder_argument
@click.option(
    "--key",
    required=True,
    type=FILE,
    metavar="PRIVATE",
    help="Private key that `airhilt keys sign` has made.",
)
def sign(folder: Path, key: Path) -> None:
    """Sign a run or a sweep that is intact, so that others can tell that nobody changed it.

    The signature is run.json.sig in the run folder. It covers run.json, and by its manifest every
    file that the run wrote. That of a sweep is sweep.json.sig: it covers sweep.json, and by its
    manifest both tables and the run folders that were kept.
    """
    from airhilt.record.verification import sign_folder

    mark = sign_folder(folder, key)
    click.echo(f"{folder}: signed by the key {mark}")


COMMAND = sign
