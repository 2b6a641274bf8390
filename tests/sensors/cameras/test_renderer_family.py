"""Renderers are asked for by name, and another package can add one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from airhilt import load, run
from airhilt.cosim.replay import replay
from airhilt.errors import AirhiltError, RendererError
from airhilt.record import RunFolder
from airhilt.scenario import Scenario
from airhilt.sensors.cameras import AUTO, FASTEST
from airhilt.sensors.cameras.renderers import FAMILY, open_renderer
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.shapes.mesh import Mesh
from engine_package import installed

VIOLET = """
import numpy as np

from airhilt.sensors.cameras.renderers import Samples


class Violet:
    name = "violet"
    needs = "nothing"

    def open(self, landscape, light):
        return self

    def landscape(self, view, window, samples=1):
        size = window.height * samples, window.width * samples
        colour = np.full((*size, 3), (120, 0, 200), dtype=np.uint8)
        return Samples(colour, np.full(size, np.inf, dtype=np.float32))

    def parts(self, view, parts):
        return [self.landscape(view, part.window, part.samples) for part in parts]

    def add_shape(self, name, mesh):
        pass

    def close(self):
        pass


ENGINE = Violet()
"""
TRIANGLE = Mesh.of(np.eye(3), (0, 1, 2), (0.5, 0.5, 0.5))
NOON = Illumination(np.array((0.0, 0.0, 1.0)), visibility_m=10_000.0, overcast=0.0)


@pytest.fixture
def glance() -> Scenario:
    """Half a second of a flight with two small cameras."""
    scenario, size = load("s02a_headon"), {"width_px": 160, "height_px": 90}
    cameras = tuple(camera.model_copy(update=size) for camera in scenario.cameras)
    return scenario.model_copy(update={"duration_s": 0.5, "cameras": cameras})


def test_a_renderer_of_another_package_draws_a_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, glance: Scenario
) -> None:
    with installed(tmp_path, monkeypatch, "airhilt.renderers", "violet", VIOLET):
        assert "violet" in FAMILY.names()
        done = run(glance, out=tmp_path / "run", renderer="violet", latency="fixed", speech=False)
        assert replay(done.folder).identical
    info = RunFolder.open(done.folder).info()
    assert (info.options.renderer, info.renderer) == ("violet", "violet")
    picture = next((done.folder / "pictures").glob("start-*.jpg"))
    red, green, blue = np.asarray(Image.open(picture)).mean(axis=(0, 1))
    assert red > 80 > green
    assert blue > red


@pytest.mark.slow
def test_a_replay_without_the_renderer_that_drew_says_so_in_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, glance: Scenario
) -> None:
    with installed(tmp_path, monkeypatch, "airhilt.renderers", "violet", VIOLET):
        done = run(glance, out=tmp_path / "run", renderer="violet", latency="fixed", speech=False)
    (tmp_path / "outside_violet-1.0.dist-info" / "entry_points.txt").unlink()
    with pytest.raises(
        RendererError, match="cannot be replayed here: no renderer named 'violet'"
    ) as caught:
        replay(done.folder)
    assert "\n" not in str(caught.value)


def test_a_renderer_that_does_not_exist_is_refused_with_the_nearest(
    tmp_path: Path, glance: Scenario
) -> None:
    with pytest.raises(AirhiltError, match=r"no renderer named 'embre'.*did you mean 'embree'"):
        run(glance, out=tmp_path / "run", renderer="embre")
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize(
    ("asked", "missing", "taken"),
    [
        (AUTO, (), "embree"),
        (AUTO, ("embree",), "open3d"),
        (FASTEST, (), "moderngl"),
        (FASTEST, ("moderngl",), "embree"),
    ],
)
def test_the_first_of_the_preferred_ones_that_is_installed_draws(
    monkeypatch: pytest.MonkeyPatch, asked: str, missing: tuple[str, ...], taken: str
) -> None:
    load_one = FAMILY.load

    class Found:
        """A renderer that is there, or is not."""

        def __init__(self, name: str) -> None:
            self.name = name

        def open(self, landscape: Mesh, light: Illumination) -> object:
            if self.name in missing:
                raise RendererError(f"{self.name} is not installed")
            return load_one("embree").open(landscape, light)

    monkeypatch.setattr(type(FAMILY), "load", lambda _, name: Found(name))
    name, opened = open_renderer(asked, TRIANGLE, {}, NOON)
    opened.close()
    assert name == taken
