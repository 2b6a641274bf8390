"""The flags of how a sweep is run: where, by whom, within which limits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from airhilt.cli.parameters import GroupedOption

if TYPE_CHECKING:
    from airhilt.sweep.work import Work

Command = TypeVar("Command", bound=Callable[..., Any])
_option = partial(click.option, cls=GroupedOption, group="How the runs are done")
FLAGS: tuple[Callable[[Any], Any], ...] = (
    _option(
        "--scheduler",
        default="local",
        show_default=True,
        metavar="ADDRESS_OR_FILE",
        help="Who does the runs: local, or a Dask scheduler by its address or scheduler file.",
    ),
    _option(
        "--workers",
        type=click.IntRange(min=1),
        metavar="N",
        help="Number of local workers.  [default: by cores and memory]",
    ),
    _option(
        "--keep",
        default="none",
        show_default=True,
        metavar="WHICH",
        help="Run folders that stay: none, failed, all, or sample:N.",
    ),
    _option(
        "--run-timeout",
        "wall_s",
        type=click.FloatRange(min=0.0, min_open=True),
        metavar="SECONDS",
        help="Wall time after which a run is ended.  [default: 3600]",
    ),
    _option(
        "--run-memory",
        "memory_mb",
        type=click.FloatRange(min=0.0, min_open=True),
        metavar="MB",
        help="Memory at which a run is ended.  [default: 4000]",
    ),
    _option("--retry", is_flag=True, help="Run again what a limit or a crash has ended."),
    _option("--dry-run", is_flag=True, help="Only say how many runs, and about how long."),
    _option("--quiet", is_flag=True, help="Print nothing but errors and warnings."),
    _option("--json", "as_json", is_flag=True, help="Print the outcome as JSON."),
)


def work_flags(command: Command) -> Command:
    """Give a command these flags, after its own."""
    for flag in reversed(FLAGS):
        command = flag(command)
    return command


def work_given(given: Mapping[str, Any], out: Path) -> Work:
    """Return how a sweep is run, by the flags that were given.

    Raises
    ------
    AirhiltError
        One of them is wrong.
    """
    from airhilt.sweep.runner_process import Limits
    from airhilt.sweep.work import Work, keep_of

    keep, sample = keep_of(given["keep"])
    limits = {name: given[name] for name in ("wall_s", "memory_mb") if given[name] is not None}
    return Work(
        out=out,
        limits=Limits(**limits),
        workers=given["workers"],
        scheduler=given["scheduler"],
        keep=keep,
        sample=sample,
        retry=given["retry"],
    )
