"""Truth about the bodies in a picture."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from airhilt.messages import VisibleClass
from airhilt.sensors.cameras.frame import Sighting
from airhilt.sensors.cameras.scene.layers import Layer
from airhilt.sensors.cameras.scene.visible_bodies import VisibleBody


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
            truncation=1.0 - min(body.box.area / max(body.whole.area, 1e-9), 1.0),
            range_m=body.range_m,
            transmission=math.exp(-extinction_per_m * body.range_m),
        )
        for body, actor, pixels, fraction in found
        if actor in labels
    ]
    return tuple(sorted(sightings, key=lambda sighting: sighting.range_m))
