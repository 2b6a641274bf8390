"""The world behind a camera is drawn anew where it has moved, and only there."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

from airhilt.imaging.view import Intrinsics, Pose, View, Window
from airhilt.sensors.cameras.renderers import Part, Samples
from airhilt.sensors.cameras.scene.background import KEPT_PX, SOON_PX, Background
from airhilt.shapes.mesh import Mesh

LENS = Intrinsics(320, 180, math.radians(60.0))
HIGH_M = 3000.0


class Plain:
    """A renderer of an endless plain, which remembers what it was asked for."""

    def __init__(self) -> None:
        self.windows: list[Window] = []

    def landscape(self, view: View, window: Window, samples: int = 1) -> Samples:
        self.windows.append(window)
        down = view.directions(*view.sample_places(window, samples))[2]
        with np.errstate(divide="ignore"):
            away = np.where(down < 0.0, -view.pose.position_m[2] / down, np.inf)
        return Samples(np.zeros((*down.shape, 3), dtype=np.uint8), away.astype(np.float32))

    def parts(self, view: View, parts: Sequence[Part]) -> list[Samples]:
        raise NotImplementedError

    def add_shape(self, name: str, mesh: Mesh) -> None:
        raise NotImplementedError

    def close(self) -> None:
        raise NotImplementedError


def at(north_m: float, up_m: float = HIGH_M, heading_rad: float = 0.0) -> View:
    return View(LENS, Pose.of((0.0, north_m, up_m), heading_rad))


@pytest.fixture
def plain() -> Plain:
    return Plain()


@pytest.fixture
def background(plain: Plain) -> Background:
    looking = Background(plain, samples=1)
    looking.look(at(0.0))
    plain.windows.clear()
    return looking


def test_a_step_that_moves_nothing_by_half_a_pixel_keeps_it(
    plain: Plain, background: Background
) -> None:
    background.look(at(10.0))
    assert not plain.windows


def test_a_long_way_brings_the_near_ground_anew_and_neither_sky_nor_horizon(
    plain: Plain, background: Background
) -> None:
    background.look(at(60.0))
    (window,) = plain.windows
    assert window.bottom == LENS.height_px
    assert window.top > LENS.height_px / 2


def test_what_would_be_drawn_soon_is_drawn_with_the_first(
    plain: Plain, monkeypatch: pytest.MonkeyPatch
) -> None:
    def drawn(soon_px: float) -> tuple[int, int]:
        """Return how often it draws on a way, and how many rows in all."""
        monkeypatch.setattr("airhilt.sensors.cameras.scene.background.SOON_PX", soon_px)
        flying = Background(plain, samples=1)
        plain.windows.clear()
        for step in range(120):
            flying.look(at(3.0 * step))
        return flying.drawn, sum(window.height for window in plain.windows)

    (one_by_one, their_rows), (together, rows) = drawn(KEPT_PX), drawn(SOON_PX)
    assert together < 0.6 * one_by_one
    assert rows < 1.5 * their_rows


def test_a_small_turn_brings_all_anew(plain: Plain, background: Background) -> None:
    background.look(at(0.0, heading_rad=0.002))
    assert plain.windows == [at(0.0).whole]


def test_a_large_picture_is_drawn_in_parts_of_moderate_size(plain: Plain) -> None:
    lens = Intrinsics(4096, 1000, math.radians(60.0))
    background = Background(plain, samples=3)
    background.look(View(lens, at(0.0).pose))
    assert max(9 * window.area for window in plain.windows) <= 2_500_000
    assert sum(window.area for window in plain.windows) == 4096 * 1000
    assert np.isfinite(background.distance_m[-1]).all()
