"""Readers of the outputs of detectors that people export as ONNX, one for each family.

A family is recognised by the inputs and outputs of the network, and by what it answers to a grey
picture; names count only where shapes leave it open.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Outputs = Mapping[str, npt.NDArray[np.generic]]
Sides = tuple[int, int]
"""Rows and columns of a picture."""
STRIDES = ((8, 16, 32), (8, 16, 32, 64), (4, 8, 16, 32), (16, 32))
"""Strides of the cells of networks that answer for each cell, in pixels."""
MOST_QUERIES = 1000
"""Most findings of networks that answer a fixed number of queries."""
LARGEST_PART = 1.5
"""Coordinates up to here are parts of the picture, others are pixels."""
EXPECTED = (
    "a detector as YOLO, YOLOX, RT-DETR, DETR or SSD are exported (docs/vision.md, ONNX models)"
)


class Findings(NamedTuple):
    """Findings of a network: boxes in parts of its picture (left, top, right, bottom)."""

    boxes: Array
    scores: Array
    numbers: npt.NDArray[np.int64]


class Family(NamedTuple):
    """A family of networks.

    Attributes
    ----------
    read
        Returns the findings in the outputs for a picture of some sides.
    colours
        What a network takes: ``unit`` from 0 to 1, ``levels`` from 0 to 255 in the order blue,
        green, red, or ``imagenet``, less the mean of ImageNet's pictures over their deviation.
    keeps_shape
        True if a picture is shrunk alike along both sides and padded.
    first
        Number of the first class in a list of names.
    class_count
        Number of classes; None if the outputs do not tell it.
    has_coco_ids
        True if numbers of classes are COCO's category ids where there are no names.
    threshold
        Confidence from which a finding counts by itself.
    """

    name: str
    read: Callable[[Outputs, Sides], Findings]
    colours: Literal["unit", "levels", "imagenet"] = "unit"
    keeps_shape: bool = False
    first: int = 0
    class_count: int | None = None
    has_coco_ids: bool = False
    threshold: float = 0.5


def family_of(inputs: Sequence[str], outputs: Outputs, sides: Sides, labels: int) -> Family | None:
    """Return the family of a network; None if it is of none.

    Parameters
    ----------
    inputs
        Names of its inputs.
    outputs
        Its answer to a grey picture of these sides.
    labels
        Number of names of classes that came with it; 0 if none did.
    """
    if "detection_boxes" in outputs:
        return Family("SSD of TensorFlow", _tensorflow, first=1, has_coco_ids=True)
    shapes = {name: given.shape for name, given in outputs.items()}
    boxes = [name for name, shape in shapes.items() if len(shape) in (2, 3) and shape[-1] == 4]
    if len(boxes) == 1 and len(shapes) > 1:
        return _with_boxes(inputs, outputs, boxes[0], labels)
    if len(shapes) == 1:
        ((name, shape),) = shapes.items()
        if len(shape) == 3:
            return _dense(outputs[name], sides)
    return None


def _with_boxes(inputs: Sequence[str], outputs: Outputs, boxes: str, labels: int) -> Family | None:
    count = outputs[boxes].shape[-2]
    others = {name: given for name, given in outputs.items() if name != boxes}
    rows = {name: given for name, given in others.items() if given.shape[-1:] == (count,)}
    kinds = [
        name for name, given in rows.items()
        if given.dtype.kind in "iu" or "label" in name or "class" in name
    ]  # fmt: skip
    scores = [name for name in rows if name not in kinds]
    if len(kinds) == len(scores) == 1:
        read = _listed(boxes, kinds[0], scores[0])
        if len(inputs) > 1:
            return Family("RT-DETR", read)
        return Family("SSD", read, first=1, has_coco_ids=True)
    matrices = [name for name, given in others.items() if given.shape[-2:-1] == (count,)]
    if len(matrices) != 1:
        return None
    given = _floats(outputs[matrices[0]])
    columns = given.shape[-1]
    if "logit" in matrices[0] or given.min(initial=0.0) < 0.0 or given.max(initial=0.0) > 1.0:
        has_nothing = columns == labels + 1 if labels else columns in (81, 92)
        read = _queries(boxes, matrices[0], has_nothing)
        kept = columns - has_nothing
        colours: Literal["unit", "imagenet"] = (
            "imagenet" if has_nothing or "pixel_mask" in inputs else "unit"
        )
        name = "DETR" if has_nothing else "RT-DETR"
        return Family(name, read, colours, class_count=kept, has_coco_ids=kept == 91)
    return Family(
        "SSD",
        _scored(boxes, matrices[0]),
        first=1,
        class_count=columns - 1,
        has_coco_ids=columns == 91,
    )


def _dense(given: npt.NDArray[np.generic], sides: Sides) -> Family | None:
    """Return the family of a network with one output, of boxes and scores in one array."""
    _, rows, columns = given.shape
    cells = {cells_of(sides, strides): strides for strides in STRIDES}
    if columns in cells and rows > 4:
        return Family("YOLOv8", _yolov8, keeps_shape=True, class_count=rows - 4, threshold=0.25)
    if rows in cells and columns > 5:
        centres, _ = _grid(sides, cells[rows])
        middles = _floats(given)[0, :, :2]
        is_decoded = np.median(np.abs(middles - centres)) < np.median(np.abs(middles - 0.5))
        read = _with_objectness if is_decoded else _yolox(cells[rows])
        return Family("YOLOX", read, "levels", True, class_count=columns - 5, threshold=0.25)
    if rows % 3 == 0 and rows // 3 in cells and columns > 5:
        return Family("YOLOv5", _with_objectness, keeps_shape=True, class_count=columns - 5,
                      threshold=0.25)  # fmt: skip
    if rows <= MOST_QUERIES and columns == 6:
        return Family("YOLOv10", _final, keeps_shape=True, threshold=0.25)
    if rows <= MOST_QUERIES and columns > 4:
        return Family("RT-DETR of ultralytics", _one_array, class_count=columns - 4)
    return None


def cells_of(sides: Sides, strides: Sequence[int]) -> int:
    """Return the number of cells of a picture, over all strides."""
    return sum(-(-sides[0] // stride) * -(-sides[1] // stride) for stride in strides)


def _grid(sides: Sides, strides: Sequence[int]) -> tuple[Array, Array]:
    """Return the middles and the strides of all cells, in pixels."""
    middles, steps = [], []
    for stride in strides:
        rows, columns = (np.arange(-(-side // stride)) + 0.5 for side in sides)
        x, y = np.meshgrid(columns, rows)
        middles.append(stride * np.column_stack((x.ravel(), y.ravel())))
        steps.append(np.full(x.size, float(stride)))
    return np.vstack(middles), np.concatenate(steps)


def _yolox(strides: Sequence[int]) -> Callable[[Outputs, Sides], Findings]:
    """Return the reader of YOLOX without decoding: Z. Ge et al., arXiv 2107.08430; its demo."""

    def read(outputs: Outputs, sides: Sides) -> Findings:
        found = _floats(next(iter(outputs.values())))[0]
        middles, steps = _grid(sides, strides)
        middle = (found[:, :2] * steps[:, None]) + middles - steps[:, None] / 2.0
        size = np.exp(np.minimum(found[:, 2:4], 20.0)) * steps[:, None]
        return _objects(np.column_stack((middle, size, found[:, 4:])), sides)

    return read


def _with_objectness(outputs: Outputs, sides: Sides) -> Findings:
    """Read middle, size, that there is anything, and what: YOLOv5, and YOLOX decoded."""
    return _objects(_floats(next(iter(outputs.values())))[0], sides)


def _objects(found: Array, sides: Sides) -> Findings:
    return _best(_corners(found[:, :4]) / _scale(sides), found[:, 4:5] * found[:, 5:])


def _yolov8(outputs: Outputs, sides: Sides) -> Findings:
    found = _floats(next(iter(outputs.values())))[0].T
    return _best(_corners(found[:, :4]) / _scale(sides), found[:, 4:])


def _final(outputs: Outputs, sides: Sides) -> Findings:
    found = _floats(next(iter(outputs.values())))[0]
    return Findings(found[:, :4] / _scale(sides), found[:, 4], found[:, 5].astype(np.int64))


def _one_array(outputs: Outputs, sides: Sides) -> Findings:  # noqa: ARG001
    found = _floats(next(iter(outputs.values())))[0]
    return _best(_corners(found[:, :4]), found[:, 4:])


def _tensorflow(outputs: Outputs, sides: Sides) -> Findings:  # noqa: ARG001
    boxes = _floats(outputs["detection_boxes"]).reshape(-1, 4)[:, [1, 0, 3, 2]]
    scores = _floats(outputs["detection_scores"]).reshape(-1)
    return Findings(boxes, scores, outputs["detection_classes"].reshape(-1).astype(np.int64))


def _listed(boxes: str, kinds: str, scores: str) -> Callable[[Outputs, Sides], Findings]:
    """Return the reader of boxes with a score and a class each."""

    def read(outputs: Outputs, sides: Sides) -> Findings:
        found = _floats(outputs[boxes]).reshape(-1, 4)
        if found.max(initial=0.0) > LARGEST_PART:
            found = found / _scale(sides)
        numbers = outputs[kinds].reshape(-1).astype(np.int64)
        return Findings(found, _floats(outputs[scores]).reshape(-1), numbers)

    return read


def _queries(boxes: str, logits: str, has_nothing: bool) -> Callable[[Outputs, Sides], Findings]:
    """Return the reader of DETR: N. Carion et al., arXiv 2005.12872; sigmoids in later ones."""

    def read(outputs: Outputs, sides: Sides) -> Findings:  # noqa: ARG001
        given = _floats(outputs[logits])[0]
        if has_nothing:
            odds = np.exp(given - given.max(axis=1, keepdims=True))
            chances = (odds / odds.sum(axis=1, keepdims=True))[:, :-1]
        else:
            chances = 1.0 / (1.0 + np.exp(-np.clip(given, -50.0, 50.0)))
        return _best(_corners(_floats(outputs[boxes])[0]), chances)

    return read


def _scored(boxes: str, scores: str) -> Callable[[Outputs, Sides], Findings]:
    """Return the reader of SSD's priors: W. Liu et al., arXiv 1512.02325; class 0 is background."""

    def read(outputs: Outputs, sides: Sides) -> Findings:
        found = _floats(outputs[boxes]).reshape(-1, 4)
        if found.max(initial=0.0) > LARGEST_PART:
            found = found / _scale(sides)
        best = _best(found, _floats(outputs[scores]).reshape(len(found), -1)[:, 1:])
        return best._replace(numbers=best.numbers + 1)

    return read


def _best(boxes: Array, chances: Array) -> Findings:
    """Return the best class of each box."""
    numbers = chances.argmax(axis=1)
    return Findings(boxes, chances[np.arange(len(chances)), numbers], numbers)


def _corners(boxes: Array) -> Array:
    """Return left, top, right and bottom of boxes given by their middles and sizes."""
    half = boxes[:, 2:] / 2.0
    return np.hstack((boxes[:, :2] - half, boxes[:, :2] + half))


def _scale(sides: Sides) -> Array:
    rows, columns = sides
    return np.array((columns, rows, columns, rows), dtype=float)


def _floats(given: npt.NDArray[np.generic]) -> Array:
    return np.asarray(given, dtype=np.float64)
