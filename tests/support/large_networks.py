"""ONNX networks that are small as files and take much to load or run."""

from __future__ import annotations

from pathlib import Path

import onnx
from onnx import NodeProto, TensorProto, helper


def write_large(path: Path, numbers: int) -> None:
    """Write a network of speech whose output needs an array of so many numbers."""
    shape = helper.make_tensor("shape", TensorProto.INT64, [1], [numbers])
    _write(
        path,
        [
            helper.make_node("ConstantOfShape", ["shape"], ["zeros"]),
            helper.make_node("ReduceSum", ["zeros"], ["sum"], keepdims=0),
            helper.make_node("Add", ["speech", "sum"], ["received"]),
        ],
        [shape],
    )


def write_long(path: Path, nodes: int) -> None:
    """Write a network of speech that is a chain of so many nodes."""
    names = ["speech", *(f"value{number}" for number in range(nodes - 1)), "received"]
    chain = [helper.make_node("Sin", [names[n]], [names[n + 1]]) for n in range(nodes)]
    _write(path, chain, [])


def _write(path: Path, nodes: list[NodeProto], constants: list[TensorProto]) -> None:
    ends = [
        helper.make_tensor_value_info(name, TensorProto.FLOAT, [1, "samples"])
        for name in ("speech", "received")
    ]
    graph = helper.make_graph(nodes, "large", ends[:1], ends[1:], constants)
    version = helper.make_opsetid("", 17)
    onnx.save(helper.make_model(graph, opset_imports=[version], ir_version=8), path)
