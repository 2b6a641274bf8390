"""The commands of ``airhilt dataset``: export."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import click

from airhilt.cli.parameters import PATH, renderer_option
from airhilt.errors import AirhiltError
from airhilt.imaging import GREATEST_SIDE_PX, SMALLEST_SIDE_PX

SIZE = (640, 360)
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
  airhilt dataset export --out tracks --images 800 --sequence 20 --format mot --format yolo
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
@click.option(
    "--pictures-per-world",
    type=click.IntRange(min=1),
    default=10,
    show_default=True,
    metavar="N",
    help="Random pictures with one weather, light and place; then comes the next place.",
)
@click.option(
    "--sequence",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    metavar="N",
    help="Pictures that a camera of a random world takes one after the other, while all moves.",
)
@click.option(
    "--rate",
    type=click.FloatRange(0.1, 100.0),
    default=10.0,
    show_default=True,
    metavar="HZ",
    help="Pictures a second in a --sequence.",
)
@click.option(
    "--format",
    "formats",
    type=click.Choice(["coco", "yolo", "mot"]),
    multiple=True,
    default=("coco",),
    show_default="coco",
    help="Format of the truth; may be given again, also when the pictures are there.",
)
@click.option("--depth", is_flag=True, help="Write the depth of each pixel, as NumPy arrays.")
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
    pictures_per_world: int,
    sequence: int,
    rate: float,
    formats: tuple[str, ...],
    depth: bool,
    renderer: str,
    width: int | None,
    height: int | None,
) -> None:
    """Write pictures with the boxes, masks and ranges of all that is in them, and a datasheet.

    Own aircraft of mounted cameras are seen, but nothing is said about them. The same options give
    the same bytes. An export that was stopped goes on when it is started again, also with more
    --images.
    """
    from rich.console import Console
    from rich.progress import track

    from airhilt.sensors.cameras.dataset.export import export as write
    from airhilt.sensors.cameras.dataset.pictures import (
        Picture,
        Takes,
        random_pictures,
        scenario_pictures,
    )
    from airhilt.sensors.cameras.renderers import require_renderer
    from airhilt.world.loading import load

    _require_use(scenario, airports, formats, sequence)
    size, renderer = _checked_size(width, height), require_renderer(renderer)
    settings: dict[str, Any] = {"seed": seed, "renderer": renderer, "size": size, "depth": depth}
    if scenario is not None:
        declared = load(scenario)
        settings |= {"scenario": scenario, "images": images}
    else:
        takes = Takes(pictures_per_world, sequence, rate, empty)
        settings |= {"airports": airports, **asdict(takes)}

    def take(first: int) -> Iterator[Picture]:
        pictures = (
            scenario_pictures(declared, images, seed, renderer, size, first)
            if scenario is not None
            else random_pictures(images, seed, airports, renderer, size or SIZE, takes, first)
        )
        left, console = max(images - first, 0), Console(stderr=True)
        yield from track(pictures, "pictures", total=left, console=console, transient=True)

    _show(out, write(take, out, settings, formats, depth).table())


def _show(out: Path, rows: Sequence[Sequence[str]]) -> None:
    click.echo(out / "datasheet.md")
    for name, *counts in rows:
        click.echo(f"{name:12}" + "".join(f"{count:>8}" for count in counts))


def _checked_size(width: int | None, height: int | None) -> tuple[int, int] | None:
    if (width is None) != (height is None):
        raise AirhiltError("--width and --height go together; expected both or neither")
    return None if width is None or height is None else (width, height)


def _require_use(
    scenario: str | None, airports: Sequence[str], formats: Sequence[str], sequence: int
) -> None:
    """Complain about options that do nothing together."""
    if scenario is not None and airports:
        raise AirhiltError(
            "--airport would do nothing: a scenario has its own place; expected only one of "
            "--airport and --scenario"
        )
    if "mot" in formats and scenario is None and sequence == 1:
        raise AirhiltError("--format mot is for sequences; expected --sequence N, or --scenario")


COMMAND = dataset
