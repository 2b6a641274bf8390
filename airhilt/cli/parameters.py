"""Parameters that several commands have, and commands whose parameters are made when needed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import click

from airhilt.engines import RENDERER_HELP
from airhilt.sensors.cameras import AUTO

INTERRUPTED = 130
"""Exit code after a signal."""
PATH = click.Path(path_type=Path)
FILE = click.Path(path_type=Path, dir_okay=False)
FOLDER = click.Path(path_type=Path, file_okay=False)
THERE = click.Path(path_type=Path, exists=True, file_okay=False)
allow_path_option = click.option(
    "--allow-path", "allowed", type=THERE, multiple=True, metavar="DIR",
    help="A folder besides that of the scenario in which it may name files; again for more.",
)  # fmt: skip
renderer_option = click.option(
    "--renderer", default=AUTO, show_default=True, metavar="NAME", help=RENDERER_HELP
)
json_option = click.option("--json", "as_json", is_flag=True, help="Print a JSON object.")
json_array_option = click.option("--json", "as_json", is_flag=True, help="Print a JSON array.")
run_argument = click.argument("run_folder", metavar="RUN", type=PATH)
folder_argument = click.argument("folder", metavar="RUN|SWEEP", type=PATH)


class CommandWithFlags(click.Command):
    """A command with flags of a run, which are made when somebody asks for its parameters.

    Parameters
    ----------
    flags
        Returns the flags.
    flags_at
        Number of the command's own parameters that come before them.
    """

    def __init__(
        self, flags: Callable[[], Sequence[click.Parameter]], flags_at: int, **given: Any
    ) -> None:
        super().__init__(**given)
        self._flags: Callable[[], Sequence[click.Parameter]] | None = flags
        self._flags_at = flags_at

    def get_params(self, ctx: click.Context) -> list[click.Parameter]:
        """Return the parameters: those of the command itself, and the flags."""
        if self._flags is not None:
            self.params[self._flags_at : self._flags_at] = self._flags()
            self._flags = None
        return super().get_params(ctx)
