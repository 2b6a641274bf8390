"""The pictures of a run's cameras as they are published, and what takes them."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from airhilt.imaging.masks import Mask
from airhilt.imaging.view import View
from airhilt.sensors.cameras.frame import Frame, Prospect, Sighting
from airhilt.sensors.cameras.renderer_pool import RendererPool
from airhilt.sensors.cameras.renderer_process import RendererProcess
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sim.payload import Payload


@dataclass(frozen=True)
class CameraPicture:
    """A picture that a camera has taken.

    Attributes
    ----------
    sha256
        SHA-256 of the pixels.
    pixels
        Colours in 8-bit sRGB, row by row.
    """

    camera: str
    view: View
    sightings: tuple[Sighting, ...]
    sha256: str
    pixels: Payload


class PictureSource(Protocol):
    """Source of the pictures of all cameras that are due at an instant."""

    @property
    def own_aircraft(self) -> Mapping[str, Mask]:
        """Pixels that a camera's own aircraft may cover, by camera."""
        ...

    def take(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> list[CameraPicture]:
        """Take the pictures.

        Raises
        ------
        RendererError
            No more pictures can be taken.
        """
        ...

    def prospects(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> dict[str, Prospect]:
        """Return what pictures of an instant would show, by camera, without taking them.

        Raises
        ------
        RendererError
            No more pictures can be taken.
        """
        ...


class DrawnPictures:
    """Draws each picture; it raises what the renderer does."""

    def __init__(self, renderer: RendererProcess | RendererPool) -> None:
        self.own_aircraft = renderer.own_aircraft
        self._renderer = renderer
        self._last: dict[str, CameraPicture] = {}

    def take(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> list[CameraPicture]:
        """Take the pictures."""
        return [self._picture(frame) for frame in self._renderer.shoot(names, bodies, t_ns)]

    def prospects(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> dict[str, Prospect]:
        """Return what pictures of an instant would show, by camera, without taking them."""
        return self._renderer.prospects(names, bodies, t_ns)

    def _picture(self, frame: Frame) -> CameraPicture:
        """Return a frame as a picture; where it is the last one again, so is its hash."""
        last = self._last.get(frame.camera)
        if frame.unchanged and last is not None:
            picture = replace(last, view=frame.view, sightings=frame.sightings)
        else:
            pixels = frame.colour.tobytes()
            digest = hashlib.sha256(pixels).hexdigest()
            picture = CameraPicture(frame.camera, frame.view, frame.sightings, digest, pixels)
        self._last[frame.camera] = picture
        return picture
