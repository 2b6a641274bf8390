"""What a fixed camera sees of the landscape is drawn once for all processes."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from airhilt.imaging.view import Intrinsics, Pose, View
from airhilt.sensors.cameras.frame import Frame
from airhilt.sensors.cameras.mounts import Camera
from airhilt.sensors.cameras.renderers import Samples
from airhilt.sensors.cameras.scene.background import kept_background
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.landscape import Landscape
from airhilt.sensors.cameras.scene_renderer import SceneRenderer
from airhilt.shapes.lights import Light
from airhilt.shapes.mesh import Mesh

LENS = Intrinsics(64, 36, math.radians(60.0))
CORNERS = ((-900.0, -900.0, 0.0), (900.0, -900.0, 0.0), (900.0, 900.0, 0.0), (-900.0, 900.0, 0.0))
GROUND = Mesh.of(CORNERS, (0, 1, 2, 0, 2, 3), (0.2, 0.5, 0.3))
LAMP = Light((0.0, 200.0, 2.0), (1.0, 1.0, 1.0), 5_000.0)
FIELD = Landscape(GROUND, (LAMP,), ())
NIGHT = Illumination(np.array((0.0, 0.8, -0.6)), visibility_m=9_000.0, overcast=0.0)
EYE = Pose.of((3.0, -50.0, 12.0), 0.1, -0.1)


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's cache, empty."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "airhilt" / "backgrounds"


class Drawn:
    """Draws a picture of noise, and counts how often."""

    def __init__(self) -> None:
        self.times = 0

    def __call__(self) -> Samples:
        self.times += 1
        noise = np.random.default_rng(7)
        shape = (LENS.height_px, LENS.width_px)
        colour = noise.integers(0, 256, (*shape, 3), dtype=np.uint8)
        distance = noise.random(shape, dtype=np.float32)
        distance[0] = np.inf
        return Samples(colour, distance)


def test_what_is_kept_is_what_was_drawn() -> None:
    drawn = Drawn()
    first, kept = (kept_background("field", View(LENS, EYE), 3, drawn) for _ in range(2))
    assert drawn.times == 1
    for picture in (first, kept):
        assert np.array_equal(picture.colour, drawn().colour)
        assert np.array_equal(picture.distance_m, drawn().distance_m)


@pytest.mark.parametrize(
    ("landscape", "view", "samples"),
    [
        ("field", View(LENS, replace(EYE, position_m=(3.0, -50.0, 12.01))), 3),
        ("field", View(LENS, Pose.of(EYE.position_m, 0.1001, -0.1)), 3),
        ("field", View(replace(LENS, horizontal_fov_rad=1.0), EYE), 3),
        ("field", View(LENS, EYE), 4),
        ("another field", View(LENS, EYE), 3),
    ],
)
def test_another_view_is_drawn(landscape: str, view: View, samples: int) -> None:
    drawn = Drawn()
    kept_background("field", View(LENS, EYE), 3, drawn)
    kept_background(landscape, view, samples, drawn)
    assert drawn.times == 2


def frames(*, keeps: bool) -> list[Frame]:
    """Return what a scene renderer draws for a fixed camera, twice."""
    camera = Camera("tower", LENS, EYE)
    renderer = SceneRenderer(FIELD, NIGHT, {}, [camera], "embree", 4.0, keeps_backgrounds=keeps)
    try:
        return [frame for t_ns in (0, 1) for frame in renderer.shoot(["tower"], [], t_ns)]
    finally:
        renderer.close()


def test_a_scene_has_the_same_pictures_with_and_without_the_cache(cache: Path) -> None:
    plain = frames(keeps=False)
    assert not cache.exists()
    for kept in (frames(keeps=True), frames(keeps=True)):
        for was, now_is in zip(plain, kept, strict=True):
            assert np.array_equal(was.colour, now_is.colour)
            assert np.array_equal(was.distance_m, now_is.distance_m)
    assert len(list(cache.iterdir())) == 1
