"""The command that evaluates assistants by a preset."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from airhilt.cli.output import echo, tell
from airhilt.cli.parameters import FOLDER, INTERRUPTED, CommandWithFlags
from airhilt.cli.work_flags import work_flags, work_given
from airhilt.host.text import counted

if TYPE_CHECKING:
    from airhilt.sweep.evaluation.engine import Evaluation
    from airhilt.sweep.evaluation.preset import Choice, Preset
    from airhilt.sweep.work import Work

CHOSEN = ("latency", "crews", "cameras", "renderer", "detector", "speech", "asr", "tts")
"""Options of runs that may be given; a preset settles or varies the others."""


def _flags() -> list[click.Parameter]:
    from airhilt.cli.run_flags import run_flags

    return run_flags(CHOSEN, {"latency": "the preset's", "crews": "the preset's, or icao"})


class _PresetOption(click.Option):
    """An option whose help is made of the presets that there are."""

    def get_help_record(self, ctx: click.Context) -> tuple[str, str] | None:
        from airhilt.sweep.evaluation.presets import FAMILY

        presets: list[Preset] = [FAMILY.load(name) for name in FAMILY.names()]
        self.help = "; ".join(f"{each.name}: {each.summary}" for each in presets) + "."
        return super().get_help_record(ctx)


@click.command(
    cls=CommandWithFlags,
    flags=_flags,
    flags_at=4,
    epilog="""\b
Examples:
  airhilt evaluate --preset paper --no-cameras --out evaluations/paper
  airhilt evaluate --preset full --seeds 3 --out evaluations/full
  airhilt evaluate --preset ranking --assistant http://127.0.0.1:9000/decide --no-cameras
""",
)
@click.option(
    "--preset",
    cls=_PresetOption,
    required=True,
    metavar="NAME",
)
@click.option(
    "--assistant",
    "assistants",
    multiple=True,
    metavar="NAME",
    help="An assistant to be ranked, or the address of yours; may be given again. For the preset "
    "ranking.",
)
@click.option(
    "--seeds",
    type=click.IntRange(min=1),
    metavar="N",
    help="Number of seeds, from 0 on.  [default: the preset's]",
)
@click.option(
    "--out",
    type=FOLDER,
    metavar="DIR",
    help="Folder of the evaluation; what it has already is not run again.  [default: "
    "evaluations/PRESET]",
)
@work_flags
@click.pass_context
def evaluate(context: click.Context, /, **given: Any) -> int:
    """Run the sweeps of a preset, and make tables with 95 % intervals of them.

    The tables are printed, and written to DIR/evaluation.md, .json and .html; each sweep has a
    folder in DIR (`airhilt report DIR/NAME` shows it). The same command again does what is
    missing. Exit code 0 if every run finished, else 1: the tables say how many did not.
    """
    from airhilt.cli.run_flags import options_given
    from airhilt.cli.sweep_output import sweep_progress
    from airhilt.sweep.evaluation.engine import evaluate as run_evaluation
    from airhilt.sweep.evaluation.preset import Choice
    from airhilt.sweep.evaluation.presets import FAMILY

    preset: Preset = FAMILY.load(given["preset"])
    options = options_given(context).model_dump(mode="json", exclude_unset=True)
    chosen = {name: value for name, value in options.items() if name in CHOSEN}
    if given["assistants"] and not preset.takes_assistants:
        raise click.UsageError(
            f"--assistant: the preset {preset.name} has its own assistants; use --preset ranking"
        )
    choice = Choice(given["seeds"] or preset.seeds, chosen, given["assistants"])
    work = work_given(given, given["out"] or Path("evaluations") / preset.name)
    quiet = given["quiet"]
    if given["dry_run"]:
        _print_estimates(preset, choice, work, given["as_json"], quiet)
        return 0
    evaluation = run_evaluation(preset, choice, work, lambda name: sweep_progress(name, quiet))
    if evaluation is None:
        return INTERRUPTED
    _print(evaluation, given["as_json"], quiet)
    return 0 if evaluation.is_complete else 1


def _print(evaluation: Evaluation, as_json: bool, quiet: bool) -> None:
    if as_json:
        click.echo(json.dumps(evaluation.document(), indent=2))
    elif not quiet:
        echo(evaluation.markdown())
        rows, runs = counted(evaluation.rows, "row"), counted(evaluation.runs, "run")
        click.echo(f"{rows} of {runs} in {evaluation.folder}")


def _print_estimates(
    preset: Preset, choice: Choice, work: Work, as_json: bool, quiet: bool
) -> None:
    """Print the size of each sweep; a run of each kind is tried."""
    from dataclasses import asdict

    from airhilt.cli.sweep_output import print_estimate
    from airhilt.sweep.evaluation.engine import estimates

    if not quiet:
        tell("checks all runs, and does one of those that are left, of each kind")
    found = estimates(preset, choice, work)
    if as_json:
        click.echo(json.dumps({name: asdict(each) for name, each in found.items()}, indent=2))
        return
    for name, each in found.items():
        click.echo(f"{name}: ", nl=False)
        print_estimate(each, as_json)


COMMAND = evaluate
