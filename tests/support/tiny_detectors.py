"""ONNX networks with the inputs and outputs of detectors that people export, and known findings.

Each finds one airplane at `AIRPLANE` in a picture of `PICTURE_PX`, by the classes of COCO.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

PICTURE_PX = (320, 640)
"""Rows and columns."""
SIDE_PX = 320
AIRPLANE = (100.0, 40.0, 300.0, 140.0)
IN_HALF = (50.0, 20.0, 150.0, 70.0)
"""The same in a picture that is shrunk to the network's width."""
PARTS = (100.0 / 640.0, 40.0 / 320.0, 300.0 / 640.0, 140.0 / 320.0)
SCORE = 0.8
COCO_INDEX, COCO_ID = 4, 5
PICTURES = {"images": (TensorProto.FLOAT, [1, 3, SIDE_PX, SIDE_PX])}
Port = tuple[int, Sequence[int | str]]


def write(
    path: Path,
    inputs: Mapping[str, Port],
    outputs: Mapping[str, np.ndarray],
    metadata: Mapping[str, str] | None = None,
    lit: tuple[int, ...] | None = None,
    opset: int = 17,
) -> Path:
    """Write a network that always answers the same.

    Parameters
    ----------
    lit
        Place in the first output to which the first pixel's first colour is added.
    """
    nodes, constants = [], []
    for name, given in outputs.items():
        constants.append(numpy_helper.from_array(given, f"{name}_given"))
        nodes.append(helper.make_node("Identity", [f"{name}_given"], [name]))
    if lit is not None:
        first, name = next(iter(inputs)), next(iter(outputs))
        places = np.zeros_like(outputs[name])
        places[lit] = 1.0
        constants += [numpy_helper.from_array(places, "places")] + [
            numpy_helper.from_array(np.array(each, np.int64), label)
            for label, each in (("from", [0] * 4), ("to", [1] * 4), ("one", [1]))
        ]
        nodes[0] = helper.make_node("Add", [f"{name}_given", "light"], [name])
        nodes[:0] = [
            helper.make_node("Slice", [first, "from", "to"], ["pixel"]),
            helper.make_node("Reshape", ["pixel", "one"], ["level"]),
            helper.make_node("Mul", ["level", "places"], ["light"]),
        ]
    graph = helper.make_graph(
        nodes,
        "tiny",
        [helper.make_tensor_value_info(name, *port) for name, port in inputs.items()],
        [
            helper.make_tensor_value_info(
                name, helper.np_dtype_to_tensor_dtype(given.dtype), given.shape
            )
            for name, given in outputs.items()
        ],
        constants,
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", opset)], ir_version=8)
    helper.set_model_props(model, dict(metadata or {}))
    onnx.save(model, path)
    return path


def middle(box: Sequence[float]) -> list[float]:
    """Return middle and size of a box."""
    left, top, right, bottom = box
    return [(left + right) / 2, (top + bottom) / 2, right - left, bottom - top]


def yolov8() -> dict[str, Any]:
    found = np.zeros((1, 84, 2100), np.float32)
    found[0, :4, 7], found[0, 4 + COCO_INDEX, 7] = middle(IN_HALF), SCORE
    return {"inputs": PICTURES, "outputs": {"output0": found}}


def yolov10() -> dict[str, Any]:
    found = np.zeros((1, 300, 6), np.float32)
    found[0, 0] = (*IN_HALF, SCORE, COCO_INDEX)
    return {"inputs": PICTURES, "outputs": {"output0": found}}


def yolov5() -> dict[str, Any]:
    found = np.zeros((1, 6300, 85), np.float32)
    found[0, 7, :5], found[0, 7, 5 + COCO_INDEX] = (*middle(IN_HALF), 1.0), SCORE
    return {"inputs": PICTURES, "outputs": {"output": found}}


def yolox() -> dict[str, Any]:
    """Offsets from the cell in row 5 and column 12, of 8 pixels, and logarithms of sizes."""
    found = np.zeros((1, 2100, 85), np.float32)
    found[0, 5 * 40 + 12, :5] = (0.5, 0.625, np.log(100.0 / 8.0), np.log(50.0 / 8.0), 1.0)
    found[0, 5 * 40 + 12, 5 + COCO_INDEX] = SCORE
    return {"inputs": PICTURES, "outputs": {"output": found}}


def yolox_decoded() -> dict[str, Any]:
    found = np.zeros((1, 2100, 85), np.float32)
    cells = []
    for stride in (8, 16, 32):
        rows, columns = np.mgrid[: SIDE_PX // stride, : SIDE_PX // stride] * stride
        cells.append(np.column_stack((columns.ravel(), rows.ravel())))
    found[0, :, :2] = np.vstack(cells)
    found[0, 5 * 40 + 12, :5] = (*middle(IN_HALF), 1.0)
    found[0, 5 * 40 + 12, 5 + COCO_INDEX] = SCORE
    return {"inputs": PICTURES, "outputs": {"output": found}}


def rt_detr() -> dict[str, Any]:
    boxes = np.zeros((1, 300, 4), np.float32)
    labels, scores = np.zeros((1, 300), np.int64), np.zeros((1, 300), np.float32)
    boxes[0, 0], labels[0, 0], scores[0, 0] = IN_HALF, COCO_INDEX, SCORE
    boxes[0, 0] = [part * SIDE_PX for part in PARTS]
    return {
        "inputs": {**PICTURES, "orig_target_sizes": (TensorProto.INT64, [1, 2])},
        "outputs": {"labels": labels, "boxes": boxes, "scores": scores},
    }


def rt_detr_of_ultralytics() -> dict[str, Any]:
    found = np.zeros((1, 300, 84), np.float32)
    found[0, 0, :4], found[0, 0, 4 + COCO_INDEX] = middle(PARTS), SCORE
    return {"inputs": PICTURES, "outputs": {"output0": found}}


def rt_detr_of_transformers() -> dict[str, Any]:
    logits = np.full((1, 300, 80), -20.0, np.float32)
    boxes = np.zeros((1, 300, 4), np.float32)
    logits[0, 0, COCO_INDEX], boxes[0, 0] = np.log(SCORE / (1 - SCORE)), middle(PARTS)
    pictures = {"pixel_values": PICTURES["images"]}
    return {"inputs": pictures, "outputs": {"logits": logits, "pred_boxes": boxes}}


def detr() -> dict[str, Any]:
    logits = np.full((1, 100, 92), -20.0, np.float32)
    logits[..., -1] = 20.0
    logits[0, 0, COCO_ID], logits[0, 0, -1] = np.log(SCORE / (1 - SCORE)), 0.0
    boxes = np.zeros((1, 100, 4), np.float32)
    boxes[0, 0] = middle(PARTS)
    pictures = {
        "pixel_values": PICTURES["images"], "pixel_mask": (TensorProto.INT64, [1, 64, 64])
    }  # fmt: skip
    return {"inputs": pictures, "outputs": {"logits": logits, "pred_boxes": boxes}}


def ssd_of_tensorflow() -> dict[str, Any]:
    left, top, right, bottom = PARTS
    return {
        "inputs": {"input_tensor": (TensorProto.UINT8, [1, "rows", "columns", 3])},
        "outputs": {
            "detection_boxes": np.array([[[top, left, bottom, right]]], np.float32),
            "detection_classes": np.array([[COCO_ID]], np.float32),
            "detection_scores": np.array([[SCORE]], np.float32),
            "num_detections": np.array([1], np.float32),
        },
    }


def ssd_of_torchvision() -> dict[str, Any]:
    return {
        "inputs": PICTURES,
        "outputs": {
            "boxes": np.array([[part * SIDE_PX for part in PARTS]], np.float32),
            "scores": np.array([SCORE], np.float32),
            "labels": np.array([COCO_ID], np.int64),
        },
    }


def ssd_of_priors() -> dict[str, Any]:
    scores = np.zeros((1, 50, 81), np.float32)
    scores[..., 0] = 1.0
    scores[0, 3, 0], scores[0, 3, 1 + COCO_INDEX] = 1.0 - SCORE, SCORE
    boxes = np.zeros((1, 50, 4), np.float32)
    boxes[0, 3] = PARTS
    return {"inputs": PICTURES, "outputs": {"scores": scores, "boxes": boxes}}


FAMILIES: tuple[Callable[[], dict[str, Any]], ...] = (
    yolov5, yolov8, yolov10, yolox, yolox_decoded, rt_detr, rt_detr_of_ultralytics,
    rt_detr_of_transformers, detr, ssd_of_tensorflow, ssd_of_torchvision, ssd_of_priors,
)  # fmt: skip
