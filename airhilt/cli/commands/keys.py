"""The commands of ``airhilt keys``: they make keys."""

from __future__ import annotations

from pathlib import Path

import click


@click.group(
    epilog="""\b
Examples:
  airhilt keys sign                 airhilt.key and airhilt.key.pub
  airhilt keys sign lab.key         lab.key and lab.key.pub
"""
)
def keys() -> None:
    """Make keys."""


@keys.command(
    epilog="""\b
Examples:
  airhilt keys sign lab.key
  airhilt sign RUN --key lab.key
  airhilt verify RUN --key lab.key.pub
"""
)
@click.argument(
    "file",
    metavar="[FILE]",
    default="airhilt.key",
    type=click.Path(path_type=Path, dir_okay=False),
)
def sign(file: Path) -> None:
    """Make a key to sign runs with: FILE, which stays with you, and FILE.pub for others.

    FILE has no password, and only you may read it. A file that is there is never overwritten.
    """
    from airhilt.record.signature import make_keys, public_file

    mark = make_keys(file)
    click.echo(f"private key: {file}\npublic key: {public_file(file)}\nfingerprint: {mark}")


COMMAND = keys
