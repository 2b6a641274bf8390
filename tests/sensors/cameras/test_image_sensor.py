"""A camera's lens, sensor and coder change its pictures as its settings say."""

from __future__ import annotations

import numpy as np
import pytest

from airhilt.imaging.view import Intrinsics
from airhilt.scenario.models import Imaging
from airhilt.sensors.cameras.image_sensor import IDEAL, ImageSensor

LENS = Intrinsics(160, 90, 1.2)
GREY = np.full((90, 160, 3), 128, dtype=np.uint8)
SQUARE = np.zeros_like(GREY)
SQUARE[40:51, 75:86] = 255


def exposed(light: np.ndarray, number: int = 0, **imaging: float) -> np.ndarray:
    return (
        ImageSensor("tower", LENS, IDEAL.model_copy(update=imaging))
        .expose(light, number)
        .astype(float)
    )


def test_an_ideal_camera_changes_nothing() -> None:
    assert np.array_equal(exposed(GREY), GREY)
    assert np.array_equal(exposed(SQUARE), SQUARE)


def test_blur_spreads_light_by_its_deviation_and_loses_none() -> None:
    _, columns = np.mgrid[:90, :160]
    sharp = ((SQUARE[..., 0] / 255.0) * (columns - 80) ** 2).sum() / 11**2
    for blur_px in (0.5, 1.0, 2.0):
        spread = exposed(SQUARE, blur_px=blur_px)[..., 0]
        assert spread.sum() == pytest.approx(255.0 * 11**2, rel=0.02)
        variance = (spread * (columns - 80) ** 2).sum() / spread.sum()
        assert variance - sharp == pytest.approx(blur_px**2, rel=0.2)


def test_light_falls_off_towards_the_corners_by_the_fourth_power_of_the_cosine() -> None:
    seen = exposed(GREY, vignetting=1.0)[..., 0]
    corner = np.hypot(79.5, 44.5) / LENS.focal_px
    fourth = (1.0 / np.sqrt(1.0 + corner**2)) ** 4
    assert seen[45, 80] == pytest.approx(128.0, abs=1.0)
    assert seen[0, 0] == pytest.approx(128.0 * fourth ** (1 / 2.2), abs=1.5)


def test_a_stop_more_is_brighter_and_a_stop_less_darker() -> None:
    dark, bright = (exposed(GREY, exposure_ev=each).mean() for each in (-1.0, 1.0))
    assert dark == pytest.approx(128.0 * 0.5 ** (1 / 2.2), abs=1.0)
    assert bright == pytest.approx(128.0 * 2.0 ** (1 / 2.2), abs=1.0)
    assert exposed(np.full_like(GREY, 255), exposure_ev=2.0).max() == 255.0


def test_noise_differs_from_picture_to_picture_and_the_fixed_pattern_does_not() -> None:
    first, second = (exposed(GREY, number, noise_levels=4.0) for number in (0, 1))
    assert first.std() == pytest.approx(4.0, rel=0.1)
    assert not np.array_equal(first, second)
    assert np.array_equal(first, exposed(GREY, 0, noise_levels=4.0))
    first, second = (exposed(GREY, number, fixed_pattern=0.05) for number in (0, 1))
    assert first.std() == pytest.approx(128.0 * 0.05 / 2.2, rel=0.1)
    assert np.array_equal(first, second)


def test_a_weak_pattern_is_not_made_stronger_by_rounding() -> None:
    """Whole levels add a deviation of 0.29 at most."""
    assert exposed(GREY, fixed_pattern=0.005).std() < 128.0 * 0.005 / 2.2 + 0.1
    assert exposed(GREY, fixed_pattern=0.005).mean() == pytest.approx(128.0, abs=0.05)


def test_two_cameras_have_noise_of_their_own_and_it_does_not_come_back() -> None:
    imaging = Imaging(noise_levels=4.0, fixed_pattern=0.05, vignetting=0.0)
    tower, nose = (ImageSensor(name, LENS, imaging).expose(GREY, 0) for name in ("tower", "nose"))
    assert abs(np.corrcoef(tower.ravel(), nose.ravel())[0, 1]) < 0.05
    sensor = ImageSensor("tower", LENS, Imaging(noise_levels=4.0))
    pictures = {sensor.expose(GREY, number).tobytes() for number in range(300)}
    assert len(pictures) > 290


def test_a_poor_jpeg_is_farther_from_the_picture_than_a_good_one() -> None:
    noise = np.random.default_rng(0).integers(0, 255, GREY.shape).astype(np.uint8)
    poor, good = (np.abs(exposed(noise, jpeg_quality=q) - noise).mean() for q in (20, 95))
    assert good < poor


@pytest.mark.parametrize("blur_px", [0.0, 0.5, 1.3])
def test_a_picture_does_not_depend_on_the_one_before(blur_px: float) -> None:
    imaging = IDEAL.model_copy(update={"blur_px": blur_px, "vignetting": 0.5})
    sensor = ImageSensor("tower", LENS, imaging)
    draws = np.random.default_rng(0)
    light = GREY.copy()
    for first, rows in ((0, 90), (0, 2), (40, 5), (88, 2), (30, 0)):
        light[first : first + rows] = draws.integers(0, 256, (rows, 160, 3))
        alone = ImageSensor("tower", LENS, imaging)
        assert np.array_equal(sensor.expose(light, 0), alone.expose(light, 0))
