"""Pictures by casting rays: what a library that casts them must provide.

`airhilt.sensors.cameras.raycasting.renderer` makes pictures of what rays meet. Libraries differ in
nothing but how fast they find it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from airhilt.imaging.masks import Mask
from airhilt.shapes.mesh import Floats

MISS = -1
"""Number of the triangle that a ray meets where it meets none."""
Triangles = npt.NDArray[np.int32]


class Hits(NamedTuple):
    """The first surfaces that n rays meet.

    Attributes
    ----------
    distance_m
        Distance along the ray; infinite where it meets nothing.
    triangles
        Number of the triangle that is met; `MISS` where there is none.
    u, v
        Barycentric weights of the triangle's second and third corner at the place that is met.
    """

    distance_m: Floats
    triangles: Triangles
    u: Floats
    v: Floats


class RayScene(Protocol):
    """Triangles that stand still, and the rays that are cast at them.

    Directions of rays from one origin have the shape (3, n). Distances are in lengths of a
    direction.
    """

    def triangles(self, origin: npt.NDArray[np.floating], directions: Floats) -> Triangles:
        """Return the first triangle that each ray from ``origin`` meets, or `MISS`."""

    def hits(self, origin: npt.NDArray[np.floating], directions: Floats) -> Hits:
        """Return where each ray from ``origin`` first meets a triangle."""

    def blocked(self, origins: npt.NDArray[np.floating], direction: Floats) -> Mask:
        """Return which rays from origins of shape (n, 3) in one direction meet any triangle."""


SceneBuilder = Callable[[Floats], RayScene]
"""Returns the scene of triangles with corners of shape (n, 3, 3)."""
