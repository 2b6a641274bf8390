"""The command that sweeps a grid of runs."""

from __future__ import annotations

import os
import shlex
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import click

from airhilt.cli.output import tell
from airhilt.cli.parameters import FILE, FOLDER, INTERRUPTED, CommandWithFlags, allow_path_option
from airhilt.cli.work_flags import work_flags, work_given

WRITTEN = "airhilt.sweep.written"
"""Key of the arguments in the context."""


def _flags() -> list[click.Parameter]:
    from airhilt.cli.sweep_flags import value_flags

    return value_flags()


class SweepCommand(CommandWithFlags):
    """A command that keeps its arguments as they were written."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the arguments, and keep them as they were written."""
        ctx.meta[WRITTEN] = tuple(args)
        return super().parse_args(ctx, args)


@click.command(
    cls=SweepCommand,
    flags=_flags,
    flags_at=3,
    epilog="""\b
Values are lists (0,5,10), ranges with their end (0:20:5), ranges in even ratios with a count
(log:1:100:5), or intervals to draw samples from (0:20, with --sample).
\b
Examples:
  airhilt sweep --scenario 's01a_*' --snr 0:20:5 --visibility 400,800,1600,5000,10000 \\
      --seeds 10 --assistant reference,paper,adsb_only --latency fixed --out sweeps/s01a
  airhilt sweep --scenario s02a_headon --set actors.AAL123.initial.cas_kt=240:270:10 --dry-run
  airhilt sweep --scenario s01a_bad_readback --snr 0:20 --visibility 400:10000 --sample sobol:64
  airhilt sweep --file sweep.json --scheduler tcp://head:8786
""",
)
@click.argument("named", metavar="[NAME_OR_FILE]...", nargs=-1)
@click.option(
    "--scenario",
    "scenarios",
    multiple=True,
    metavar="NAME_OR_FILE",
    help="A scenario, a pattern such as 's01a_*', or a JSON file; may be given again.",
)
@click.option(
    "--seeds",
    metavar="SEEDS",
    help="How many (10: seeds 0 to 9), or which: 3,5 or 10:19:1.  [default: 1]",
)
@click.option(
    "--set",
    "set_",
    multiple=True,
    metavar="PATH=VALUES",
    help="Any parameter by its path: of the scenario (weather.visibility_m, "
    "actors.AAL123.initial.cas_kt), of the assistant (assistant.tau_asr), or an option; may be "
    "given again.",
)
@click.option(
    "--sample",
    metavar="METHOD:COUNT",
    help="Draw points from the intervals instead of a grid: lhs:COUNT or sobol:COUNT, with :SEED.",
)
@click.option(
    "--file",
    type=FILE,
    metavar="FILE",
    help="A sweep file (`airhilt schema --sweep`); flags add to it, and replace what it says.",
)
@click.option(
    "--out",
    type=FOLDER,
    metavar="DIR",
    help="Folder of the sweep; what it has already is not run again.  [default: a new one under "
    "sweeps/]",
)
@allow_path_option
@work_flags
@click.pass_context
def sweep(context: click.Context, /, **given: Any) -> int:
    """Run a grid of scenarios, parameters, seeds and assistants, and make one table of it.

    The table is DIR/sweep.parquet (`airhilt report DIR` shows it, `airhilt.read_sweep` reads it).
    The same command with the same --out does what is missing. Exit code 0 if every run has a row,
    1 if some have not, or if none finished.
    """
    from airhilt.cli.sweep_flags import specification_given
    from airhilt.cli.sweep_output import SweepProgress, print_estimate, print_result
    from airhilt.sweep.engine import sweep as run_sweep
    from airhilt.sweep.estimate import estimate

    specification = specification_given(
        context,
        given["file"],
        (*given["named"], *given["scenarios"]),
        given["seeds"],
        given["set_"],
        given["sample"],
    )
    work = work_given(given, given["out"] or _default_folder())
    work = replace(work, allowed=given["allowed"])
    if given["dry_run"]:
        if not given["quiet"]:
            tell("checks all runs, and does one of those that are left, of each kind")
        print_estimate(estimate(specification, work), given["as_json"])
        return 0
    if given["out"] is None and not given["quiet"]:
        click.echo(f"sweep folder: {work.out}; to go on with it, add --out {work.out}", err=True)
    with SweepProgress(given["quiet"]) as progress, progress.interruptible():
        result = run_sweep(specification, work, progress)
    print_result(result, _again(context, work.out), given["as_json"], given["quiet"])
    if progress.stops:
        return INTERRUPTED
    return 0 if result.is_complete else 1


def _again(context: click.Context, out: Path) -> str:
    """Return the command that goes on with a sweep: as it was written, and with its folder."""
    folder = () if context.params["out"] is not None else ("--out", str(out))
    return f"{context.command_path} {shlex.join((*context.meta[WRITTEN], *folder))}"


def _default_folder() -> Path:
    return Path("sweeps") / f"{datetime.now(UTC):%Y%m%dT%H%M%S}-{os.getpid()}"


COMMAND = sweep
