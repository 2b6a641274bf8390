"""Snapshots: one picture of a scenario at a time."""

from __future__ import annotations

import io
from pathlib import Path

from PIL import Image, ImageDraw

from airhilt.errors import CameraError
from airhilt.host.files import replace_file
from airhilt.scenario import Scenario
from airhilt.sensors.cameras import AUTO
from airhilt.sensors.cameras.body_states import states_of
from airhilt.sensors.cameras.frame import CameraPicture
from airhilt.sensors.cameras.mounts import local_frame_of
from airhilt.sensors.cameras.renderer_process import RendererProcess
from airhilt.units import seconds_to_ns
from airhilt.world.actors import build_actors
from airhilt.world.loading import draw
from airhilt.world.mover import goes_on
from airhilt.world.site import ScenarioSite

TICK_S = 0.05
"""Control tick of the actors in s, as in a run."""
SUPERSAMPLING = 3
"""Samples along each side of a pixel."""


def snapshot(
    scenario: Scenario,
    camera: str,
    at_s: float,
    seed: int = 0,
    renderer: str = AUTO,
) -> CameraPicture:
    """Return what a camera sees at a time, in a run in which nothing is said.

    Between two control ticks everybody has moved straight on, as in the pictures of a run.

    Raises
    ------
    AirhiltError
        There is no such camera, it could see nothing, or pictures cannot be drawn.
    """
    now_ns, tick_ns = seconds_to_ns(at_s), seconds_to_ns(TICK_S)
    ticks = now_ns // tick_ns
    realised, _ = draw(scenario, seed)
    site = ScenarioSite.of(realised)
    with RendererProcess(realised, [camera], renderer, SUPERSAMPLING) as renderer_process:
        actors = build_actors(realised, site, seed, TICK_S)
        for _ in range(ticks):
            for actor in actors.values():
                if goes_on(actor.body):
                    actor.body.advance()
        local_frame = local_frame_of(site)
        bodies = states_of(actors.values(), local_frame, site.ground_m, now_ns, ticks * tick_ns)
        return renderer_process.take([camera], bodies, now_ns)[0]


def write_png(picture: CameraPicture, path: Path, boxes: bool = False) -> None:
    """Write a picture, with the boxes of what is in it if wanted: all of the file or nothing.

    Raises
    ------
    CameraError
        The file cannot be written.
    """
    image = Image.fromarray(picture.colour)
    if boxes:
        pen = ImageDraw.Draw(image)
        for sighting in picture.sightings:
            left, top, right, bottom = sighting.box
            pen.rectangle((left - 2, top - 2, right + 1, bottom + 1), outline=(255, 220, 40))
            text = f"{sighting.label} {sighting.range_m:.0f} m"
            above = (left, max(top - 14, 0))
            pen.text(above, text, (255, 220, 40), stroke_width=2, stroke_fill="black")
    buffer = io.BytesIO()
    image.save(buffer, format="PNG")
    try:
        replace_file(path, buffer.getvalue())
    except OSError as error:
        raise CameraError(
            f"{path}: cannot be written: {error.strerror}; make room, or choose another --out"
        ) from None
