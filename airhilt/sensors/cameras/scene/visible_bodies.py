"""Projects bodies, their shadows and their lights into a picture, before anything is drawn."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from airhilt.imaging.view import Pose, View, Window
from airhilt.sensors.cameras.renderers import Part
from airhilt.sensors.cameras.scene.bodies import BodyState, Model
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.lights import Lights, Spot
from airhilt.sensors.cameras.scene.projected_box import Box
from airhilt.shapes.lights import Light
from airhilt.shapes.mesh import Mesh

SAMPLES_OF_AREA = ((900, 4), (2500, 3), (16_000, 2))
"""Area of a window in pixels, at most, and samples along each side of its pixels; larger windows
have one sample a pixel."""
FAINTEST = 1.0 / 512.0
"""Least area in pixels, times the contrast that the air leaves, that changes a level of a pixel."""
LEAST_BODY_PX = 2.0
"""Least area of a body's box, in square px, at which an adaptive camera exposes at its rate."""
SHADOW_BELOW_M = 150.0
SMALLEST_SHADOW_PX = 4.0
SMALL_PX = 4000
"""Area of all the pixels of a body, in the picture or not, below which it is drawn coarsely."""


class VisibleBody(NamedTuple):
    """A body in a picture: the mesh to draw, its window, and the box about what is in the picture.

    Attributes
    ----------
    truncation
        Part of the box about the whole body that lies outside of the picture.
    """

    body: BodyState
    pose: Pose
    shape: str
    window: Window
    box: Box
    truncation: float
    range_m: float
    transmission: float

    @property
    def leaves_a_trace(self) -> bool:
        """True if it changes any pixel through the air that there is."""
        return self.box.area * self.transmission > FAINTEST

    @property
    def is_large(self) -> bool:
        """True if it also covers `LEAST_BODY_PX`, hidden or not."""
        return self.leaves_a_trace and self.box.area >= LEAST_BODY_PX


class VisibleBodies:
    """The bodies of a scene, projected into the pictures of its cameras.

    Attributes
    ----------
    shapes
        All meshes of the bodies, the coarse ones too, by name.
    outlines
        Outlines of the others, by name.
    """

    def __init__(
        self, models: Mapping[str, Model], light: Illumination, supersampling: int
    ) -> None:
        self._models = models
        self._light = light
        self._supersampling = supersampling
        self.shapes: dict[str, Mesh] = {}
        for model in models.values():
            for name, mesh in model.shapes.items():
                self.shapes[f"{model.kind}/{name}"] = mesh
            for name, mesh in model.far.items():
                self.shapes[f"{model.kind}/{name}/far"] = mesh
        self.outlines = {
            f"{model.kind}/{name}": outline
            for model in models.values()
            for name, outline in model.outlines.items()
        }

    def seen(self, body: BodyState, pose: Pose, view: View) -> VisibleBody | None:
        """Return a body if it is in the picture, hidden or not."""
        shape = self._shape(body)
        projected = self.outlines[shape].seen(pose, view)
        if projected is None or (box := projected.in_picture).area <= 0.0:
            return None
        whole = projected.whole
        away = math.dist(pose.position_m, view.pose.position_m)
        return VisibleBody(
            body,
            pose,
            self._fitting(shape, whole),
            box.window(view),
            box,
            1.0 - min(whole.within(view).area / whole.area, 1.0),
            away,
            math.exp(-self._light.extinction_per_m * away),
        )

    def shadow(self, body: BodyState, pose: Pose, view: View) -> Part | None:
        """Return the shadow of a body on flat ground if it is in the picture."""
        light = self._light
        if (
            body.up_m > SHADOW_BELOW_M
            or light.sun[2] < math.sin(math.radians(4.0))
            or light.overcast > 0.8
        ):
            return None
        shape = self._shape(body)
        projected = self.outlines[shape].shadow(pose, view, light.sun)
        if projected is None:
            return None
        box = projected.in_picture
        left = math.exp(-light.extinction_per_m * math.dist(pose.position_m, view.pose.position_m))
        if box.area < SMALLEST_SHADOW_PX or box.area * left < FAINTEST:
            return None
        window = box.window(view)
        samples = max(min(_samples_of(window), 2), self._supersampling)
        drawn = self._fitting(shape, projected.whole)
        return Part(drawn, pose, window, samples, is_shadow=True)

    def part(self, seen: VisibleBody) -> Part:
        """Return a body as a renderer is to draw it."""
        samples = max(_samples_of(seen.window), self._supersampling)
        return Part(seen.shape, seen.pose, seen.window, samples)

    def lights(self, bodies: Mapping[str, BodyState], t_ns: int) -> dict[str, list[Light]]:
        """Return the lights that are on, in the axes of the actors that carry them."""
        # Nobody's lights flash together with another's.
        return {
            actor: list(self._models[actor].lights(t_ns / 1e9 + 0.37 * number, body.lit))
            for number, (actor, body) in enumerate(bodies.items())
        }

    def spots(
        self,
        view: View,
        lights: Mapping[str, Sequence[Light]],
        poses: Mapping[str, Pose],
        carrier: str | None,
    ) -> list[Spot]:
        """Return the lights in a picture of others than the carrier of the camera."""
        carried = [(poses[actor], group) for actor, group in lights.items() if actor != carrier]
        return Lights.carried(carried).seen(view, self._light)

    def _fitting(self, shape: str, whole: Box) -> str:
        """Return the mesh of a shape that fits the size in which it is seen."""
        far = f"{shape}/far"
        return far if whole.pixels.area < SMALL_PX and far in self.shapes else shape

    def _shape(self, body: BodyState) -> str:
        return f"{self._models[body.actor].kind}/{body.shape}"


def _samples_of(window: Window) -> int:
    return next((samples for area, samples in SAMPLES_OF_AREA if window.area <= area), 1)
