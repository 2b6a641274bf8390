"""Parameters that several commands have."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import click

from airhilt.engines import RENDERER_HELP
from airhilt.sensors.cameras import AUTO


class Finite(click.FloatRange):
    """A finite number; click's own range lets NaN pass."""

    def __init__(self, what: str, **limits: Any) -> None:
        super().__init__(**limits)
        self._what = what

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the number of a text."""
        number = super().convert(value, param, ctx)
        if not math.isfinite(number):
            self.fail(f"{value} is no {self._what}", param, ctx)
        return number


SECONDS = Finite("time in seconds", min=0.0, max=86_400.0, min_open=True)
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
