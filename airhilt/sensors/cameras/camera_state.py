"""State that earlier pictures of a camera leave behind for the next one.

A picture is determined by the scene, the bodies, the time, and this. So a renderer that is given
the state of a camera draws its next picture as the renderer would that has drawn all before.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from airhilt.imaging.view import Intrinsics, Pose, View
from airhilt.sensors.cameras.scene.background import Drawing
from airhilt.sensors.cameras.scene.bodies import BodyState


class CameraState(NamedTuple):
    """State of a camera between two pictures.

    Attributes
    ----------
    drawings
        Drawings of which its background consists; none of a fixed camera, which draws one for all.
    own
        The aircraft that carries it, as it was when it was drawn; None if it has not been.
    taken
        Number of exposures up to now, by which streaks of rain are chosen.
    """

    drawings: tuple[Drawing, ...] = ()
    own: BodyState | None = None
    taken: int = 0

    def to_json(self) -> list[Any]:
        """Return the state as JSON."""
        drawings = [
            [*each.view.pose.position_m, *each.view.pose.rotation.ravel().tolist(), *each[1:]]
            for each in self.drawings
        ]
        return [drawings, None if self.own is None else list(self.own), self.taken]

    @classmethod
    def of_json(cls, given: Sequence[Any], lens: Intrinsics) -> CameraState:
        """Return the state that `to_json` returned."""
        drawn, own, taken = given
        drawings = []
        for east, north, up, *rotation, first, end in drawn:
            pose = Pose((east, north, up), np.array(rotation).reshape(3, 3))
            drawings.append(Drawing(View(lens, pose), first, end))
        return cls(tuple(drawings), None if own is None else BodyState(*own), taken)
