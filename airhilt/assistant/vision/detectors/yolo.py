"""Detectors of ultralytics: YOLOv10 and later, from a file that the user has.

The package is under the AGPL and no part of AIRHILT; the extra ``yolo`` installs it. Loading a
``.pt`` file runs code that is in it.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from airhilt.assistant.vision.class_names import ClassMap, DetectorClasses
from airhilt.assistant.vision.detector import Found, Picture
from airhilt.engines import Engine, Package
from airhilt.errors import VisionError, first_line

LEAST_CONFIDENCE = 0.1
"""Findings with less are not reported (``track_low_thresh`` of ultralytics' trackers)."""
THRESHOLD = 0.25
"""Findings with less only continue tracks (``conf`` of ultralytics' predictions)."""
MOST_FOUND = 300
STRIDE_PX = 32
EXPECTED = "a model for detection of ultralytics, .pt (onnx:FILE takes .onnx)"
ENVIRONMENT = {"YOLO_OFFLINE": "true", "YOLO_AUTOINSTALL": "false", "YOLO_VERBOSE": "false"}
"""Variables with which ultralytics neither loads nor installs nor prints anything.

It reads them when it is imported, and when it looks for a network."""


class YoloDetector:
    """Detects with a YOLO model, at the resolution of the picture.

    Parameters
    ----------
    path
        A ``.pt`` file, which is code that runs when it is loaded.
    classes
        Labels by the names of its classes, which go before the known synonyms.

    Raises
    ------
    VisionError
        The file or the package is missing, the file does not load, or AIRHILT knows none of its
        classes.
    """

    def __init__(self, path: Path, classes: Mapping[str, str] | None = None) -> None:
        if not path.is_file():
            raise VisionError(
                f"detector yolo: {path}: no such file; expected {EXPECTED} (nothing is downloaded)"
            )
        if path.suffix != ".pt":
            raise VisionError(f"detector yolo: {path}: expected {EXPECTED}")
        self.name = f"yolo:{path.stem}"
        self.threshold = THRESHOLD
        self._path = path
        try:
            self._model = _load(path)
            names: Mapping[int, str] = self._model.names
        except ImportError as error:
            raise VisionError(
                "detector yolo: the package ultralytics is missing or does not load "
                f"({first_line(error)}); install it with `pip install airhilt[yolo]`"
            ) from None
        except Exception as error:  # torch's, pickle's, onnxruntime's, its own
            raise VisionError(
                f"detector yolo: {path}: does not load: {first_line(error)}; expected {EXPECTED}"
            ) from None
        if self._model.task != "detect":
            raise VisionError(
                f"detector yolo: {path}: its task is {self._model.task!r}; expected {EXPECTED}"
            )
        self.classes = ClassMap.of(names, classes or {}, f"detector yolo: {path}")

    def detect(self, picture: Picture) -> Sequence[Found]:
        """Return what is in a picture; see `Detector.detect`."""
        free = tuple(-(-side // STRIDE_PX) * STRIDE_PX for side in picture.shape[:2])
        try:
            boxes = self._model.predict(
                np.ascontiguousarray(picture[..., ::-1]),  # It wants BGR.
                imgsz=free,
                conf=LEAST_CONFIDENCE,
                classes=list(self.classes.labels),
                max_det=MOST_FOUND,
                device="cpu",
                verbose=False,
            )[0].boxes
            rows = zip(
                boxes.cls.int().tolist(), boxes.conf.tolist(), boxes.xyxy.tolist(), strict=True
            )
            return [
                Found(self.classes.labels[index], confidence, (left, top, right, bottom))
                for index, confidence, (left, top, right, bottom) in rows
                if left < right and top < bottom  # Others lie where the picture was padded.
            ]
        except Exception as error:  # torch's and onnxruntime's share no base
            raise VisionError(f"detector yolo: {self._path}: failed: {first_line(error)}") from None


def _load(path: Path) -> Any:
    os.environ.update(ENVIRONMENT)
    from ultralytics import YOLO

    return YOLO(path)


def _create(file: str, configuration: DetectorClasses | None = None) -> YoloDetector:
    return YoloDetector(Path(file), configuration.classes if configuration else {})


ENGINE = Engine(
    name="yolo",
    summary="YOLO by ultralytics, .pt",
    create=_create,
    argument="FILE",
    is_argument_required=True,
    takes=lambda text: text.endswith(".pt"),
    requires=(Package("ultralytics", extra="yolo"),),
    configuration=DetectorClasses,
)
