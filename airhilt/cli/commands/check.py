"""The command that says what is wrong with a service."""

from __future__ import annotations

import click

from airhilt.cli.output import echo


@click.command(
    epilog="""\b
Examples:
  airhilt check http://127.0.0.1:8000/v1/audio/transcriptions --as asr
  airhilt check http://127.0.0.1:8001/v1/audio/speech#kokoro,af_bella --as tts
"""
)
@click.argument("url")
@click.option(
    "--as",
    "kind",
    type=click.Choice(["asr", "tts", "vision", "decision"]),
    required=True,
    help="What the service does in a run.",
)
def check(url: str, kind: str) -> None:
    """Ask a service what a run would, and say what is wrong with it.

    Exit code 2 if a run would not take its answers.
    """
    from airhilt.assistant.service_check import check_service
    from airhilt.assistant.service_kinds import KINDS

    for hint in check_service(next(each for each in KINDS if each == kind), url):
        echo(hint)
    echo(f"{url}: a run takes its answers")


COMMAND = check
