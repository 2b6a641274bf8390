"""The commands of ``airhilt keys``: they make keys."""

from __future__ import annotations

from pathlib import Path

import click

from airhilt.cli.parameters import FILE, FOLDER


@click.group(
    epilog="""\b
Examples:
  airhilt keys sign                 airhilt.key and airhilt.key.pub
  airhilt keys sign lab.key         lab.key and lab.key.pub
  airhilt keys init lab-keys        keys for a run and the programs that join it
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
@click.argument("file", metavar="[FILE]", default="airhilt.key", type=FILE)
def sign(file: Path) -> None:
    """Make a key to sign runs with: FILE, which stays with you, and FILE.pub for others.

    FILE has no password, and only you may read it. A file that is there is never overwritten.
    """
    from airhilt.record.signature import make_keys, public_file

    mark = make_keys(file)
    click.echo(f"private key: {file}\npublic key: {public_file(file)}\nfingerprint: {mark}")


@keys.command(
    epilog="""\b
Examples:
  airhilt keys init lab-keys
  airhilt keys init lab-keys --endpoint tls/sim.example.org:7447
  airhilt cosim --scenario s02a_headon --tls lab-keys --attach decision
  airhilt worker decision --tls lab-keys
"""
)
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.option(
    "--endpoint",
    default="tls/127.0.0.1:7447",
    show_default=True,
    metavar="ENDPOINT",
    help="Where programs reach the run; other names of its machine are not accepted.",
)
def init(folder: Path, endpoint: str) -> None:
    """Make keys by which a run and the programs that join it know each other.

    DIR gets router.json for the run, and one file for each role: observer.json, worker.json,
    operator.json, recorder.json. Each is a whole configuration of Zenoh. Give a program the file of
    its role and no other. They are valid for two years.
    """
    from airhilt.bus.access import ROLES
    from airhilt.bus.certificates import key_file, make_keys

    make_keys(folder, endpoint)
    click.echo(f"run: {key_file(folder, 'router')}")
    for role in ROLES:
        click.echo(f"{role}: {key_file(folder, role)}")


COMMAND = keys
