"""Cameras: the scene, what draws it, and what is true of each picture."""

from typing import Literal

RendererName = Literal["open3d", "moderngl"]
RENDERERS: tuple[RendererName, ...] = ("open3d", "moderngl")
RENDERER: RendererName = "open3d"
"""Unless another is named."""
