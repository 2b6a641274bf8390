"""The commands of cameras."""

from __future__ import annotations

import math
from pathlib import Path

import click

from airhilt.cli.parameters import FILE, one_scenario, renderer_option
from airhilt.errors import CameraError


@click.command(
    epilog="""\b
Examples:
  airhilt render --scenario s01b_nominal --camera delta_tower --at 90 --boxes --out field.png
  airhilt render --scenario s02a_headon --camera nose-AAL123 --at 60 --renderer moderngl
"""
)
@click.argument("named", metavar="[NAME_OR_FILE]", required=False)
@click.option("--scenario", metavar="NAME_OR_FILE", help="Name of one that ships, or a file.")
@click.option("--camera", required=True, help="One of the scenario or of its airport.")
@click.option("--at", "at_s", type=float, default=0.0, show_default=True, metavar="SECONDS")
@click.option("--seed", type=int, default=0, show_default=True)
@renderer_option
@click.option("--boxes", is_flag=True, help="Draw what is really there.")
@click.option("--out", type=FILE, metavar="FILE")
def render(
    named: str | None,
    scenario: str | None,
    camera: str,
    at_s: float,
    seed: int,
    renderer: str,
    boxes: bool,
    out: Path | None,
) -> None:
    """Write what a camera of a scenario sees at a time, as a PNG.

    The actors carry out what they are told at the start; nobody talks, and nobody warns.
    """
    from airhilt import load
    from airhilt.sensors.cameras.snapshot import snapshot, write_png

    if not (math.isfinite(at_s) and 0.0 <= at_s <= 86_400.0):
        raise CameraError(f"--at is {at_s} s; expected 0 to 86400")
    name = one_scenario(named, scenario)
    frame = snapshot(load(name), camera, at_s, seed, renderer)
    path = out or Path(f"{Path(name).stem}-{camera}-{at_s:g}.png")
    write_png(frame, path, boxes)
    click.echo(path)
    for sighting in frame.sightings:
        box = ", ".join(f"{side:.1f}" for side in sighting.box)
        click.echo(
            f"  {sighting.actor:8}  {sighting.label:8}  {sighting.range_m:7.0f} m  [{box}]  "
            f"{sighting.visible_fraction:.0%} visible"
        )


COMMAND = render
