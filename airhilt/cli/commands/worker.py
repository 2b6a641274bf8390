"""The command that serves a reference worker from a process of its own."""

from __future__ import annotations

import click

from airhilt.cli.parameters import SECONDS


@click.command(
    epilog="""\b
Examples:
  airhilt worker decision --connect tcp/127.0.0.1:7447
  airhilt worker asr --engine whisper:models/base.en --connect tcp/127.0.0.1:7447
  airhilt worker vision --engine yolo:models/yolov10n.pt --connect tcp/127.0.0.1:7447
"""
)
@click.argument("kind", type=click.Choice(["decision", "asr", "tts", "vision"]))
@click.option("--engine", metavar="ENGINE", help="Engine, as for `airhilt cosim`.")
@click.option("--connect", required=True, metavar="ENDPOINT", help="The run's endpoint.")
@click.option(
    "--run", "run_name", metavar="RUN", help="Name of the run, where several share an endpoint."
)
@click.option("--name", default=None, help="Name of the worker.  [default: its kind]")
@click.option(
    "--patience",
    type=SECONDS,
    default=30.0,
    show_default=True,
    metavar="SECONDS",
    help="How long to wait for the run to come up.",
)
def worker(
    kind: str,
    engine: str | None,
    connect: str,
    run_name: str | None,
    name: str | None,
    patience: float,
) -> None:
    """Attach a reference worker to a run from this process."""
    from airhilt.assistant.reference import reference_worker
    from airhilt.workers import serve

    serve(reference_worker(kind, engine, name or kind), connect, run_name, patience)


COMMAND = worker
