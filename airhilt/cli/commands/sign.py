"""The command that signs a run."""

from __future__ import annotations

from pathlib import Path

import click


@click.command(
    epilog="""\b
Examples:
  airhilt keys sign lab.key                     make a key first
  airhilt sign RUN --key lab.key
  airhilt verify RUN --key lab.key.pub          what others do
"""
)
@click.argument("run_folder", metavar="RUN", type=click.Path(path_type=Path))
@click.option(
    "--key",
    required=True,
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="PRIVATE",
    help="Private key that `airhilt keys sign` has made.",
)
def sign(run_folder: Path, key: Path) -> None:
    """Sign a run that is intact, so that others can tell that nobody changed it.

    The signature is run.json.sig in the run folder. It covers run.json, and by its manifest every
    file that the run wrote.
    """
    from airhilt.record.verification import sign_run

    mark = sign_run(run_folder, key)
    click.echo(f"{run_folder}: signed by the key {mark}")


COMMAND = sign
