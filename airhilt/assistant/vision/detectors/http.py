"""A detector at an address: it takes a PNG picture and answers ``{detections: [...]}``."""

from __future__ import annotations

import io
from collections.abc import Sequence

from PIL import Image
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from airhilt.assistant.vision.detector import Found, Picture, PictureMissed
from airhilt.engines import Engine
from airhilt.errors import VisionError, first_problem
from airhilt.imaging.boxes import area
from airhilt.messages import Box, Confidence, VisibleClass
from airhilt.services import USAGE, HttpService, is_service

TIMEOUT_S = 10.0
MAXIMUM_BYTES = 1_000_000
"""Size of the largest answer."""
MOST_FOUND = 1_000
"""Largest number of detections in one picture."""
MOST_FAILURES = 3
"""Number of requests in a row without an answer that end it."""
PNG_LEVEL = 1
"""Compression: pictures go to the same machine or the next, so fast comes before small."""


class _Detection(BaseModel):
    model_config = ConfigDict(extra="ignore", allow_inf_nan=False)
    label: VisibleClass
    confidence: Confidence
    box: Box


class _Answer(BaseModel):
    model_config = ConfigDict(extra="ignore", allow_inf_nan=False)
    detections: tuple[_Detection, ...] = Field(max_length=MOST_FOUND)


class HttpDetector:
    """Asks a service that answers POST requests with PNG pictures, 8-bit sRGB.

    The answer is JSON such as ``{"detections": [{"label": "airplane", "confidence": 0.9, "box":
    [10, 20, 40, 30]}]}``, boxes in pixels: left, top, right, bottom.

    A request without an answer loses one picture, and `MOST_FAILURES` of them in a row lose the
    detector; an invalid answer does so at once.
    """

    name = "http"
    threshold = 0.0

    def __init__(self, url: str, timeout_s: float = TIMEOUT_S) -> None:
        self._service = HttpService("detector http", url, timeout_s, MAXIMUM_BYTES, VisionError)
        self._failures = 0
        """Failed requests since the last answer."""

    def detect(self, picture: Picture) -> Sequence[Found]:
        """Return what the service finds in a picture; see `Detector.detect`."""
        answer = self._parse(self._post(encode_png(picture)))
        placed = [self._placed(each, picture) for each in answer.detections]
        return [found for found in placed if area(found.box)]

    def _post(self, png: bytes) -> bytes:
        try:
            answer = self._service.post(png, "image/png")
        except VisionError as error:
            self._failures += 1
            if self._failures < MOST_FAILURES:
                raise PictureMissed(str(error)) from None
            raise VisionError(f"{error} ({MOST_FAILURES} times in a row)") from None
        self._failures = 0
        return answer

    def _placed(self, each: _Detection, picture: Picture) -> Found:
        """Return a detection with its box cut to the picture."""
        rows, columns = picture.shape[:2]
        left, top, right, bottom = each.box
        if left > right or top > bottom:
            raise self._service.error(
                f"answered the box {list(each.box)}",
                f"left, top, right and bottom in a picture of {columns} by {rows} pixels",
            )
        box = (max(left, 0.0), max(top, 0.0), min(right, float(columns)), min(bottom, float(rows)))
        return Found(each.label, each.confidence, box)

    def _parse(self, data: bytes) -> _Answer:
        try:
            return _Answer.model_validate_json(data)
        except ValidationError as error:
            raise self._service.error(
                f"answered {data[:60]!r}: {first_problem(error)}",
                'JSON such as {"detections": [{"label": "airplane", "confidence": 0.9, '
                '"box": [10, 20, 40, 30]}]}',
            ) from None


def encode_png(picture: Picture) -> bytes:
    """Return a picture as PNG."""
    png = io.BytesIO()
    Image.fromarray(picture).save(png, "PNG", compress_level=PNG_LEVEL)
    return png.getvalue()


ENGINE = Engine(
    name="http",
    summary="service that takes PNG and answers JSON",
    create=HttpDetector,
    takes=is_service,
    usage=USAGE,
    is_remote=True,
)
