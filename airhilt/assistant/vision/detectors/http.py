"""A detector at an address: it takes a picture and answers ``{detections: [...]}``."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from urllib.parse import urlsplit

import numpy as np
from PIL import Image

from airhilt.assistant.vision.detector import Found, Picture, Shot
from airhilt.assistant.vision.service_messages import (
    DetectionAnswer,
    FoundObject,
    PictureRequest,
)
from airhilt.assistant.vision.tiling import Tile
from airhilt.engines import Engine
from airhilt.errors import VisionError
from airhilt.host.service_headers import ServiceHeaders
from airhilt.host.services import USAGE, HttpService, is_service, key_of
from airhilt.imaging.boxes import area
from airhilt.imaging.masks import Mask
from airhilt.units import MILLISECOND_NS

JSON_PATH = "/detections"
"""End of the path of services that take the JSON of the AIRHILT paper."""
KEY_VARIABLE = "AIRHILT_DETECTOR_KEY"
"""Environment variable with the key of the service; it is sent, and written nowhere."""
TIMEOUT_S = 10.0
MAXIMUM_BYTES = 1_000_000
"""Size of the largest answer."""
EXPECTED = (
    'JSON such as {"detections": [{"label": "airplane", "confidence": 0.9, '
    '"box": [10, 20, 40, 30]}]}'
)
PNG_LEVEL = 1
"""Compression: pictures go to the same machine or the next, so fast comes before small."""
PROBE = np.zeros((48, 64, 3), np.uint8)
"""A black picture."""


class HttpDetector:
    """Asks a service about each picture.

    A path that ends with `JSON_PATH` gets a `PictureRequest`, any other a PNG, 8-bit sRGB, with the
    same in `ServiceHeaders`. The answer is a `DetectionAnswer`, boxes in pixels: left, top, right,
    bottom.

    Attributes
    ----------
    looks_at_windows
        True if the last answer says that the service looks at windows of pictures.
    """

    name = "http"

    def __init__(self, url: str, timeout_s: float = TIMEOUT_S) -> None:
        self.threshold = 0.0
        self.looks_at_windows = False
        key = key_of(KEY_VARIABLE, "detector http", VisionError)
        self._service = HttpService(
            "detector http", url, timeout_s, MAXIMUM_BYTES, VisionError, key
        )
        self._takes_json = urlsplit(url).path.endswith(JSON_PATH)

    def detect(self, picture: Picture) -> Sequence[Found]:
        """Return what the service finds in a picture; see `Detector.detect`."""
        return self.detect_shot(picture, Shot("", 0))

    def detect_shot(self, picture: Picture, shot: Shot) -> Sequence[Found]:
        """Return what the service finds in a picture, and tell it where that comes from."""
        return self._found(picture, shot)

    def probe(self) -> None:
        """Let it look at a black picture.

        Raises
        ------
        VisionError
            There is no service, or its answer is none.
        """
        self.detect(PROBE)

    def _found(self, picture: Picture, shot: Shot, window: Tile | None = None) -> Sequence[Found]:
        png, own = encode_png(picture), shot.own_aircraft
        mask = None if own is None or not own.any() else base64.b64encode(encode_png(own)).decode()
        ts_ms = shot.t_frame_ns // MILLISECOND_NS
        headers = ServiceHeaders(ts_ms=ts_ms, camera_id=shot.camera)
        if self._takes_json:
            request = PictureRequest(
                image=base64.b64encode(png).decode(),
                ts_ms=ts_ms,
                camera_id=shot.camera,
                offset_px=(shot.left, shot.top),
                ego_mask=mask,
                window_px=None if window is None else window.box,
            )
            body, content_type = request.model_dump_json().encode(), "application/json"
        else:
            at = f"{shot.left},{shot.top}"
            headers = headers.model_copy(update={"offset_px": at, "mask": mask})
            body, content_type = png, "image/png"
        with self._service.attempt():
            data = self._service.post(body, content_type, headers.encoded())
            answer = self._service.parsed(data, DetectionAnswer, EXPECTED)
            placed = [self._placed(each, picture) for each in answer.detections]
        self.threshold = answer.threshold
        self.looks_at_windows = self._takes_json and answer.looks_at_windows
        return [found for found in placed if area(found.box)]

    def _placed(self, each: FoundObject, picture: Picture) -> Found:
        rows, columns = picture.shape[:2]
        left, top, right, bottom = each.box
        if left > right or top > bottom:
            raise self._service.error(
                f"answered the box {list(each.box)}",
                f"left, top, right and bottom in a picture of {columns} by {rows} pixels",
            )
        box = (max(left, 0.0), max(top, 0.0), min(right, float(columns)), min(bottom, float(rows)))
        return Found(each.label, each.confidence, box)


class HttpPartsDetector(HttpDetector):
    """Asks a service that looks at windows of pictures."""

    def detect_in(self, picture: Picture, part: Tile, shot: Shot) -> Sequence[Found]:
        """Return what the service finds in a part; see `airhilt.assistant.vision.gating`."""
        return self._found(picture, shot, part)


def detector_at(url: str) -> HttpDetector:
    """Return the detector that asks a service for what it can.

    Raises
    ------
    VisionError
        There is no service, or its answer is none.
    """
    asked = HttpDetector(url)
    asked.probe()
    if not asked.looks_at_windows:
        return asked
    detector = HttpPartsDetector(url)
    detector.threshold = asked.threshold
    return detector


def encode_png(picture: Picture | Mask) -> bytes:
    """Return a picture, or a mask in black and white, as PNG."""
    png = io.BytesIO()
    Image.fromarray(picture).save(png, "PNG", compress_level=PNG_LEVEL)
    return png.getvalue()


ENGINE = Engine(
    name="http",
    summary="service that takes PNG or JSON and answers JSON",
    create=detector_at,
    takes=is_service,
    usage=USAGE,
    is_remote=True,
)
