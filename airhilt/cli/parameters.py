"""Parameters that several commands have, and commands whose parameters are made when needed."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import click

from airhilt.engines import RENDERER_HELP
from airhilt.errors import AirhiltError
from airhilt.host.files import is_url
from airhilt.sensors.cameras import AUTO

INTERRUPTED = 130
"""Exit code after a signal."""


class LocalPath(click.Path):
    """A path on this machine; a URL is refused, or a folder such as ``s3:`` would be made."""

    def convert(
        self,
        value: str | os.PathLike[str],
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> Any:
        """Return the path.

        Raises
        ------
        AirhiltError
            It is a URL.
        """
        if is_url(value):
            where = f"{param.opts[0]}: " if isinstance(param, click.Option) else ""
            raise AirhiltError(
                f"{where}found {str(value)!r}, a URL; expected a path on this machine"
            )
        return super().convert(value, param, ctx)


PATH = LocalPath(path_type=Path)
FILE = LocalPath(path_type=Path, dir_okay=False)
FOLDER = LocalPath(path_type=Path, file_okay=False)
THERE = LocalPath(path_type=Path, exists=True, file_okay=False)
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


def one_scenario(named: str | None, option: str | None) -> str:
    """Return the scenario that a command is given, as an argument or with ``--scenario``.

    Raises
    ------
    AirhiltError
        There is none, or one of each.
    """
    if named is not None and option is not None:
        raise AirhiltError(f"scenarios {named!r} and --scenario {option!r}: expected one of them")
    name = named if option is None else option
    if name is None:
        raise AirhiltError("no scenario given; expected a name of `airhilt list`, or a JSON file")
    return name


class GroupedOption(click.Option):
    """An option under a heading of its own in the help.

    Attributes
    ----------
    group
        The heading.
    """

    group = "Options"

    def __init__(self, *given: Any, group: str, **more: Any) -> None:
        super().__init__(*given, **more)
        self.group = group


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

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options by their groups, in the order in which these begin."""
        groups: dict[str, list[tuple[str, str]]] = {}
        for parameter in self.get_params(ctx):
            if isinstance(parameter, click.Option) and (record := parameter.get_help_record(ctx)):
                group = getattr(parameter, "group", GroupedOption.group)
                groups.setdefault(group, []).append(record)
        for group, records in groups.items():
            with formatter.section(group):
                formatter.write_dl(records)

    def get_params(self, ctx: click.Context) -> list[click.Parameter]:
        """Return the parameters: those of the command itself, and the flags."""
        if self._flags is not None:
            self.params[self._flags_at : self._flags_at] = self._flags()
            self._flags = None
        return super().get_params(ctx)
