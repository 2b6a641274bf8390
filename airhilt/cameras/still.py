"""One picture of a scenario at a time."""

from __future__ import annotations

import io
from pathlib import Path

from airhilt.actors import build_cast
from airhilt.cameras import RendererName
from airhilt.cameras.bodies import state_of
from airhilt.cameras.mounts import frame_of
from airhilt.cameras.remote import RemoteStudio
from airhilt.cameras.studio import Frame
from airhilt.errors import CameraError
from airhilt.files import replace_file
from airhilt.scenario import Scenario
from airhilt.scenario.geometry import Setting
from airhilt.scenario.loading import draw
from airhilt.units import seconds_to_ns

TICK_S = 0.05
"""Control tick of the actors, as in a run."""
FINE = 3
"""Samples along each side of a pixel."""


def still(
    scenario: Scenario,
    camera: str,
    at_s: float,
    seed: int = 0,
    renderer: RendererName = "open3d",
) -> Frame:
    """Return what a camera sees at a time, in a run in which nothing is said.

    Raises
    ------
    AirhiltError
        There is no such camera, it could see nothing, or pictures cannot be drawn.
    """
    realised, _ = draw(scenario, seed)
    setting = Setting.of(realised)
    with RemoteStudio(realised, [camera], renderer, FINE) as studio:
        cast = build_cast(realised, setting, seed, TICK_S)
        for _ in range(round(at_s / TICK_S)):
            for performer in cast.values():
                if performer.body.ended is None:
                    performer.body.advance()
        frame = frame_of(setting)
        bodies = [state_of(performer, frame, setting.ground_m, at_s) for performer in cast.values()]
        return studio.shoot([camera], bodies, seconds_to_ns(at_s))[0]


def write_png(frame: Frame, path: Path, boxes: bool = False) -> None:
    """Write a picture, with the boxes of what is in it if wanted: all of the file or nothing.

    Raises
    ------
    CameraError
        Pillow is not installed, or the file cannot be written.
    """
    try:
        from PIL import Image, ImageDraw
    except ImportError:
        raise CameraError("pictures need Pillow: pip install 'airhilt[vision]'") from None
    picture = Image.fromarray(frame.colour)
    if boxes:
        pen = ImageDraw.Draw(picture)
        for sighting in frame.sightings:
            left, top, right, bottom = sighting.box
            pen.rectangle((left - 2, top - 2, right + 1, bottom + 1), outline=(255, 220, 40))
            text = f"{sighting.label} {sighting.range_m:.0f} m"
            pen.text((left, max(top - 14, 0)), text, fill=(255, 220, 40))
    buffer = io.BytesIO()
    picture.save(buffer, format="PNG")
    try:
        replace_file(path, buffer.getvalue())
    except OSError as error:
        raise CameraError(
            f"{path}: cannot be written: {error.strerror}; make room, or choose another --out"
        ) from None
