"""What a fixed camera sees of the landscape is drawn once for all processes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from airhilt.imaging.view import Intrinsics, Pose, View
from airhilt.sensors.cameras.frame import Frame
from airhilt.sensors.cameras.mounts import Camera
from airhilt.sensors.cameras.renderers import Samples, library_of
from airhilt.sensors.cameras.scene.background_cache import BackgroundCache
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.landscape import Landscape
from airhilt.sensors.cameras.scene_renderer import SceneRenderer
from airhilt.shapes.lights import Light
from airhilt.shapes.mesh import Mesh

LENS = Intrinsics(64, 36, math.radians(60.0))
CORNERS = ((-900.0, -900.0, 0.0), (900.0, -900.0, 0.0), (900.0, 900.0, 0.0), (-900.0, 900.0, 0.0))
GROUND = Mesh.of(CORNERS, (0, 1, 2, 0, 2, 3), (0.2, 0.5, 0.3))
DIM = Mesh.of(CORNERS, (0, 1, 2, 0, 2, 3), (0.1, 0.2, 0.1))
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


def backgrounds(
    *, library: str = "embreex 2", landscape: Landscape = FIELD, light: Illumination = NIGHT
) -> BackgroundCache:
    return BackgroundCache("embree", library, landscape, light)


def test_what_is_kept_is_what_was_drawn() -> None:
    drawn = Drawn()
    first = backgrounds().get(View(LENS, EYE), 3, drawn)
    kept = backgrounds().get(View(LENS, EYE), 3, drawn)
    assert drawn.times == 1
    for picture in (first, kept):
        assert np.array_equal(picture.colour, drawn().colour)
        assert np.array_equal(picture.distance_m, drawn().distance_m)


@pytest.mark.parametrize(
    ("other", "view", "samples"),
    [
        (backgrounds, View(LENS, replace(EYE, position_m=(3.0, -50.0, 12.01))), 3),
        (backgrounds, View(LENS, Pose.of(EYE.position_m, 0.1001, -0.1)), 3),
        (backgrounds, View(replace(LENS, horizontal_fov_rad=1.0), EYE), 3),
        (backgrounds, View(LENS, EYE), 4),
        (lambda: backgrounds(library="embreex 3"), View(LENS, EYE), 3),
        (lambda: backgrounds(light=replace(NIGHT, visibility_m=8_999.0)), View(LENS, EYE), 3),
        (lambda: backgrounds(light=replace(NIGHT, overcast=0.1)), View(LENS, EYE), 3),
        (lambda: backgrounds(landscape=replace(FIELD, mesh=DIM)), View(LENS, EYE), 3),
        (lambda: backgrounds(landscape=replace(FIELD, lights=())), View(LENS, EYE), 3),
    ],
)  # fmt: skip
def test_whatever_changes_the_picture_has_it_drawn(
    other: Callable[[], BackgroundCache], view: View, samples: int
) -> None:
    drawn = Drawn()
    backgrounds().get(View(LENS, EYE), 3, drawn)
    other().get(view, samples, drawn)
    assert drawn.times == 2


def test_other_code_and_another_processor_have_it_drawn(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The instructions of a processor decide the last bits of what libraries compute."""
    drawn = Drawn()
    backgrounds().get(View(LENS, EYE), 3, drawn)
    (tmp_path / "cpuinfo").write_text("model name: another one\n")
    monkeypatch.setattr("airhilt.host.machine.PROCESSOR", tmp_path / "cpuinfo")
    backgrounds().get(View(LENS, EYE), 3, drawn)
    monkeypatch.setattr(
        "airhilt.sensors.cameras.drawing_keys.packages_sha256", lambda *_: "other code"
    )
    backgrounds().get(View(LENS, EYE), 3, drawn)
    assert drawn.times == 3


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


def test_nothing_is_kept_of_a_renderer_whose_pictures_depend_on_a_graphics_card() -> None:
    assert library_of("embree").startswith("embreex ")
    assert library_of("moderngl") == ""
    assert BackgroundCache.of("moderngl", FIELD, NIGHT) is None
