"""What draws: one protocol, two backends that agree."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from airhilt.cameras.light import Light
from airhilt.cameras.mesh import Floats, Mesh
from airhilt.cameras.view import Pose, View, Window
from airhilt.errors import RendererError

RendererName = Literal["open3d", "moderngl"]
RENDERERS: tuple[RendererName, ...] = ("open3d", "moderngl")


class Samples(NamedTuple):
    """What is seen in the samples of a window.

    Attributes
    ----------
    colour
        8-bit sRGB, shape (rows, columns, 3).
    distance_m
        From the camera to the surface, along the ray; infinite where nothing is. Of shape (rows,
        columns).
    """

    colour: npt.NDArray[np.uint8]
    distance_m: Floats


class Renderer(Protocol):
    """Draws the parts of a picture: the still world, and one body at a time.

    The samples of a window are ``samples`` squared a pixel, in the order of the picture's rows.
    """

    def world(self, view: View, samples: int = 1) -> Samples:
        """Return the world behind all bodies, with the sky and the air."""

    def body(self, shape: str, pose: Pose, view: View, window: Window, samples: int) -> Samples:
        """Return a body alone, through the air; its distance is infinite beside it."""

    def shadow(
        self, shape: str, pose: Pose, view: View, window: Window, samples: int
    ) -> npt.NDArray[np.bool_]:
        """Return where a body keeps the sun from the flat ground."""

    def add_shape(self, name: str, mesh: Mesh) -> None:
        """Take in the shape of a body."""

    def close(self) -> None:
        """Give back what was taken."""


def open_renderer(
    name: RendererName, world: Mesh, shapes: Mapping[str, Mesh], light: Light
) -> Renderer:
    """Return a backend that draws a world and bodies of some shapes.

    Raises
    ------
    RendererError
        There is none of that name, or something that it needs is not installed.
    """
    renderer: Renderer
    if name == "open3d":
        from airhilt.cameras.renderers.raycasting import Open3DRenderer

        renderer = Open3DRenderer(world, light)
    elif name == "moderngl":
        from airhilt.cameras.renderers.opengl import ModernGLRenderer

        renderer = ModernGLRenderer(world, light)
    else:
        raise RendererError(f"no renderer {name!r}; expected one of {', '.join(RENDERERS)}")
    for shape, mesh in shapes.items():
        renderer.add_shape(shape, mesh)
    return renderer
