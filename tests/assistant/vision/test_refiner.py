"""The refiner sees places near and wide, and moves boxes to where bodies are."""

from __future__ import annotations

import json
import math
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import strategies as st

from airhilt.assistant.vision.detector import Found
from airhilt.assistant.vision.detectors.embedded import MODEL, EmbeddedDetector
from airhilt.assistant.vision.refiner import (
    VIEW_PX,
    Refiner,
    RefinerCard,
    about,
    views_of,
)
from airhilt.errors import VisionError
from airhilt.messages import Box, VisibleClass

CLASSES = tuple(json.loads(MODEL.with_name("card.json").read_text())["classes"])
ROWS, COLUMNS = 90, 160


@st.composite
def boxes(draw: st.DrawFn) -> Box:
    """Return boxes in a picture or beyond its edges."""
    left, top = draw(st.floats(-40.0, 190.0)), draw(st.floats(-40.0, 120.0))
    return left, top, left + draw(st.floats(1.0, 200.0)), top + draw(st.floats(1.0, 200.0))


def noise() -> np.ndarray:
    return np.random.default_rng(1).integers(60, 200, (ROWS, COLUMNS, 3), dtype=np.uint8)


def detector_in(folder: Path, **refiner: Any) -> Path:
    """Return a copy of the detector with changes to what its card says of the refiner."""
    for network in MODEL.parent.glob("*.onnx"):
        shutil.copy(network, folder)
    card = json.loads(MODEL.with_name("card.json").read_text())
    plain = {"logit": 1.0, "size": 0.0, "size_squared": 0.0, "logit_and_size": 0.0}
    card |= {"calibration": plain, "refiner": card["refiner"] | refiner}
    (folder / "card.json").write_text(json.dumps(card))
    return folder / "detector.onnx"


def look(classes: Sequence[VisibleClass] = CLASSES, **card: Any) -> Refiner:
    """Return the refiner that ships, with changes to its card."""
    shipped = json.loads(MODEL.with_name("card.json").read_text())["refiner"]
    return Refiner(RefinerCard.model_validate(shipped | card), MODEL.parent, classes)


@pytest.mark.parametrize("side", [6.0, 20.0, 45.0])
@pytest.mark.parametrize("place", [(0.0, 0.0), (60.0, 30.0), (100.0, 30.0)])
def test_what_is_in_the_box_is_in_the_middle_of_both_views(
    side: float, place: tuple[float, float]
) -> None:
    picture = np.zeros((ROWS, COLUMNS, 3), dtype=np.uint8)
    left, top = place
    picture[int(top) : int(top + side), int(left) : int(left + side)] = 255
    near, wide = views_of(picture, [(left, top, left + side, top + side)])[0, ..., 0]
    middle = slice(VIEW_PX // 2 - 1, VIEW_PX // 2 + 1)
    assert (near[middle, middle] > 250).all()
    assert (wide[middle, middle] > 250).all()
    assert near[-1, -1] == wide[-1, -1] == 0
    assert (near > 127).mean() > (wide > 127).mean()


def test_a_view_is_as_sharp_as_the_picture_where_its_pixels_are_the_same() -> None:
    picture = noise()
    middle_x, middle_y = 80.0, 45.0
    # Such a box has a near view of just `VIEW_PX` pixels.
    half = VIEW_PX / 1.7 / 2.0
    box = middle_x - half, middle_y - half, middle_x + half, middle_y + half
    near = views_of(picture, [box])[0, 0]
    half_px = VIEW_PX // 2
    assert np.array_equal(near, picture[45 - half_px : 45 + half_px, 80 - half_px : 80 + half_px])


def test_what_is_known_of_a_place_is_its_score_its_size_and_its_shape() -> None:
    known = about([(10.0, 10.0, 74.0, 26.0)], [0.75])
    assert known[0] == pytest.approx((math.log(3.0), 1.0, 2.0))


def place(left: float, top: float, score: float = 0.5) -> Found:
    return Found("airplane", score, (left, top, left + 30.0, top + 12.0))


def test_each_place_is_judged_by_itself() -> None:
    places = [place(10.0, 10.0), place(0.0, 0.0, 0.2), place(120.0, 70.0, 0.9)]
    together = look().judge(noise(), places)
    alone = look().judge(noise(), places[1:2])
    assert together[1].label == alone[0].label
    assert together[1].confidence == pytest.approx(alone[0].confidence, abs=1e-5)
    assert together[1].box == pytest.approx(alone[0].box, abs=1e-3)
    assert look().judge(noise(), []) == []


def test_only_likely_places_are_looked_at_and_only_so_many() -> None:
    found = [place(0.0, 0.0, score) for score in (0.9, 0.5, 0.3, 0.2)]
    assert look(least_score=0.25, most=9).places(found, 640 * 360) == found[:3]
    assert look(least_score=0.25, most=1).places(found, 320 * 180) == found[:1]
    assert look(least_score=0.25, most=1).places(found, 2 * 640 * 360) == found[:2]


def test_the_refiner_has_the_last_word(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It decides class, confidence and place. A box is cut at the picture's edge; twins are one."""
    proposed = [place(20.0, 20.0, 0.9), place(60.0, 20.0, 0.8), place(100.0, 20.0, 0.7)]
    judged = [
        Found("deer", 0.6, (-5.0, 10.0, 25.0, 30.0)),
        Found("truck", 0.9, (0.0, 10.0, 26.0, 30.0)),
        Found("bird", 0.8, (300.0, 10.0, 320.0, 30.0)),
    ]
    asked = []

    def judge(_: Refiner, __: np.ndarray, places: list[Found]) -> list[Found]:
        asked.append(places)
        return judged

    monkeypatch.setattr(EmbeddedDetector, "proposed", lambda *_: proposed)
    monkeypatch.setattr(Refiner, "judge", judge)
    detector = EmbeddedDetector(detector_in(tmp_path), threshold=0.0)
    assert detector.detect(noise()) == [
        Found("truck", cast(Any, pytest.approx(0.9)), (0.0, 10.0, 26.0, 30.0)),
    ]
    assert asked == [proposed]
    assert {one.label for one in detector.uncalibrated(noise())} == {"deer", "truck"}


def test_without_a_refiner_the_first_has_the_last_word(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = detector_in(tmp_path)
    card = json.loads((tmp_path / "card.json").read_text())
    (tmp_path / "card.json").write_text(json.dumps(card | {"refiner": None}))
    proposed = [place(20.0, 20.0, 0.9), place(21.0, 20.0, 0.8)]
    monkeypatch.setattr(EmbeddedDetector, "proposed", lambda *_: proposed)
    found = EmbeddedDetector(path, threshold=0.0).detect(noise())
    assert [one.box for one in found] == [one.box for one in proposed]


@pytest.mark.parametrize("file", ["../refiner.onnx", "/etc/passwd", "refiner.pt", ""])
def test_a_refiner_lies_beside_its_card(tmp_path: Path, file: str) -> None:
    with pytest.raises(VisionError, match=r"card\.json: refiner/file"):
        EmbeddedDetector(detector_in(tmp_path, file=file))


def test_a_network_that_is_no_refiner_is_named(tmp_path: Path) -> None:
    path = detector_in(tmp_path)
    shutil.copy(MODEL, tmp_path / "refiner.onnx")
    with pytest.raises(VisionError, match=r"refiner\.onnx, .* has .*; expected a network of too"):
        EmbeddedDetector(path)
