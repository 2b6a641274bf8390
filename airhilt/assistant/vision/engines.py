"""The detectors by the names that the command line gives them."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from airhilt.assistant.vision.detector import Detector
from airhilt.errors import VisionError
from airhilt.services import is_service

EXPECTED = "embedded, embedded:FILE.onnx, yolo:FILE, or the address of a service"


class VisionEngine(NamedTuple):
    """A detector, and how it is used."""

    detector: Detector
    threshold: float = 0.0
    """Confidence from which a finding counts by itself."""


def vision_engine(name: str) -> VisionEngine:
    """Return the detector of a name such as ``embedded`` or ``yolo:models/yolov10n.pt``.

    Raises
    ------
    VisionError
        There is none of that name, or it cannot be loaded.
    """
    kind, _, argument = name.partition(":")
    if kind == "embedded":
        from airhilt.assistant.vision.embedded import EmbeddedDetector

        detector = EmbeddedDetector(Path(argument) if argument else None)
        return VisionEngine(detector, detector.threshold)
    if kind == "yolo" and argument:
        from airhilt.assistant.vision.yolo import SURE, YoloDetector

        return VisionEngine(YoloDetector(Path(argument)), SURE)
    if is_service(name):
        from airhilt.assistant.vision.http import HttpDetector

        return VisionEngine(HttpDetector(name))
    raise VisionError(f"detector {name!r}: there is none of that name; expected {EXPECTED}")
