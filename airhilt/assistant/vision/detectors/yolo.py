"""Detectors of ultralytics: YOLOv10 and later, from a file that the user has.

The package is under the AGPL and no part of AIRHILT; the extra ``yolo`` installs it. Loading a
``.pt`` file runs code that is in it.
"""

from __future__ import annotations

import ast
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from airhilt.assistant.vision.detector import Found, Picture
from airhilt.assistant.vision.detectors.embedded import has_card
from airhilt.engines import Engine, Package
from airhilt.errors import VisionError, first_line
from airhilt.host.onnx import open_network, require_end
from airhilt.messages import VisibleClass

LABELS: Mapping[str, VisibleClass] = {
    "airplane": "airplane",
    "truck": "truck",
    "car": "truck",
    "bus": "truck",
    "bird": "bird",
    "deer": "deer",
    "coyote": "coyote",
}
"""Labels by the names that models give their classes: COCO's, and two that others have.

Findings of other classes, such as a dog or a horse, are dropped."""
LEAST_CONFIDENCE = 0.1
"""Findings with less are not reported (``track_low_thresh`` of ultralytics' trackers)."""
THRESHOLD = 0.25
"""Findings with less only continue tracks (``conf`` of ultralytics' predictions)."""
MOST_FOUND = 300
STRIDE_PX = 32
TRIAL_PX = 320
"""Side of the picture with which a network that takes any is tried, in pixels."""
EXPECTED = "a model for detection of ultralytics, .pt or .onnx"
ENVIRONMENT = {"YOLO_OFFLINE": "true", "YOLO_AUTOINSTALL": "false", "YOLO_VERBOSE": "false"}
"""Variables with which ultralytics neither loads nor installs nor prints anything.

It reads them when it is imported, and when it looks for a network."""
LITERALS = ("args", "imgsz", "kpt_names", "kpt_shape", "names")
"""Metadata of an ``.onnx`` file that ultralytics reads as Python; versions 8.3 may run it."""


class YoloDetector:
    """Detects with a YOLO model, at the resolution of the picture if the model takes any.

    Parameters
    ----------
    path
        A ``.pt`` file, which is code that runs when it is loaded, or an ``.onnx`` file.

    Raises
    ------
    VisionError
        The file or the package is missing, the file does not load, or AIRHILT knows none of its
        classes.
    """

    def __init__(self, path: Path) -> None:
        if not path.is_file():
            raise VisionError(
                f"detector yolo: {path}: no such file; expected {EXPECTED} (nothing is downloaded)"
            )
        if path.suffix not in (".pt", ".onnx"):
            raise VisionError(f"detector yolo: {path}: expected {EXPECTED}")
        self.name = f"yolo:{path.stem}"
        self.threshold = THRESHOLD
        self._path = path
        self._sides_px = _fixed_sides(path) if path.suffix == ".onnx" else None
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
        self._labels = {
            index: LABELS[name.lower()] for index, name in names.items() if name.lower() in LABELS
        }
        if not self._labels:
            known = ", ".join(list(names.values())[:5])
            raise VisionError(
                f"detector yolo: {path}: it knows {len(names)} classes ({known}...); expected at "
                f"least one of {', '.join(LABELS)}"
            )

    def detect(self, picture: Picture) -> Sequence[Found]:
        """Return what is in a picture; see `Detector.detect`."""
        free = tuple(-(-side // STRIDE_PX) * STRIDE_PX for side in picture.shape[:2])
        try:
            boxes = self._model.predict(
                np.ascontiguousarray(picture[..., ::-1]),  # It wants BGR.
                imgsz=self._sides_px or free,
                conf=LEAST_CONFIDENCE,
                classes=list(self._labels),
                max_det=MOST_FOUND,
                device="cpu",
                verbose=False,
            )[0].boxes
            rows = zip(
                boxes.cls.int().tolist(), boxes.conf.tolist(), boxes.xyxy.tolist(), strict=True
            )
            return [
                Found(self._labels[index], confidence, (left, top, right, bottom))
                for index, confidence, (left, top, right, bottom) in rows
                if left < right and top < bottom  # Others lie where the picture was padded.
            ]
        except Exception as error:  # torch's and onnxruntime's share no base
            raise VisionError(f"detector yolo: {self._path}: failed: {first_line(error)}") from None


def _load(path: Path) -> Any:
    os.environ.update(ENVIRONMENT)
    from ultralytics import YOLO

    return YOLO(path, task="detect") if path.suffix == ".onnx" else YOLO(path)


def _fixed_sides(path: Path) -> tuple[int, int] | None:
    """Return rows and columns of the pictures that a network takes; None if it takes any."""
    session = open_network(path, f"detector yolo: {path}", EXPECTED, VisionError)
    metadata = session.get_modelmeta().custom_metadata_map
    for name in LITERALS:
        try:
            ast.literal_eval(metadata.get(name, "None"))
        except (ValueError, SyntaxError, MemoryError, RecursionError):
            raise VisionError(
                f"detector yolo: {path}: its metadata {name!r} is no plain value, and may be code; "
                f"expected {EXPECTED}"
            ) from None
    port, sides = session.get_inputs()[0], None
    match port.shape:
        case [_, _, int(rows), int(columns)]:
            sides = rows, columns
        case [_, _, _, _]:
            pass
        case shape:
            raise VisionError(f"detector yolo: {path}: takes {shape}; expected {EXPECTED}")
    channels = port.shape[1] if isinstance(port.shape[1], int) else 3
    number = np.float16 if port.type == "tensor(float16)" else np.float32
    trial = np.zeros((1, channels, *(sides or (TRIAL_PX, TRIAL_PX))), number)
    require_end(session, {port.name: trial}, f"detector yolo: {path}", VisionError)
    return sides


def _is_model(path: Path) -> bool:
    return path.suffix == ".pt" or (path.suffix == ".onnx" and not has_card(path))


ENGINE = Engine(
    name="yolo",
    summary="YOLO by ultralytics, .pt or .onnx",
    create=lambda file: YoloDetector(Path(file)),
    argument="FILE",
    is_argument_required=True,
    takes=lambda text: _is_model(Path(text)),
    requires=(Package("ultralytics", extra="yolo"),),
)
