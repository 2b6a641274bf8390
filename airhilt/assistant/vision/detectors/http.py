"""A detector behind an address: a PNG picture goes there, ``{detections: [...]}`` comes back."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from airhilt.assistant.vision.detector import Found, Picture, PictureMissed
from airhilt.engines import Engine
from airhilt.errors import VisionError, first_problem
from airhilt.imaging.boxes import area
from airhilt.messages import Box, Confidence, VisibleClass
from airhilt.services import USAGE, HttpService, is_service

TIMEOUT_S = 10.0
MAXIMUM_BYTES = 1_000_000
"""Of one answer."""
MOST_FOUND = 1_000
"""In one picture."""
MOST_FAILURES = 3
"""So many requests in a row without an answer end it."""
PNG_LEVEL = 1
"""Of compression: it goes to the same machine or the next, so fast comes before small."""
RGB8 = (8, 2, 0, 0, 0)
"""Bit depth, colour type, and the only methods of compression, filter and interlace that suit."""
SUB = b"\x01"
"""Filter of a row: each pixel less the one before it."""


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

    A request without an answer costs one picture, and `MOST_FAILURES` of them in a row end it; an
    answer that is none ends it at once.
    """

    name = "http"
    threshold = 0.0

    def __init__(self, url: str, timeout_s: float = TIMEOUT_S) -> None:
        self._service = HttpService("detector http", url, timeout_s, MAXIMUM_BYTES, VisionError)
        self._failures = 0
        """Since the last answer."""

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
        """Return what was found, cut to the picture: of what lies beside it nothing is left."""
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
    """Return a picture as PNG (W3C, Portable Network Graphics, 2nd ed.)."""
    rows, columns = picture.shape[:2]
    filtered = picture.copy()
    filtered[:, 1:] -= picture[:, :-1]
    lines = b"".join(SUB + row.tobytes() for row in filtered)
    return b"".join(
        (
            b"\x89PNG\r\n\x1a\n",
            _chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, *RGB8)),
            _chunk(b"IDAT", zlib.compress(lines, PNG_LEVEL)),
            _chunk(b"IEND", b""),
        )
    )


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


ENGINE = Engine(
    name="http",
    summary="service that takes PNG and answers JSON",
    create=HttpDetector,
    takes=is_service,
    usage=USAGE,
)
