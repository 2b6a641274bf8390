"""Detections that runs share by the content of pictures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

from airhilt.assistant.vision.detector import Detector, Found, Picture, Shot
from airhilt.assistant.vision.detectors.embedded import EmbeddedDetector
from airhilt.assistant.vision.gating import Gate
from airhilt.assistant.vision.shared_detections import SharedDetector, shared
from airhilt.assistant.vision.tiling import Tile
from airhilt.caches import cache_folder
from pictures import BlobDetector, background, with_blobs


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
        self.asked += 1
        row, column = np.unravel_index(picture.sum(axis=2).argmax(), picture.shape[:2])
        return [Found("bird", 1.0 / 3.0, (float(column), float(row), column + 0.1, row + 0.3))]

    def detect_in(self, picture: Picture, part: Tile) -> Sequence[Found]:
        return self.detect(part.of(picture))


def picture(seed: int) -> Picture:
    return background(96, 64, seed)


def test_a_picture_is_looked_at_once_whoever_asks() -> None:
    detectors = Counting(), Counting()
    answers = [SharedDetector(each).detect(picture(1)) for each in (*detectors, detectors[0])]
    assert answers[0] == answers[1] == answers[2] == Counting().detect(picture(1))
    assert [each.asked for each in detectors] == [1, 0]


@pytest.mark.parametrize(
    "ask",
    [
        lambda: SharedDetector(Counting()).detect(picture(2)),
        lambda: SharedDetector(Counting("another")).detect(picture(1)),
        lambda: SharedDetector(Counting()).detect_in(picture(1), Tile(0, 0, 64, 96)),
        lambda: SharedDetector(Counting()).detect(picture(1).reshape(96, 64, 3)),
    ],
    ids=["pixels", "detector", "part", "shape"],
)
def test_other_pixels_parts_and_detectors_have_answers_of_their_own(
    ask: Callable[[], Sequence[Found]],
) -> None:
    SharedDetector(Counting()).detect(picture(1))
    before = entries()
    ask()
    assert entries() == before + 1


def entries() -> int:
    return len(list((cache_folder() / "detections").iterdir()))


def test_a_damaged_answer_is_asked_for_again(cache: Path) -> None:
    SharedDetector(Counting()).detect(picture(1))
    (entry,) = cache.iterdir()
    entry.write_bytes(entry.read_bytes()[:-1])
    again = Counting()
    assert SharedDetector(again).detect(picture(1)) == Counting().detect(picture(1))
    assert again.asked == 1


def test_a_detector_that_may_answer_differently_is_not_shared() -> None:
    """A service may change; only a detector that says what it depends on is asked once."""
    detector = BlobDetector()
    assert shared(detector) is detector


def test_with_the_embedded_detector_all_pictures_of_a_camera_have_the_same_in_them() -> None:
    """Windows about changes too: the second time nothing is looked at, and all is the same."""
    field = background(192, 128)
    places = [(40, 30, 70, 42), (60, 36, 90, 48), (60, 36, 90, 48), (110, 60, 150, 76)]
    pictures = [with_blobs(field, [("airplane", place)]) for place in places]

    def seen(detector: Detector) -> list[list[Found]]:
        gate = Gate(detector)
        return [gate.look(Shot("tower", 0), each) for each in pictures]

    plain = seen(EmbeddedDetector(threshold=0.0))
    first = seen(shared(EmbeddedDetector(threshold=0.0)))
    kept = entries()
    second = seen(shared(EmbeddedDetector(threshold=0.0)))
    assert plain == first == second
    assert entries() == kept > 0
    assert any(plain)
