"""Make the tiny learned channels of the tests.

    python tools/make/tiny_channels.py tests/data/channels

Needs ``onnx``, which AIRHILT does not.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

Shape = list[int | str]


def save(
    path: Path,
    nodes: list[onnx.NodeProto],
    constants: dict[str, np.ndarray] | None = None,
    kind: int = TensorProto.FLOAT,
    shape: Shape | None = None,
    made: Shape | None = None,
) -> None:
    """Write a model from ``speech`` to ``heard``."""
    graph = helper.make_graph(
        nodes,
        path.stem,
        [helper.make_tensor_value_info("speech", kind, shape or [1, "n"])],
        [helper.make_tensor_value_info("heard", kind, made or shape or [1, "n"])],
        [numpy_helper.from_array(value, name) for name, value in (constants or {}).items()],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=9)
    onnx.checker.check_model(model)
    path.write_bytes(model.SerializeToString())


def louder() -> onnx.GraphProto:
    """Return the body of a loop that changes the speech and goes on."""
    ports = [
        helper.make_tensor_value_info("turn", TensorProto.INT64, []),
        helper.make_tensor_value_info("again", TensorProto.BOOL, []),
        helper.make_tensor_value_info("before", TensorProto.FLOAT, None),
    ]
    made = [
        helper.make_tensor_value_info("still", TensorProto.BOOL, []),
        helper.make_tensor_value_info("after", TensorProto.FLOAT, None),
    ]
    nodes = [
        helper.make_node("Identity", ["again"], ["still"]),
        helper.make_node("Tanh", ["before"], ["after"]),
    ]
    return helper.make_graph(nodes, "louder", ports, made)


def main() -> None:
    """Write one model that is a channel, and some that are none."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    axis = {"axis": np.array([1], np.int64)}
    echo = np.array([[[0.3, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]]], np.float32)
    save(
        out / "echo.onnx",
        [
            helper.make_node("Unsqueeze", ["speech", "axis"], ["a"]),
            helper.make_node("Conv", ["a", "echo"], ["b"], pads=[4, 4]),
            helper.make_node("Tanh", ["b"], ["c"]),
            helper.make_node("Squeeze", ["c", "axis"], ["heard"]),
        ],
        {**axis, "echo": echo},
    )
    save(out / "whole_numbers.onnx", [helper.make_node("Identity", ["speech"], ["heard"])],
         kind=TensorProto.INT64)  # fmt: skip
    save(
        out / "endless.onnx",
        [helper.make_node("Loop", ["count", "goes_on", "speech"], ["heard"], body=louder())],
        {"count": np.array(2**62, np.int64), "goes_on": np.array(True)},
    )
    save(
        out / "twice_as_long.onnx",
        [helper.make_node("Concat", ["speech", "speech"], ["heard"], axis=1)],
        made=[1, "m"],
    )
    save(out / "one_second.onnx", [helper.make_node("Identity", ["speech"], ["heard"])],
         shape=[1, 16_000])  # fmt: skip
    save(
        out / "no_numbers.onnx",
        [
            helper.make_node("Sub", ["speech", "speech"], ["zero"]),
            helper.make_node("Div", ["zero", "zero"], ["heard"]),
        ],
    )


if __name__ == "__main__":
    main()
