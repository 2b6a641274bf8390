"""The command that serves a reference worker from a process of its own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from airhilt.cli.parameters import PATH
from airhilt.engine_families import FAMILIES


@click.command(
    epilog="""\b
Examples:
  airhilt worker decision --connect tcp/127.0.0.1:7447
  airhilt worker asr --engine whisper:models/base.en --connect tcp/127.0.0.1:7447
  airhilt worker vision --engine yolo:models/yolov10n.pt --connect tcp/127.0.0.1:7447
  airhilt worker decision --tls lab-keys
"""
)
@click.argument(
    "kind", type=click.Choice(list(dict.fromkeys(family.modality for family in FAMILIES)))
)
@click.option("--engine", metavar="ENGINE", help="Engine, as for `airhilt cosim`.")
@click.option(
    "--assistant-config",
    type=PATH,
    metavar="FILE",
    help="Configuration of a decision engine, as for `airhilt cosim`.",
)
@click.option(
    "--detector-classes",
    metavar="NAME=CLASS,...",
    help="What a detector's classes are called here, as for `airhilt cosim`.",
)
@click.option(
    "--connect", metavar="ENDPOINT", help="The run's endpoint.  [default: that of the keys]"
)
@click.option(
    "--tls", type=PATH, metavar="DIR", help="Folder with worker.json of `airhilt keys init`."
)
@click.option(
    "--run", "run_name", metavar="RUN", help="Name of the run, where several share an endpoint."
)
@click.option("--name", default=None, help="Name of the worker.  [default: its kind]")
@click.option(
    "--patience",
    type=click.FloatRange(0.0, 86_400.0, min_open=True),
    default=30.0,
    show_default=True,
    metavar="SECONDS",
    help="How long to wait for the run to come up.",
)
def worker(
    kind: str,
    engine: str | None,
    assistant_config: Path | None,
    detector_classes: str | None,
    connect: str | None,
    tls: Path | None,
    run_name: str | None,
    name: str | None,
    patience: float,
) -> None:
    """Attach a reference worker to a run from this process."""
    from airhilt.assistant.reference import reference_worker
    from airhilt.assistant.vision.class_names import notice_of
    from airhilt.configuration import read_configuration
    from airhilt.options import class_pairs
    from airhilt.workers import serve

    if connect is None and tls is None:
        raise click.UsageError("expected --connect ENDPOINT, or --tls DIR")
    settings: dict[str, Any] = {}
    if assistant_config is not None:
        if kind != "decision":
            raise click.UsageError(f"--assistant-config would do nothing for a worker of {kind}")
        settings["configuration"] = read_configuration(assistant_config)
    if detector_classes is not None:
        if kind != "vision":
            raise click.UsageError(f"--detector-classes would do nothing for a worker of {kind}")
        try:
            settings["classes"] = class_pairs(detector_classes)
        except ValueError as error:
            raise click.UsageError(f"--detector-classes {detector_classes}: {error}") from None
    made = reference_worker(kind, engine, name or kind, **settings)
    if told := notice_of(made.description):
        click.echo(told, err=True)
    if engine is not None:
        family = next(each for each in FAMILIES if each.modality == kind)
        chosen, argument = family.choose(engine)
        chosen.probe(argument)
    serve(made, connect, run_name, patience, tls)


COMMAND = worker
