"""A picture of a camera, and what is true of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from airhilt.imaging.masks import Mask
from airhilt.imaging.view import View
from airhilt.messages import VisibleClass
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.scene.projected_box import Box
from airhilt.shapes.mesh import Floats
from airhilt.sim.payload import Payload


@dataclass(frozen=True)
class Sighting:
    """The truth about a body in a picture.

    Attributes
    ----------
    box
        About all of the body that is within the picture, whether hidden or not; pixels.
    pixels
        Area that is seen; 0 also of what is too small, or too far in the haze, to change any
        pixel.
    visible_fraction
        Visible share of the body's area within the picture, 0..1; 0 where ``pixels`` is 0.
    truncation
        Part of the box about the whole body that lies outside of the picture.
    range_m
        Distance from the camera to the body's reference point.
    transmission
        Part of the body's contrast that the air leaves.
    """

    actor: str
    label: VisibleClass
    box: Box
    pixels: float
    visible_fraction: float
    truncation: float
    range_m: float
    transmission: float


class Prospect(NamedTuple):
    """Content of a picture of an instant, if it were taken.

    Attributes
    ----------
    has_body
        True if a body other than the one that carries the camera would cover two pixels or more,
        or if one of its lights would be seen.
    """

    view: View
    has_body: bool


@dataclass(frozen=True)
class Frame:
    """A picture and what is true of it; its arrays cannot be written to.

    Attributes
    ----------
    colour
        8-bit sRGB, shape (rows, columns, 3).
    distance_m
        Distance from the camera along the ray, infinite in the sky. If the camera moves, the
        distance of the landscape may be that of an earlier picture: see
        `airhilt.sensors.cameras.scene.background`.
    instance
        0 where no body fills the pixel, else the number of the actor in the scene, from 1.
    unchanged
        The picture is the camera's last one again: colours, distances and instances.
    """

    camera: str
    t_ns: int
    view: View
    colour: npt.NDArray[np.uint8]
    distance_m: Floats
    instance: npt.NDArray[np.uint8]
    sightings: tuple[Sighting, ...]
    unchanged: bool = False


@dataclass(frozen=True)
class CameraPicture:
    """A picture as a run publishes it.

    Attributes
    ----------
    pixels
        Colours in 8-bit sRGB, row by row.
    """

    camera: str
    view: View
    sightings: tuple[Sighting, ...]
    sha256: str
    pixels: Payload

    @property
    def colour(self) -> npt.NDArray[np.uint8]:
        """The pixels as an array of shape (rows, columns, 3)."""
        lens = self.view.intrinsics
        pixels = np.frombuffer(bytes(self.pixels), np.uint8)
        return pixels.reshape(lens.height_px, lens.width_px, 3)


class PictureSource(Protocol):
    """Source of the pictures of all cameras that are due at an instant."""

    @property
    def own_aircraft(self) -> Mapping[str, Mask]:
        """Pixels that a camera's own aircraft may cover, by camera; shape (rows, columns)."""
        ...

    def take(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> list[CameraPicture]:
        """Take the pictures.

        Raises
        ------
        CameraError
            A pose is not finite, or a camera is mounted on something that is not there.
        RendererError
            No more pictures can be taken.
        """
        ...

    def prospects(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> dict[str, Prospect]:
        """Return what the pictures would show, by camera, without taking them; errors as `take`."""
        ...
