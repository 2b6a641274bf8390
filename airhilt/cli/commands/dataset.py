"""The commands of ``airhilt dataset``: export."""

from __future__ import annotations

from pathlib import Path

import click

from airhilt.cli.parameters import PATH, renderer_option
from airhilt.errors import AirhiltError
from airhilt.imaging import GREATEST_SIDE_PX, SMALLEST_SIDE_PX

SIDE = click.IntRange(SMALLEST_SIDE_PX, GREATEST_SIDE_PX)


@click.group()
def dataset() -> None:
    r"""Make pictures to train detectors on, with the truth about them.

    \b
    airhilt dataset export --out pictures --images 1000
    """


@dataset.command(
    epilog="""\b
Examples:
  airhilt dataset export --out pictures --images 1000
  airhilt dataset export --out test --images 500 --seed 7 --airport LSZH --airport en_route
  airhilt dataset export --out headon --images 200 --scenario s02a_headon --renderer moderngl
"""
)
@click.option("--out", required=True, type=PATH, metavar="DIR")
@click.option("--images", required=True, type=click.IntRange(1, 1_000_000), metavar="N")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True)
@click.option(
    "--airport",
    "airports",
    multiple=True,
    metavar="ICAO",
    help="Place of random scenes, or en_route for open country; may be given again.  "
    "[default: all]",
)
@click.option(
    "--scenario",
    metavar="NAME_OR_FILE",
    help="What this scenario's own cameras see, in place of random scenes.",
)
@click.option(
    "--empty",
    type=click.FloatRange(0.0, 1.0),
    default=0.35,
    show_default=True,
    help="Part of random pictures with nobody in them.",
)
@renderer_option
@click.option("--width", type=SIDE, metavar="PIXELS", help="[default: 640, or the scenario's]")
@click.option("--height", type=SIDE, metavar="PIXELS", help="[default: 360, or the scenario's]")
def export(
    out: Path,
    images: int,
    seed: int,
    airports: tuple[str, ...],
    scenario: str | None,
    empty: float,
    renderer: str,
    width: int | None,
    height: int | None,
) -> None:
    """Write pictures and, as COCO, the boxes, masks and ranges of all that is in them.

    Own aircraft of mounted cameras are seen, but nothing is said about them. The same seed gives
    the same bytes.
    """
    from rich.console import Console
    from rich.progress import track

    from airhilt.sensors.cameras.dataset.coco import export as write
    from airhilt.sensors.cameras.dataset.coco import random_pictures, scenario_pictures
    from airhilt.world.loading import load

    if (width is None) != (height is None):
        raise AirhiltError("--width and --height go together; expected both or neither")
    size = None if width is None or height is None else (width, height)
    if scenario is not None:
        if airports:
            raise AirhiltError(
                "--airport would do nothing: a scenario has its own place; expected only one of "
                "--airport and --scenario"
            )
        pictures = scenario_pictures(load(scenario), images, seed, renderer, size)
    else:
        pictures = random_pictures(images, seed, airports, renderer, size or (640, 360), empty)
    console = Console(stderr=True)
    shown = track(pictures, "pictures", total=images, console=console, transient=True)
    about = {"seed": seed, "renderer": renderer, "scenario": scenario}
    counts = write(iter(shown), out, about)
    click.echo(out / "annotations.json")
    click.echo("  ".join(f"{count} {name}" for name, count in counts.items()))


COMMAND = dataset
