"""A detector behind an address, well and unwell."""

from __future__ import annotations

import base64
import io
import json
import re
from http.server import BaseHTTPRequestHandler
from typing import Any

import numpy as np
import pytest
from PIL import Image

from airhilt.assistant.vision.detector import Found, Shot
from airhilt.assistant.vision.detectors.http import HttpDetector, encode_png
from airhilt.assistant.vision.gating import Gate
from airhilt.errors import VisionError
from airhilt.imaging.masks import Mask
from pictures import background, with_blobs
from services import (
    answering,
    nobody,
    service,
)

PICTURE = with_blobs(background(65, 33), [("airplane", (10, 10, 30, 20))])
TRUCK = {"label": "truck", "confidence": 0.5, "box": [1, 2, 30, 20]}


def ask(url: str, timeout_s: float = 5.0) -> list[Found]:
    return list(HttpDetector(url, timeout_s).detect(PICTURE))


def ask_one_that_says(answer: Any) -> list[Found]:
    data = answer if isinstance(answer, bytes) else json.dumps(answer).encode()
    with service(answering(data)) as url:
        return ask(url)


def test_it_is_given_a_png_and_gives_findings() -> None:
    given: list[tuple[str, bytes]] = []

    def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
        given.append((handler.headers["Content-Type"], body))
        answering(json.dumps({"detections": [TRUCK], "model": "mine"}).encode())(handler, body)

    with service(answer) as url:
        assert ask(url) == [Found("truck", 0.5, (1.0, 2.0, 30.0, 20.0))]
    assert given == [("image/png", encode_png(PICTURE))]


def test_boxes_are_cut_to_the_picture() -> None:
    (found,) = ask_one_that_says({"detections": [TRUCK | {"box": [-3, -1e9, 70, 20]}]})
    assert found.box == (0.0, 0.0, 65.0, 20.0)


class TestServiceThat:
    def test_is_down(self) -> None:
        url = nobody()
        with pytest.raises(VisionError, match=f"detector http: {url} is not there: .*refused"):
            ask(url)

    def test_fails(self) -> None:
        with (
            service(answering(b"no memory", status=500)) as url,
            pytest.raises(VisionError, match="HTTP status 500: 'no memory'"),
        ):
            ask(url)

    @pytest.mark.parametrize(
        ("answer", "problem"),
        [
            (b"\xff\xfe", "Invalid JSON"),
            ({}, "detections: Field required"),
            ({"detections": [TRUCK | {"label": "A dog"}]}, "detections/0/label"),
            ({"detections": [TRUCK | {"confidence": 1.5}]}, "detections/0/confidence"),
            ({"detections": [TRUCK | {"box": [1, 2, float("inf"), 4]}]}, "detections/0/box"),
            ({"detections": [TRUCK] * 1001}, "at most 1000"),
        ],
        ids=str,
    )
    def test_answers_something_else(self, answer: Any, problem: str) -> None:
        with pytest.raises(VisionError, match=f"{problem}.*expected JSON such as"):
            ask_one_that_says(answer)

    @pytest.mark.parametrize("box", [[30, 2, 1, 20], [1, 20, 30, 2]])
    def test_answers_a_box_that_ends_before_it_begins(self, box: list[float]) -> None:
        with pytest.raises(VisionError, match=r"box .*in a picture of 65 by 33 pixels"):
            ask_one_that_says({"detections": [TRUCK | {"box": box}]})


class TestRequestWithoutAnAnswer:
    """The service fails or answers as often as it is told to."""

    def look(self, statuses: str) -> list[str]:
        """Return what becomes of pictures; ``-`` is a request that fails."""
        left = list(statuses)

        def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
            failed = left.pop(0) == "-"
            answering(b'{"detections": []}', status=500 if failed else 200)(handler, body)

        told = []
        with service(answer) as url:
            detector = HttpDetector(url)
            for _ in statuses:
                try:
                    detector.detect(PICTURE)
                    told.append("seen")
                except VisionError as error:
                    told.append("missed" if error.is_passing else f"lost: {error}")
        return told

    def test_costs_the_picture(self) -> None:
        assert self.look("+--+") == ["seen", "missed", "missed", "seen"]

    def test_the_third_in_a_row_ends_it(self) -> None:
        first, second, third = self.look("---")
        assert first == second == "missed"
        assert re.fullmatch(r"lost: detector http: .*HTTP status 500.*\(3 times in a row\)", third)

    def test_an_answer_in_between_begins_the_row_anew(self) -> None:
        assert self.look("--+--+") == ["missed", "missed", "seen"] * 2


class TestOriginOfAPicture:
    """The service is told which camera a picture is of, when it was taken, and the mask."""

    def headers(self, size: tuple[int, int], mask: Mask | None) -> list[dict[str, str]]:
        """Return the headers of the requests about one picture of a camera."""
        given: list[dict[str, str]] = []

        def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
            given.append(dict(handler.headers))
            answering(b'{"detections": []}')(handler, body)

        with service(answer) as url:
            shot = Shot("nose", 1_500_000_000, own_aircraft=mask)
            Gate(HttpDetector(url)).look(shot, background(*size))
        return given

    def test_its_camera_and_time_are_in_the_headers(self) -> None:
        (headers,) = self.headers((64, 48), None)
        assert (headers["X-Camera-Id"], headers["X-Ts-Ms"]) == ("nose", "1500")
        assert headers["X-Offset-Px"] == "0,0"
        assert "X-Mask" not in headers

    def test_the_mask_is_a_picture_of_the_own_aircraft(self) -> None:
        mask = np.zeros((48, 64), dtype=bool)
        mask[40:, 10:50] = True
        (headers,) = self.headers((64, 48), mask)
        decoded = Image.open(io.BytesIO(base64.b64decode(headers["X-Mask"])))
        assert (np.asarray(decoded.convert("1")) == mask).all()

    def test_the_json_of_the_paper_has_the_same(self) -> None:
        given: list[dict[str, Any]] = []

        def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
            given.append(json.loads(body))
            answering(b'\xef\xbb\xbf{"detections": []}')(handler, body)

        mask = np.zeros((48, 64), dtype=bool)
        mask[40:, 10:50] = True
        picture = background(64, 48)
        with service(answer) as url:
            detector = HttpDetector(url.replace("service", "v1/detections"))
            detector.detect_shot(picture, Shot("nose", 1_500_000_000, 5, 7, mask))
            detector.detect(picture)
        told, bare = given
        assert {name: told[name] for name in ("ts_ms", "camera_id", "offset_px")} == {
            "ts_ms": 1500, "camera_id": "nose", "offset_px": [5, 7],
        }  # fmt: skip
        assert base64.b64decode(told["image"]) == encode_png(picture)
        assert base64.b64decode(told["ego_mask"]) == encode_png(mask)
        assert bare["ego_mask"] is None

    def test_a_tile_has_its_own_offset_and_its_part_of_the_mask(self) -> None:
        mask = np.zeros((100, 1300), dtype=bool)
        mask[:, :10] = True
        tiles = self.headers((1300, 100), mask)
        assert len({each["X-Offset-Px"] for each in tiles}) == len(tiles) > 1
        assert [each["X-Offset-Px"] for each in tiles if "X-Mask" in each] == ["0,0"]
