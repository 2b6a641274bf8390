"""The triangles of an airport are made once for all processes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from airhilt.sensors.cameras.scene import landscape
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.landscape import airport_landscape
from airhilt.sensors.cameras.scene.mesh_cache import kept_mesh
from airhilt.shapes.mesh import Mesh
from airhilt.world.surface.layout import load_layout

MESH = Mesh.of(np.eye(3), (0, 1, 2), (0.1, 0.2, 0.3), glow=0.4)
NOON = Illumination(np.array((0.0, -0.6, 0.8)), visibility_m=9_000.0, overcast=0.0)


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "airhilt" / "landscapes"


def never() -> Mesh:
    pytest.fail("it is made again")


def alike(one: Mesh, other: Mesh) -> bool:
    return all(map(np.array_equal, one.arrays, other.arrays))


def test_what_is_kept_is_what_was_made() -> None:
    assert alike(kept_mesh(["field", 1.5], lambda: MESH), MESH)
    assert alike(kept_mesh(["field", 1.5], never), MESH)


def test_what_is_determined_otherwise_is_made() -> None:
    kept_mesh(["field", None], lambda: MESH)
    twice = Mesh(*(np.concatenate((each, each)) for each in MESH.arrays))
    assert len(kept_mesh(["field", [0.0, 1.0]], lambda: twice)) == 2


@pytest.mark.slow
def test_an_airport_is_cut_out_once_for_one_light(monkeypatch: pytest.MonkeyPatch) -> None:
    layout = load_layout("KDCA")
    made = airport_landscape(layout, NOON)
    airport_landscape(layout, NOON, is_kept=True)

    def refuse(*_: object) -> Callable[[], Mesh]:
        raise AssertionError

    monkeypatch.setattr(landscape, "_Airport", refuse)
    kept = airport_landscape(layout, NOON, is_kept=True)
    assert alike(kept.mesh, made.mesh)
    assert (kept.blocks, kept.lights) == (made.blocks, made.lights)
    hazy = Illumination(NOON.sun, visibility_m=6_000.0, overcast=0.3)
    assert alike(airport_landscape(layout, hazy, is_kept=True).mesh, made.mesh)
    evening = Illumination(np.array((-0.8, 0.0, 0.6)), visibility_m=9_000.0, overcast=0.0)
    with pytest.raises(AssertionError):
        airport_landscape(layout, evening, is_kept=True)
