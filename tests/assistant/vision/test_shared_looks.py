"""Looks that runs share by the content of pictures."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from airhilt.assistant.vision.detector import Found, Picture, Shot
from airhilt.assistant.vision.detectors.embedded import EmbeddedDetector
from airhilt.assistant.vision.gating import Gate, SeenPicture
from airhilt.assistant.vision.shared_looks import Reproducible, SharedLooks
from airhilt.assistant.vision.tiling import Tile
from pictures import BlobDetector, background, with_blobs

PLACES = [(40, 30, 70, 42), (60, 36, 90, 48), (60, 36, 90, 48), (110, 60, 150, 76), (9, 9, 40, 20)]
SCENES = [with_blobs(background(192, 128), [("airplane", place)]) for place in PLACES]


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "airhilt" / "detections"


class Counting:
    """Finds the brightest pixel, and counts how often it is asked."""

    name, threshold = "counting", 0.5

    def __init__(self, identity: str = "one") -> None:
        self.identity = [identity]
        self.asked = 0

    def detect(self, picture: Picture) -> Sequence[Found]:
        return self.detect_in(picture, Tile(0, 0, *picture.shape[:2]), Shot("", 0))

    def detect_in(self, picture: Picture, part: Tile, shot: Shot) -> Sequence[Found]:
        self.asked += 1
        pixels = part.of(picture).sum(axis=2)
        row, column = np.unravel_index(pixels.argmax(), pixels.shape)
        left, top = float(column + part.left), float(row + part.top)
        return [Found("bird", 1.0 / 3.0, (left, top, left + 0.1, top + 0.3))]


class Camera:
    """Sends pictures whose pixels are made when somebody reads them, and counts that."""

    def __init__(self) -> None:
        self.made = 0

    def picture(self, pixels: Picture) -> SeenPicture:
        def make() -> Picture:
            self.made += 1
            return pixels

        digest = hashlib.sha256(pixels.tobytes()).hexdigest()
        rows, columns, colours = pixels.shape
        return SeenPicture((rows, columns, colours), digest, make, is_made=False)


def looks_at(
    pictures: Sequence[Picture], detector: Reproducible, camera: Camera | None = None
) -> list[list[Found]]:
    """Return what a gate with shared looks finds."""
    camera, gate = camera or Camera(), Gate(detector, SharedLooks(detector))
    return [gate.look_at(Shot("tower", 0), camera.picture(each)) for each in pictures]


def unshared(pictures: Sequence[Picture]) -> list[list[Found]]:
    gate = Gate(Counting())
    return [gate.look(Shot("tower", 0), each) for each in pictures]


def test_pictures_that_were_looked_at_need_neither_detector_nor_pixels() -> None:
    first = looks_at(SCENES, Counting())
    again, camera = Counting(), Camera()
    assert looks_at(SCENES, again, camera) == first == unshared(SCENES)
    assert (again.asked, camera.made) == (0, 0)


@pytest.mark.parametrize("common", range(len(SCENES)))
def test_a_run_that_leaves_the_others_finds_what_it_would_have_found_alone(common: int) -> None:
    own = [with_blobs(scene, [("truck", (150, 90, 170, 100))]) for scene in SCENES[common:]]
    looks_at(SCENES, Counting())
    pictures = [*SCENES[:common], *own]
    assert looks_at(pictures, Counting()) == unshared(pictures)


@pytest.mark.parametrize(
    ("pictures", "detector"),
    [
        ([SCENES[3]], Counting()),
        ([SCENES[0]], Counting("another")),
        ([SCENES[0].reshape(192, 128, 3)], Counting()),
        (SCENES[:2], Counting()),
    ],
    ids=["pixels", "detector", "shape", "another before it"],
)
def test_another_look_is_taken(pictures: Sequence[Picture], detector: Counting) -> None:
    looks_at([SCENES[0]], Counting())
    looks_at([SCENES[1]], Counting())
    looks_at(pictures, detector)
    assert detector.asked > 0


def test_a_long_row_of_pictures_is_put_together_from_few_of_them() -> None:
    """A body crosses the picture: only what later looks have left of it is read again."""
    field = background(640, 64)
    crossing = [
        with_blobs(field, [("truck", (left, 20, left + 12, 30))]) for left in range(0, 600, 2)
    ]
    looks_at(crossing, Counting())
    camera = Camera()
    pictures = [*crossing, with_blobs(crossing[-1], [("bird", (10, 10, 16, 14))])]
    assert looks_at(pictures, Counting(), camera) == unshared(pictures)
    assert 1 < camera.made < 60


def test_a_detector_that_may_answer_differently_is_not_shared() -> None:
    """A service may change; only a detector that says what it depends on is asked once."""
    assert not isinstance(BlobDetector(), Reproducible)


def test_with_the_embedded_detector_all_pictures_of_a_camera_have_the_same_in_them() -> None:
    """Windows about changes too: the second time nothing is looked at, and all is the same."""
    gate = Gate(EmbeddedDetector(threshold=0.0))
    plain = [gate.look(Shot("tower", 0), each) for each in SCENES]
    assert looks_at(SCENES, EmbeddedDetector(threshold=0.0)) == plain
    camera = Camera()
    assert looks_at(SCENES, EmbeddedDetector(threshold=0.0), camera) == plain
    assert camera.made == 0
    assert any(plain)
