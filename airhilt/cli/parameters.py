"""Parameters that several commands have."""

from __future__ import annotations

from pathlib import Path

import click

from airhilt.engines import RENDERER_HELP
from airhilt.sensors.cameras import AUTO

allow_path_option = click.option(
    "--allow-path",
    "allowed",
    type=click.Path(path_type=Path, exists=True, file_okay=False),
    multiple=True,
    metavar="DIR",
    help="A folder besides that of the scenario in which it may name files; again for more.",
)
renderer_option = click.option(
    "--renderer",
    default=AUTO,
    show_default=True,
    metavar="NAME",
    help=RENDERER_HELP,
)
