"""What draws: one protocol, two backends that agree."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from airhilt.errors import RendererError
from airhilt.sensors.cameras import RENDERERS, RendererName
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.view import Intrinsics, Pose, View, Window
from airhilt.shapes.mesh import Floats, Mesh


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


class Part(NamedTuple):
    """A body, or its shadow on flat ground, that is to be drawn alone in a window.

    Attributes
    ----------
    samples
        Along each side of a pixel.
    """

    shape: str
    pose: Pose
    window: Window
    samples: int
    is_shadow: bool = False


class Renderer(Protocol):
    """Draws the still world, and each body alone.

    The samples of a window are ``samples`` squared a pixel, in the order of the picture's rows.
    """

    def world(self, view: View, window: Window, samples: int = 1) -> Samples:
        """Return the world behind all bodies, with the sky and the air."""

    def parts(self, view: View, parts: Sequence[Part]) -> list[Samples]:
        """Return bodies through the air, and shadows.

        Beside a body it is black and infinitely far. Of a shadow it tells no more than that: it is
        finite where the body keeps the sun from the ground.
        """

    def add_shape(self, name: str, mesh: Mesh) -> None:
        """Take in the shape of a body."""

    def close(self) -> None:
        """Give back what was taken."""


def open_renderer(
    name: RendererName, world: Mesh, shapes: Mapping[str, Mesh], light: Illumination
) -> Renderer:
    """Return a backend that draws a world and bodies of some shapes.

    Raises
    ------
    RendererError
        There is none of that name, or something that it needs is not installed.
    """
    renderer: Renderer
    if name == "open3d":
        from airhilt.sensors.cameras.renderers.raycasting import Open3DRenderer

        renderer = Open3DRenderer(world, light)
    elif name == "moderngl":
        from airhilt.sensors.cameras.renderers.opengl import ModernGLRenderer

        renderer = ModernGLRenderer(world, light)
    else:
        raise RendererError(f"no renderer {name!r}; expected one of {', '.join(RENDERERS)}")
    for shape, mesh in shapes.items():
        renderer.add_shape(shape, mesh)
    return renderer


def require_renderer(name: RendererName) -> None:
    """Complain about a backend that cannot draw here; what it loads stays in the process.

    Raises
    ------
    RendererError
        Something that it needs is not installed.
    """
    triangle = Mesh.of(np.eye(3), (0, 1, 2), (0.5, 0.5, 0.5))
    light = Illumination(np.array((0.0, 0.0, 1.0)), visibility_m=10_000.0, overcast=0.0)
    renderer = open_renderer(name, triangle, {}, light)
    view = View(Intrinsics(16, 16, 1.0), Pose.of((0.0, 0.0, 9.0), 0.0))
    renderer.world(view, view.whole)
    renderer.close()
