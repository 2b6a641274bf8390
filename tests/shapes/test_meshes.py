"""What moves is closed, so that its far side need not be drawn."""

from __future__ import annotations

import numpy as np
import pytest

from airhilt.sensors.cameras.scene.bodies import Model, aircraft_model, kind_model
from airhilt.shapes.mesh import Mesh

MODELS = [
    *map(aircraft_model, ("737", "B747", "c172p", "c310")),
    *map(kind_model, ("follow_me", "fire_truck", "snow_plough", "tug_with_aircraft")),
    *map(kind_model, ("deer", "coyote", "goose")),
]


def open_edges(mesh: Mesh) -> int:
    """Return how many edges of triangles have no other one along them the other way."""
    corners = np.round(mesh.corners.reshape(-1, 3), 4)
    _, number = np.unique(corners, axis=0, return_inverse=True)
    faces = number.reshape(-1, 3)
    ends = np.vstack((faces[:, :2], faces[:, 1:], faces[:, ::-2]))
    ends = ends[ends[:, 0] != ends[:, 1]]
    edges, which = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
    ways = np.where(ends[:, 0] < ends[:, 1], 1.0, -1.0)
    return int(np.count_nonzero(np.bincount(which.reshape(-1), ways, len(edges))))


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.kind)
def test_every_shape_is_closed(model: Model) -> None:
    for mesh in (*model.shapes.values(), *model.far.values()):
        assert open_edges(mesh) == 0
