"""Detectors that people bring as ONNX files: YOLO, YOLOX, RT-DETR, DETR and SSD.

The family is recognised by inputs and outputs (`airhilt.assistant.vision.network_outputs`). Names
of classes are in the file's metadata, or beside it.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import onnxruntime
from PIL import Image

from airhilt.assistant.vision.class_names import COCO, COCO_BY_ID, ClassMap, DetectorClasses
from airhilt.assistant.vision.detector import Found, Picture, once
from airhilt.assistant.vision.detectors.embedded import has_card
from airhilt.assistant.vision.network_outputs import EXPECTED, Family, Sides, family_of
from airhilt.engines import Engine
from airhilt.errors import VisionError, first_line
from airhilt.host.files import read_file
from airhilt.host.onnx import first_look, open_network
from airhilt.imaging.boxes import area, within

LEAST_CONFIDENCE = 0.1
"""Findings with less are not reported (``track_low_thresh`` of ultralytics' trackers)."""
MOST_FOUND = 300
STRIDE_PX = 32
TRIAL_PX = 320
"""Side of the picture with which a network that takes any is tried, in pixels."""
GREY = 114
"""Level of padding, as ultralytics and YOLOX have it."""
MEAN = np.array((0.485, 0.456, 0.406), np.float32)
DEVIATION = np.array((0.229, 0.224, 0.225), np.float32)
"""Mean and standard deviation of ImageNet's pictures, in red, green and blue (torchvision)."""
LARGEST_NAMES_BYTES = 1_000_000
NUMBERS: Mapping[str, Any] = {
    "tensor(float)": np.float32,
    "tensor(float16)": np.float16,
    "tensor(uint8)": np.uint8,
}


class OnnxDetector:
    """Detects with a network of any known family.

    Parameters
    ----------
    classes
        Labels by the names of its classes, which go before the known synonyms.

    Raises
    ------
    VisionError
        The file is missing, is no such network, or has no class that counts.
    """

    def __init__(self, path: Path, classes: Mapping[str, str] | None = None) -> None:
        self.name = f"onnx:{path.stem}"
        self._subject = subject = f"detector onnx: {path}"
        self._network = open_network(path, subject, EXPECTED, VisionError)
        self._port, *self._others = self._network.get_inputs()
        self._names = [port.name for port in self._network.get_outputs()]
        self._is_last, self._sides = self._axes()
        names = _names_of(path, self._network, subject)
        sides = self._sides or (TRIAL_PX, TRIAL_PX)
        self._colours = "unit"
        answer = self._answer(np.full((*sides, 3), GREY, np.uint8), is_trial=True)
        inputs = [self._port.name, *(port.name for port in self._others)]
        family = family_of(inputs, answer, sides, len(names))
        if family is None:
            told = ", ".join(f"{name!r} {list(each.shape)}" for name, each in answer.items())
            raise VisionError(f"{subject}: gives {told}; expected {EXPECTED}")
        self._family = family
        self._colours = family.colours
        self.threshold = family.threshold
        self.classes = ClassMap.of(self._numbered(family, names), classes or {}, subject)

    def detect(self, picture: Picture) -> Sequence[Found]:
        """Return what is in a picture; see `Detector.detect`."""
        rows, columns = picture.shape[:2]
        if not rows or not columns:
            raise VisionError(
                f"{self._subject}: a picture of {columns} by {rows} pixels; expected 1 by 1 or more"
            )
        try:
            fitted, used = self._fitted(picture)
            found = self._family.read(self._answer(fitted), fitted.shape[:2])
        except VisionError:
            raise
        except Exception as error:  # onnxruntime raises classes of its own that share no base
            raise VisionError(f"{self._subject}: failed: {first_line(error)}") from None
        scale = np.array((columns, rows, columns, rows)) / np.tile(used, 2)
        order = np.argsort(-found.scores, kind="stable")
        told = []
        for index in order[found.scores[order] >= LEAST_CONFIDENCE].tolist():
            label = self.classes.labels.get(int(found.numbers[index]))
            box = within(tuple((found.boxes[index] * scale).tolist()), columns, rows)
            if label is not None and area(box) > 0.0:
                told.append(Found(label, min(float(found.scores[index]), 1.0), box))
        return once(told[:MOST_FOUND])

    def _axes(self) -> tuple[bool, Sides | None]:
        """Return whether colours are the last axis, and the sides of pictures if they are fixed."""
        shape = self._port.shape
        if len(shape) != 4 or self._port.type not in NUMBERS or 3 not in (shape[1], shape[3]):
            raise VisionError(
                f"{self._subject}: takes {self._port.name!r} {self._port.type} {shape}; expected "
                f"pictures in three colours, and {EXPECTED}"
            )
        is_last = shape[1] != 3
        sides = shape[1:3] if is_last else shape[2:4]
        if all(isinstance(side, int) and side > 0 for side in sides):
            return is_last, (sides[0], sides[1])
        return is_last, None

    def _fitted(self, picture: Picture) -> tuple[Picture, tuple[float, float]]:
        """Return a picture in the size that is taken, and what part of that it fills."""
        rows, columns = picture.shape[:2]
        if self._sides is None:
            sides = tuple(-(-side // STRIDE_PX) * STRIDE_PX for side in (rows, columns))
            if sides == (rows, columns):
                return picture, (1.0, 1.0)
            return _padded(picture, *sides), (columns / sides[1], rows / sides[0])
        if not self._family.keeps_shape:
            return _resized(picture, *self._sides), (1.0, 1.0)
        scale = min(self._sides[0] / rows, self._sides[1] / columns)
        inner = max(round(rows * scale), 1), max(round(columns * scale), 1)
        used = inner[1] / self._sides[1], inner[0] / self._sides[0]
        return _padded(_resized(picture, *inner), *self._sides), used

    def _answer(
        self, picture: Picture, is_trial: bool = False
    ) -> dict[str, npt.NDArray[np.generic]]:
        given: npt.NDArray[Any] = picture
        if self._port.type != "tensor(uint8)":
            given = _coloured(picture, self._colours).astype(NUMBERS[self._port.type])
        given = np.ascontiguousarray((given if self._is_last else given.transpose(2, 0, 1))[None])
        inputs = {self._port.name: given}
        for port in self._others:
            inputs[port.name] = self._besides(port, picture)
        if not is_trial:
            return dict(zip(self._names, self._network.run(None, inputs), strict=True))
        try:
            return dict(zip(self._names, first_look(self._network, inputs), strict=True))
        except TimeoutError as cause:
            raise VisionError(
                f"{self._subject}: the network {cause}; expected one that ends"
            ) from None
        except Exception as error:
            raise VisionError(f"{self._subject}: failed: {first_line(error)}") from None

    def _besides(self, port: Any, picture: Picture) -> npt.NDArray[Any]:
        """Return another input: sides of the picture, or a mask without any padding."""
        rows, columns = picture.shape[:2]
        number = np.int32 if port.type == "tensor(int32)" else np.int64
        if port.type in NUMBERS:
            number = NUMBERS[port.type]
        match port.shape:
            case [_, 2]:
                return np.array([[columns, rows]], number)
            case [_, below, beside]:
                sides = (below if isinstance(below, int) else rows,
                         beside if isinstance(beside, int) else columns)  # fmt: skip
                return np.ones((1, *sides), number)
        raise VisionError(
            f"{self._subject}: takes {port.name!r} {port.type} {port.shape} besides pictures; "
            f"expected {EXPECTED}"
        )

    def _numbered(self, family: Family, names: Mapping[int, str]) -> Mapping[int, str]:
        """Return the names of the classes by their numbers in the outputs."""
        if names:
            # Of an SSD, number 0 is the background, which not all lists of names begin with.
            has_nothing = "background" in names.get(0, "").lower() or 0 not in names
            first = 0 if has_nothing else family.first
            return {number + first: name for number, name in names.items()}
        if family.has_coco_ids and family.class_count in (None, 90, 91):
            return COCO_BY_ID
        if family.class_count in (None, len(COCO)):
            return dict(enumerate(COCO, start=family.first))
        raise VisionError(
            f"{self._subject}: its {family.class_count} classes have no names; expected the "
            "metadata 'names', or beside it labels.txt with one name a line, or config.json with "
            "'id2label'"
        )


def _names_of(path: Path, network: onnxruntime.InferenceSession, subject: str) -> Mapping[int, str]:
    """Return names of classes by number, from the metadata or a file beside; none if none do."""
    metadata = network.get_modelmeta().custom_metadata_map
    beside, lists = path.with_name("config.json"), (f"{path.stem}.txt", "labels.txt")
    try:
        if "names" in metadata:
            given = ast.literal_eval(metadata["names"])
            return {int(number): str(name) for number, name in dict(given).items()}
        for each in lists:
            if (file := path.with_name(each)).is_file():
                lines = read_file(file, LARGEST_NAMES_BYTES).decode().splitlines()
                return dict(enumerate(line.strip() for line in lines if line.strip()))
        if beside.is_file():
            given = json.loads(read_file(beside, LARGEST_NAMES_BYTES)).get("id2label", {})
            return {int(number): str(name) for number, name in given.items()}
    except (OSError, ValueError, SyntaxError, TypeError, AttributeError, RecursionError):
        raise VisionError(
            f"{subject}: the names of its classes cannot be read; expected a plain value as "
            "metadata 'names', labels.txt with one name a line, or 'id2label' in config.json"
        ) from None
    return {}


def _coloured(picture: Picture, colours: str) -> npt.NDArray[np.float32]:
    if colours == "levels":
        return picture[..., ::-1].astype(np.float32)
    unit = picture.astype(np.float32) / np.float32(255.0)
    return (unit - MEAN) / DEVIATION if colours == "imagenet" else unit


def _resized(picture: Picture, rows: int, columns: int) -> Picture:
    if picture.shape[:2] == (rows, columns):
        return picture
    image = Image.fromarray(np.ascontiguousarray(picture))
    return np.asarray(image.resize((columns, rows), Image.Resampling.BILINEAR))


def _padded(picture: Picture, rows: int, columns: int) -> Picture:
    below, beside = rows - picture.shape[0], columns - picture.shape[1]
    return np.pad(picture, ((0, below), (0, beside), (0, 0)), constant_values=GREY)


def _create(file: str, configuration: DetectorClasses | None = None) -> OnnxDetector:
    return OnnxDetector(Path(file), configuration.classes if configuration else {})


ENGINE = Engine(
    name="onnx",
    summary="YOLO, YOLOX, RT-DETR, DETR or SSD that you have, as .onnx",
    create=_create,
    argument="FILE",
    is_argument_required=True,
    takes=lambda text: text.endswith(".onnx") and not has_card(Path(text)),
    configuration=DetectorClasses,
)
