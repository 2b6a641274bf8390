"""ONNX networks of the right shapes with a loop of 2^62 turns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import onnx
from onnx import TensorProto, helper

Shape = Sequence[int | str]
TURNS = 2**62


def write_endless(
    path: Path, inputs: Mapping[str, tuple[int, Shape]], outputs: Mapping[str, Shape]
) -> None:
    """Write a network whose outputs are what a loop makes of the mean of its first input.

    Parameters
    ----------
    inputs
        Type of ONNX and shape of each input.
    outputs
        Shape of each output; the first axis is that of the first input.
    """
    first = next(iter(inputs))
    scalar = [helper.make_tensor_value_info("value", TensorProto.FLOAT, [])]
    turn = helper.make_graph(
        [
            helper.make_node("Identity", ["goes_on"], ["goes_on_next"]),
            helper.make_node("Sin", ["value"], ["next_value"]),
        ],
        "turn",
        [
            helper.make_tensor_value_info("number", TensorProto.INT64, []),
            helper.make_tensor_value_info("goes_on", TensorProto.BOOL, []),
            *scalar,
        ],
        [
            helper.make_tensor_value_info("goes_on_next", TensorProto.BOOL, []),
            helper.make_tensor_value_info("next_value", TensorProto.FLOAT, []),
        ],
    )
    constants = [
        helper.make_tensor("turns", TensorProto.INT64, [], [TURNS]),
        helper.make_tensor("yes", TensorProto.BOOL, [], [True]),
        helper.make_tensor("zero", TensorProto.INT64, [1], [0]),
    ]
    nodes = [
        helper.make_node("Cast", [first], ["numbers"], to=TensorProto.FLOAT),
        helper.make_node("ReduceMean", ["numbers"], ["mean"], keepdims=0),
        helper.make_node("Loop", ["turns", "yes", "mean"], ["last"], body=turn),
        helper.make_node("Shape", [first], ["shape"]),
        helper.make_node("Gather", ["shape", "zero"], ["length"]),
    ]
    for name, shape in outputs.items():
        sides = [side if isinstance(side, int) else 1 for side in shape[1:]]
        constants.append(
            helper.make_tensor(f"{name}_sides", TensorProto.INT64, [len(sides)], sides)
        )
        nodes += [
            helper.make_node("Concat", ["length", f"{name}_sides"], [f"{name}_shape"], axis=0),
            helper.make_node("Expand", ["last", f"{name}_shape"], [name]),
        ]
    graph = helper.make_graph(
        nodes,
        "endless",
        [helper.make_tensor_value_info(name, *port) for name, port in inputs.items()],
        [
            helper.make_tensor_value_info(name, TensorProto.FLOAT, shape)
            for name, shape in outputs.items()
        ],
        constants,
    )
    version = helper.make_opsetid("", 17)
    onnx.save(helper.make_model(graph, opset_imports=[version], ir_version=8), path)
