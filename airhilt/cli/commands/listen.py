"""The command that writes what was said on the frequencies of a run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from airhilt.cli.output import echo, tell
from airhilt.cli.parameters import FILE, json_array_option, run_argument


class _Khz(click.types.IntParamType):
    """A frequency in kHz."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the frequency; anything but a whole number is refused."""
        try:
            return super().convert(value, param, ctx)
        except click.BadParameter:
            self.fail(f"{value!r}: expected kHz, such as 118300 for 118.3 MHz", param, ctx)


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
    type=_Khz(),
    metavar="KHZ",
    help="Frequency in kHz, such as 118300.  [default: all of the run]",
)
@click.option(
    "--out",
    type=FILE,
    metavar="FILE",
    help="The WAV file of one frequency; the transcript has its name with .txt.  [default: "
    "frequency-KHZ.wav in the run folder]",
)
@json_array_option
def listen(run_folder: Path, frequency_khz: int | None, out: Path | None, as_json: bool) -> None:
    """Write each frequency of a run as a WAV file, and who said and heard what beside it."""
    from airhilt.report.frequency import write_frequencies

    written = write_frequencies(run_folder, frequency_khz, out, tell)
    if as_json:
        documents = [
            recording.as_dict() | {"wav": str(wav), "transcript": str(text)}
            for recording, wav, text in written
        ]
        click.echo(json.dumps(documents, indent=2))
        return
    for recording, wav, text in written:
        echo(recording.text())
        click.echo(f"{wav}\n{text}")


COMMAND = listen
