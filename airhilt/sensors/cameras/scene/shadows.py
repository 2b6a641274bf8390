"""Shadows of bodies on flat ground."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from airhilt.imaging.view import View
from airhilt.sensors.cameras.renderers import Part, Samples
from airhilt.sensors.cameras.scene.background import KEPT_PX, Background
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.layers import by_sample

ON_GROUND_M = 0.3
"""Distance from the ground, in m, up to which a surface is part of it."""


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
