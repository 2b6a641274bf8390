"""Renderers, which draw pictures: one file each, with its `RENDERER`.

A file in this package needs no registration. A renderer outside of it is found by an entry point
of the group ``airhilt.renderers`` that names the object, such as
``optix = "my_package.optix:RENDERER"``, and is then taken by ``--renderer optix``. All draw
the same picture of the same scene.
"""

from __future__ import annotations

import importlib.metadata
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from airhilt.errors import AirhiltError, RendererError
from airhilt.host.library import nearest
from airhilt.imaging.view import Intrinsics, Pose, View, Window
from airhilt.plugins import Family
from airhilt.sensors.cameras import AUTO, FASTEST
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.shapes.mesh import Floats, Mesh

PREFERRED = {AUTO: ("embree", "open3d"), FASTEST: ("moderngl", "embree", "open3d")}
"""Renderers that are tried in turn; the first that can draw here does."""


class Samples(NamedTuple):
    """The samples of a window.

    Attributes
    ----------
    colour
        8-bit sRGB, shape (rows, columns, 3).
    distance_m
        Distance from the camera to the surface along the ray, infinite where there is none; shape
        (rows, columns).
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
    """Draws the landscape, and each body alone.

    The samples of a window are ``samples`` squared a pixel, in the order of the picture's rows.
    """

    def landscape(self, view: View, window: Window, samples: int = 1) -> Samples:
        """Return the landscape behind all bodies, with the sky and the air."""

    def parts(self, view: View, parts: Sequence[Part]) -> list[Samples]:
        """Return bodies through the air, and shadows.

        Samples beside a body are black and infinitely far. A shadow has no colour: its distance is
        finite where the body keeps the sun from the ground.
        """

    def add_shape(self, name: str, mesh: Mesh) -> None:
        """Keep the shape of a body, to draw it by this name."""

    def close(self) -> None:
        """Release memory and devices."""


@runtime_checkable
class RendererBackend(Protocol):
    """A library that draws, as ``--renderer`` names it."""

    @property
    def name(self) -> str:
        """Name of its file or entry point."""

    @property
    def needs(self) -> str:
        """Commands that install what it needs, in one line."""

    def open(self, landscape: Mesh, light: Illumination) -> Renderer:
        """Return a renderer of a landscape in some light.

        Raises
        ------
        RendererError
            Something that it needs is missing; the text says in one line how to install it.
        """


FAMILY = Family(
    "renderer", "airhilt.renderers", __name__, "RENDERER", RendererBackend, RendererError
)


def library_of(name: str) -> str:
    """Return the library whose version alone determines what a renderer draws, with its version.

    A renderer has the names under which it may be installed in the attribute ``distributions``.
    Empty for one without, such as one that draws on a graphics card, whose driver has a part in it.
    """
    for distribution in getattr(FAMILY.load(name), "distributions", ()):
        with suppress(importlib.metadata.PackageNotFoundError):
            return f"{distribution} {importlib.metadata.version(distribution)}"
    return ""


def require_known(name: str) -> None:
    """Complain about a name that no renderer has.

    Raises
    ------
    AirhiltError
        There is no renderer of that name.
    """
    names = [*PREFERRED, *FAMILY.names()]
    if name not in names:
        raise AirhiltError(
            f"no renderer named {name!r}{nearest(name, names)}; expected one of {', '.join(names)}"
        )


def open_renderer(
    name: str, landscape: Mesh, shapes: Mapping[str, Mesh], light: Illumination
) -> tuple[str, Renderer]:
    """Return the name of the renderer that draws, and the renderer.

    Parameters
    ----------
    name
        Name of a renderer, or of a row of `PREFERRED`.

    Raises
    ------
    RendererError
        There is none of that name, or something that it needs is not installed.
    """
    *others, taken = PREFERRED.get(name, (name,))
    renderer = None
    for other in others:
        with suppress(RendererError):
            renderer = FAMILY.load(other).open(landscape, light)
            taken = other
            break
    renderer = renderer or FAMILY.load(taken).open(landscape, light)
    for shape, mesh in shapes.items():
        renderer.add_shape(shape, mesh)
    return taken, renderer


def require_renderer(name: str) -> str:
    """Draw something and return the name of what drew; what it loads stays in the process.

    Raises
    ------
    AirhiltError
        There is no renderer of that name, or it cannot draw here.
    """
    require_known(name)
    triangle = Mesh.of(np.eye(3), (0, 1, 2), (0.5, 0.5, 0.5))
    light = Illumination(np.array((0.0, 0.0, 1.0)), visibility_m=10_000.0, overcast=0.0)
    taken, renderer = open_renderer(name, triangle, {}, light)
    view = View(Intrinsics(16, 16, 1.0), Pose.of((0.0, 0.0, 9.0), 0.0))
    renderer.landscape(view, view.whole)
    renderer.close()
    return taken
