"""The command that makes the scores of a run again from its folder."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click

from airhilt.cli.output import echo
from airhilt.cli.parameters import json_option, run_argument

SUMMARY = "summary.json"
OF_THE_MACHINE = frozenset({"real_time_factor", "cpu_s", "too_slow", "latency_sources"})
"""Fields of a summary that say how it was computed, and are not scored again."""


@click.command(
    epilog="""\b
Examples:
  airhilt rescore runs/s02a_headon-0-20260101T120000
  airhilt rescore RUN --json > summary.json
"""
)
@run_argument
@json_option
def rescore(run_folder: Path, as_json: bool) -> None:
    """Make the scores of a run again from its folder alone, and compare them with summary.json.

    The traffic is flown again, and cameras take their pictures again. What was said on the radio,
    and by assistants, recognisers, detectors and people, comes from the record, so that nobody who
    took part is needed. --json prints the new summary.

    Exit code 0: the scores are the same. 1: they differ, or there were none.
    """
    from airhilt.cli.progress import ProgressLine
    from airhilt.cosim.differences import first_difference
    from airhilt.cosim.replay import rescore as score_again
    from airhilt.record import RunFolder

    with ProgressLine(f"scores of {run_folder}") as progress:
        summary, verdict = score_again(run_folder, progress)
    new = summary.model_dump(mode="json")
    old = RunFolder(run_folder).summary()
    if as_json:
        click.echo(json.dumps(new, indent=2))
    was, now_is = (
        {name: value for name, value in one.items() if name not in OF_THE_MACHINE}
        for one in (old or {}, new)
    )
    if not as_json:
        if not verdict.identical:
            echo(f"the log differs from that of the run: {verdict}")
        if old is None:
            echo("there was no summary.json; --json prints what belongs there")
        else:
            echo("the same scores" if was == now_is else first_difference(was, now_is, SUMMARY))
    if was != now_is:
        sys.exit(1)


COMMAND = rescore
