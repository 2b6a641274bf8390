"""The command that writes what was said on a frequency."""

from __future__ import annotations

import json
from pathlib import Path

import click

from airhilt.cli.output import echo, tell
from airhilt.cli.parameters import FILE, json_option, run_argument


@click.command(
    epilog="""\b
Examples:
  airhilt listen runs/s02a_headon-0-20260101T120000
  airhilt listen RUN --frequency 118300 --out tower.wav
  airhilt listen RUN --json
"""
)
@run_argument
@click.option(
    "--frequency",
    "frequency_khz",
    type=int,
    metavar="KHZ",
    help="Frequency in kHz, such as 118300.  [default: the run's only one]",
)
@click.option(
    "--out",
    type=FILE,
    metavar="FILE",
    help="The WAV file; the transcript has its name with .txt.  [default: frequency-KHZ.wav in "
    "the run folder]",
)
@json_option
def listen(run_folder: Path, frequency_khz: int | None, out: Path | None, as_json: bool) -> None:
    """Write a frequency of a run as a WAV file, and who said and heard what beside it."""
    from airhilt.report.frequency import write_frequency

    recording, wav, text = write_frequency(run_folder, frequency_khz, out, tell)
    if as_json:
        files = {"wav": str(wav), "transcript": str(text)}
        click.echo(json.dumps(recording.as_dict() | files, indent=2))
    else:
        echo(recording.text())
        click.echo(f"{wav}\n{text}")


COMMAND = listen
