"""Rays that runs share by the views of moving cameras."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from airhilt.imaging.view import Intrinsics, Pose, View, Window
from airhilt.sensors.cameras.raycasting.renderer import RayRenderer
from airhilt.sensors.cameras.renderers.embree import RENDERER
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.shapes.mesh import Mesh

LIGHT = Illumination(np.array((0.0, 0.6, 0.8)), visibility_m=9_000.0, overcast=0.2)
LENS = Intrinsics(96, 64, 0.9)
WINDOW = Window(0, 24, 96, 64)


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "airhilt" / "rays"


def field(top_m: float = 30.0) -> Mesh:
    """Return a ground with a roof over a part of it."""
    ground = [(-900, -900, 0), (900, -900, 0), (900, 900, 0), (-900, 900, 0)]
    roof = [(-40, 150, top_m), (40, 150, top_m), (40, 260, top_m + 8.0), (-40, 260, top_m + 8.0)]
    colours = [(0.2, 0.4, 0.1)] * 2 + [(0.6, 0.3, 0.2)] * 2
    faces = [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)]
    return Mesh.of(np.array([*ground, *roof], float), np.array(faces), np.array(colours))


def view(east_m: float = 0.0) -> View:
    return View(LENS, Pose.of((east_m, 0.0, 20.0), 0.1, -0.05, 0.03))


def renderer(mesh: Mesh, library: str = "embreex 1") -> RayRenderer:
    opened = RENDERER.open(mesh, LIGHT)
    if library:
        opened.share_rays(library)
    return opened


def test_a_picture_of_shared_rays_is_that_of_rays_that_are_cast(cache: Path) -> None:
    for east_m in (0.0, 3.0):
        cast, first, second = (
            renderer(field(), library).landscape(view(east_m), WINDOW)
            for library in ("", "embreex 1", "embreex 1")
        )
        for shared in (first, second):
            np.testing.assert_array_equal(shared.colour, cast.colour)
            np.testing.assert_array_equal(shared.distance_m, cast.distance_m)
    assert len(list(cache.iterdir())) == 2


def test_a_renderer_casts_no_rays_of_which_another_knows_what_they_meet(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    renderer(field()).landscape(view(), WINDOW)
    monkeypatch.setattr(RayRenderer, "_adaptively", None)
    renderer(field()).landscape(view(), WINDOW)


@pytest.mark.parametrize("other", ["view", "window", "landscape", "library", "processor"])
def test_what_rays_meet_is_kept_by_all_that_it_depends_on(
    other: str, cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    renderer(field()).landscape(view(), WINDOW)
    if other == "processor":
        (tmp_path / "cpuinfo").write_text("model name: another one\n")
        monkeypatch.setattr("airhilt.host.processor.PROCESSOR", tmp_path / "cpuinfo")
    mesh = field(31.0) if other == "landscape" else field()
    renderer(mesh, "embreex 2" if other == "library" else "embreex 1").landscape(
        view(0.1 if other == "view" else 0.0),
        Window(0, 0, 96, 64) if other == "window" else WINDOW,
    )
    assert len(list(cache.iterdir())) == 2
