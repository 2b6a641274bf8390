"""A picture of a camera, and what is true of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from airhilt.imaging.view import View
from airhilt.messages import VisibleClass
from airhilt.sensors.cameras.scene.projected_box import Box
from airhilt.shapes.mesh import Floats


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

    def sealed(self) -> Frame:
        """Return it, its arrays being safe from writing: several frames may have them."""
        for plane in (self.colour, self.distance_m, self.instance):
            plane.flags.writeable = False
        return self
