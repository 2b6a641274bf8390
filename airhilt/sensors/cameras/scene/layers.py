"""Bodies before the landscape, one layer each, their shadows, and what is true of them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from airhilt.imaging.view import View, Window
from airhilt.messages import VisibleClass
from airhilt.sensors.cameras.frame import Sighting
from airhilt.sensors.cameras.renderers import Part, Samples
from airhilt.sensors.cameras.scene.background import KEPT_PX, Background
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.projected_box import Box
from airhilt.sensors.cameras.scene.visible_bodies import VisibleBody
from airhilt.shapes.mesh import Floats

Number = TypeVar("Number", bound=np.generic)
FILLED = 0.5
"""Part of a pixel that a body must cover to fill it. One that covers as much, but of no single
pixel, fills the pixel that it covers most."""
ON_GROUND_M = 0.3
"""Distance from the ground, in m, up to which a surface is part of it."""
TOUCHES_M = 0.25
"""Distance behind a surface, in m, up to which a body still lies on it."""


@dataclass
class Layer:
    """A body in its window.

    Attributes
    ----------
    box
        About what of the body is in the picture; pixels.
    truncation
        Part of the box about the whole body that lies outside of the picture.
    silhouette
        Area of the body in the picture, hidden or not; pixels.
    cover
        Part of each pixel that it fills and the landscape does not hide; shape (rows, columns).
    colour
        Its light in each pixel, times what it fills; shape (rows, columns, 3).
    distance_m
        Distance of the body's nearest sample in each pixel, infinite where there is none.
    """

    actor: str
    number: int
    window: Window
    box: Box
    truncation: float
    range_m: float
    silhouette: float
    cover: Floats
    colour: Floats
    distance_m: Floats

    @classmethod
    def of(
        cls, number: int, body: VisibleBody, drawn: Samples, samples: int, behind_m: Floats
    ) -> Layer:
        """Return the layer of a body that has been drawn before a landscape so far away."""
        distance = by_sample(drawn.distance_m, samples)
        colour = by_sample(drawn.colour, samples)
        is_body = np.isfinite(distance)
        seen = is_body & (distance < behind_m + np.float32(TOUCHES_M))
        hidden = is_body & ~seen
        if hidden.any():
            colour = np.where(hidden[..., None], np.uint8(0), colour)
        count = np.float32(samples**2)
        return cls(
            body.body.actor,
            number,
            body.window,
            body.box,
            body.truncation,
            body.range_m,
            float(is_body.sum()) / samples**2,
            np.add.reduce(seen, axis=0, dtype=np.float32) / count,
            np.add.reduce(colour, axis=0, dtype=np.float32) / count,
            np.where(seen, distance, np.float32(np.inf)).min(axis=0),
        )

    def lay(
        self,
        colour: npt.NDArray[np.uint8],
        distance_m: Floats,
        instance: npt.NDArray[np.uint8],
    ) -> None:
        """Draw the layer over a picture."""
        rows, columns = self.window.slices
        part = colour[rows, columns]
        part[...] = np.rint(part * (1.0 - self.cover[..., None]) + self.colour).astype(np.uint8)
        filled = self.cover >= FILLED
        if not filled.any() and self.cover.sum() >= FILLED:
            filled = self.cover == self.cover.max()
        instance[rows, columns][filled] = self.number
        distance_m[rows, columns][filled] = self.distance_m[filled]

    def hide(self, seen: Floats, window: Window) -> None:
        """Reduce the visible part of a farther layer, in its window, by what this layer covers."""
        left, top = max(window.left, self.window.left), max(window.top, self.window.top)
        right = min(window.right, self.window.right)
        bottom = min(window.bottom, self.window.bottom)
        if left >= right or top >= bottom:
            return
        cover = self.cover[
            top - self.window.top : bottom - self.window.top,
            left - self.window.left : right - self.window.left,
        ]
        hidden = seen[top - window.top : bottom - window.top,
                      left - window.left : right - window.left]  # fmt: skip
        hidden *= 1.0 - cover


def by_sample(drawn: npt.NDArray[Number], samples: int) -> npt.NDArray[Number]:
    """Return the samples of a window as that many pictures of it, one behind the other."""
    rows, columns = (side // samples for side in drawn.shape[:2])
    blocks = drawn.reshape(rows, samples, columns, samples, *drawn.shape[2:])
    order = blocks.transpose(1, 3, 0, 2, *range(4, blocks.ndim))
    return order.reshape(samples**2, rows, columns, *drawn.shape[2:])


def sightings_of(
    layers: Sequence[Layer],
    faint: Sequence[VisibleBody],
    labels: Mapping[str, VisibleClass],
    extinction_per_m: float,
) -> tuple[Sighting, ...]:
    """Return the sighting of each body, the nearest first.

    Parameters
    ----------
    layers
        Bodies that are drawn, from far to near; those of actors without a label only hide others.
    faint
        Bodies that change no pixel.
    labels
        Class of each actor that is told.
    """
    found: list[tuple[Layer | VisibleBody, str, float, float]] = [
        (body, body.body.actor, 0.0, 0.0) for body in faint
    ]
    for index, layer in enumerate(layers):
        seen = layer.cover.copy()
        for nearer in layers[index + 1 :]:
            nearer.hide(seen, layer.window)
        pixels = float(seen.sum())
        fraction = min(pixels / layer.silhouette, 1.0) if layer.silhouette else 0.0
        found.append((layer, layer.actor, pixels, fraction))
    sightings = [
        Sighting(
            actor=actor,
            label=labels[actor],
            box=body.box,
            pixels=pixels,
            visible_fraction=fraction,
            truncation=body.truncation,
            range_m=body.range_m,
            transmission=math.exp(-extinction_per_m * body.range_m),
        )
        for body, actor, pixels, fraction in found
        if actor in labels
    ]
    return tuple(sorted(sightings, key=lambda sighting: sighting.range_m))


def darken(
    colour: npt.NDArray[np.uint8],
    part: Part,
    drawn: Samples,
    view: View,
    background: Background,
    light: Illumination,
) -> None:
    """Darken the flat ground where a body keeps the sun off."""
    shaded = np.isfinite(by_sample(drawn.distance_m, part.samples))
    down = view.directions(*view.sample_places(part.window, 1))[2]
    away = background.distance_m[part.window.slices]
    with np.errstate(invalid="ignore"):
        # The ground may have been drawn when it was a little out of its place.
        near = np.float32(ON_GROUND_M) + np.float32(KEPT_PX / view.intrinsics.focal_px) * away
        on_ground = np.abs(away * down + np.float32(view.pose.position_m[2])) < near
        kept = shaded.mean(axis=0, dtype=np.float32) * on_ground
        kept *= np.exp(-np.float32(light.extinction_per_m) * away)
    lit = light.diffuse + light.direct * max(float(light.sun[2]), 0.0)
    darker = 1.0 - (light.diffuse / lit) ** (1.0 / 2.2)
    ground = colour[part.window.slices]
    ground[...] = (ground * (1.0 - kept[..., None] * darker)).astype(np.uint8)
