"""Truth about the bodies in a picture."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from airhilt.messages import VisibleClass
from airhilt.sensors.cameras.frame import Sighting
from airhilt.sensors.cameras.scene.layers import Layer
from airhilt.sensors.cameras.scene.projected_box import Box
from airhilt.sensors.cameras.scene.visible_bodies import VisibleBody


class Sightings:
    """Computes the truth about the bodies in a picture.

    Parameters
    ----------
    labels
        Class of each actor, in the order of the numbers of actors in ``Frame.instance``.
    """

    def __init__(self, labels: Mapping[str, VisibleClass], extinction_per_m: float) -> None:
        self._labels = labels
        self._actors = tuple(labels)
        self._extinction_per_m = extinction_per_m

    def of(
        self, layers: Sequence[Layer], faint: Sequence[VisibleBody], own: Layer | None = None
    ) -> tuple[Sighting, ...]:
        """Return the sighting of each body; layers are ordered from far to near."""
        found = [self._sighting(one.body.actor, one.box, one.whole, one.range_m) for one in faint]
        for index, layer in enumerate(layers):
            if layer is own:
                continue
            seen = layer.cover.copy()
            for nearer in layers[index + 1 :]:
                nearer.hide(seen, layer.window)
            pixels = float(seen.sum())
            fraction = min(pixels / layer.silhouette, 1.0) if layer.silhouette else 0.0
            actor = self._actors[layer.number - 1]
            found.append(
                self._sighting(actor, layer.box, layer.whole, layer.range_m, pixels, fraction)
            )
        return tuple(sorted(found, key=lambda sighting: sighting.range_m))

    def _sighting(
        self,
        actor: str,
        box: Box,
        whole: Box,
        range_m: float,
        pixels: float = 0.0,
        visible_fraction: float = 0.0,
    ) -> Sighting:
        inside = min(box.area / max(whole.area, 1e-9), 1.0)
        left = math.exp(-self._extinction_per_m * range_m)
        label = self._labels[actor]
        return Sighting(actor, label, box, pixels, visible_fraction, 1.0 - inside, range_m, left)
