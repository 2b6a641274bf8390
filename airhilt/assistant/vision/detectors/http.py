"""A detector at an address: it takes a PNG picture and answers ``{detections: [...]}``."""

from __future__ import annotations

import base64
import io
from collections.abc import Mapping, Sequence

from PIL import Image
from pydantic import BaseModel, ConfigDict, Field

from airhilt.assistant.vision.detector import Found, Picture, PictureMissed, Shot
from airhilt.engines import Engine
from airhilt.errors import VisionError
from airhilt.host.services import USAGE, HttpService, is_service
from airhilt.imaging.boxes import area
from airhilt.imaging.masks import Mask
from airhilt.messages import Box, Confidence, VisibleClass

TIMEOUT_S = 10.0
MAXIMUM_BYTES = 1_000_000
"""Size of the largest answer."""
MOST_FOUND = 1_000
"""Largest number of detections in one picture."""
MOST_FAILURES = 3
"""Number of requests in a row without an answer that end it."""
EXPECTED = (
    'JSON such as {"detections": [{"label": "airplane", "confidence": 0.9, '
    '"box": [10, 20, 40, 30]}]}'
)
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

    Headers say where the picture comes from: ``X-Camera-Id``; ``X-Ts-Ms``, the end of the exposure
    in ms since the start of the run; ``X-Offset-Px``, left and top of the picture in that of the
    camera, such as ``0,0``; and ``X-Mask``, a PNG in base64 that is white where the camera's own
    aircraft may be, if there is such a place.

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
        return self.detect_shot(picture, None)

    def detect_shot(self, picture: Picture, shot: Shot | None) -> Sequence[Found]:
        """Return what the service finds in a picture, and tell it where that comes from."""
        data = self._post(encode_png(picture), {} if shot is None else headers_of(shot))
        answer = self._service.parsed(data, _Answer, EXPECTED)
        placed = [self._placed(each, picture) for each in answer.detections]
        return [found for found in placed if area(found.box)]

    def _post(self, png: bytes, headers: Mapping[str, str]) -> bytes:
        try:
            answer = self._service.post(png, "image/png", headers)
        except VisionError as error:
            self._failures += 1
            if self._failures < MOST_FAILURES:
                raise PictureMissed(str(error)) from None
            lost = VisionError(f"{error} ({MOST_FAILURES} times in a row)")
            lost.is_of_machine = error.is_of_machine
            raise lost from None
        self._failures = 0
        return answer

    def _placed(self, each: _Detection, picture: Picture) -> Found:
        rows, columns = picture.shape[:2]
        left, top, right, bottom = each.box
        if left > right or top > bottom:
            raise self._service.error(
                f"answered the box {list(each.box)}",
                f"left, top, right and bottom in a picture of {columns} by {rows} pixels",
            )
        box = (max(left, 0.0), max(top, 0.0), min(right, float(columns)), min(bottom, float(rows)))
        return Found(each.label, each.confidence, box)


def headers_of(shot: Shot) -> dict[str, str]:
    """Return the headers that tell a service where a picture comes from."""
    headers = {
        "X-Camera-Id": shot.camera,
        "X-Ts-Ms": str(shot.t_frame_ns // 1_000_000),
        "X-Offset-Px": f"{shot.left},{shot.top}",
    }
    if shot.own_aircraft is not None and shot.own_aircraft.any():
        headers["X-Mask"] = base64.b64encode(encode_png(shot.own_aircraft)).decode()
    return headers


def encode_png(picture: Picture | Mask) -> bytes:
    """Return a picture, or a mask in black and white, as PNG."""
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
