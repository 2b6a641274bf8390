"""What the renderer moderngl takes of memory."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from airhilt.imaging.view import Intrinsics, Pose, View, Window
from airhilt.sensors.cameras.renderers import Part
from airhilt.sensors.cameras.renderers.moderngl import ModernGLRenderer
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.shapes.mesh import Mesh

moderngl = pytest.importorskip("moderngl")


def test_bodies_of_many_sizes_take_no_more_room_than_the_largest(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made: list[Any] = []

    def watch(what: str) -> None:
        make = getattr(moderngl.Context, what)

        def watched(context: Any, *given: Any, **named: Any) -> Any:
            made.append(make(context, *given, **named))
            return made[-1]

        monkeypatch.setattr(moderngl.Context, what, watched)

    triangle = Mesh.of(np.eye(3), (0, 1, 2), (0.5, 0.5, 0.5))
    light = Illumination(np.array((0.0, 0.0, 1.0)), visibility_m=10_000.0, overcast=0.0)
    renderer = ModernGLRenderer(triangle, light)
    renderer.add_shape("body", triangle)
    view = View(Intrinsics(1920, 1080, 1.0), Pose.of((0.0, 0.0, 9.0), 0.0))
    for what in ("texture", "depth_renderbuffer", "framebuffer"):
        watch(what)
    for number in range(60):
        width, height = 64 + 64 * (number * 7 % 20), 64 + 64 * (number * 5 % 12)
        window = Window(0, 0, width, height)
        ahead = Pose.of((0.0, 50.0, 9.0), 0.0)
        (drawn,) = renderer.parts(view, [Part("body", ahead, window, 1)])
        assert drawn.colour.shape == (height, width, 3)
    held = [one for one in made if not isinstance(one.mglo, moderngl.InvalidObject)]
    assert len(held) == 4, "colours, distances, depths, and the frame of them"
    assert all(one.size == (64 * 20, 64 * 12) for one in held)
    renderer.close()
