"""Make the tiny recogniser of the tests: three words, each of them a tone.

    python tools/make/tiny_recogniser.py tests/data/tiny_recogniser
    python tools/make/tiny_recogniser.py tests/data/tiny_recogniser_of_30_ms --step-frames 3

The network looks at four mel bands in every sixth frame, or more often, and gives the posteriors
that belong to the loudest, or those of silence where none stands out. Needs ``onnx``, which AIRHILT
does not.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

from airhilt.assistant.asr.language import key
from airhilt.assistant.asr.pieces import BEGIN

WORDS = ("alfa", "bravo", "charlie")
BANDS = (15, 30, 45, 60)
"""Mel bands whose centres are near 588, 1202, 2108 and 3446 Hz."""
POSTERIORS = (
    (0.97, 0.01, 0.01, 0.01),
    (0.04, 0.90, 0.03, 0.03),
    (0.10, 0.05, 0.80, 0.05),
    (0.02, 0.02, 0.01, 0.95),
    (0.30, 0.60, 0.05, 0.05),
)
"""Posteriors of the blank and of the words, in silence and in each band."""
STANDS_OUT = 5.0
"""Excess over the mean of a band that makes a tone, in the natural logarithm of power."""


def write_even_language(path: Path) -> None:
    """Write a language model to which all units are alike."""
    units = 1 + len(WORDS)
    np.savez(
        path,
        keys1=np.array([key((unit,)) for unit in range(units)], np.uint64),
        scores1=np.full(units, -np.log(units), np.float16),
        backoffs1=np.zeros(units, np.float16),
    )


def main() -> None:
    """Write the network, its pieces, an even language model and its card."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--step-frames", type=int, default=6, help="frames of 10 ms in a step")
    given = parser.parse_args()
    out: Path = given.out
    out.mkdir(parents=True, exist_ok=True)
    constants = {
        "begin": np.array([0], np.int64),
        "end": np.array([np.iinfo(np.int64).max], np.int64),
        "frames": np.array([1], np.int64),
        "step": np.array([given.step_frames], np.int64),
        "bands": np.array(BANDS, np.int64),
        "one_more": np.array([0, 0, 1, 0, 0, 0], np.int64),
        "stands_out": np.array(STANDS_OUT, np.float32),
        "table": np.log(np.array(POSTERIORS)).astype(np.float32),
    }
    graph = helper.make_graph(
        [
            helper.make_node("Slice", ["features", "begin", "end", "frames", "step"], ["some"]),
            helper.make_node("Gather", ["some", "bands"], ["tones"], axis=2),
            helper.make_node("Pad", ["tones", "one_more", "stands_out"], ["all"]),
            helper.make_node("ArgMax", ["all"], ["loudest"], axis=2, keepdims=0),
            helper.make_node("Gather", ["table", "loudest"], ["logits"], axis=0),
        ],
        "tiny_recogniser",
        [helper.make_tensor_value_info("features", TensorProto.FLOAT, [1, "n", 64])],
        [helper.make_tensor_value_info("logits", TensorProto.FLOAT, [1, "steps", 1 + len(WORDS)])],
        [numpy_helper.from_array(value, name) for name, value in constants.items()],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=9)
    onnx.checker.check_model(model)
    (out / "ctc.onnx").write_bytes(model.SerializeToString())
    pieces = [BEGIN + word for word in WORDS]
    (out / "pieces.txt").write_text("\n".join(pieces) + "\n", encoding="utf-8")
    write_even_language(out / "language.npz")
    as_it_is = {"slope": 1.0, "offset": 0.0}
    card = {
        "made_by": "tools/make/tiny_recogniser.py",
        "word_curve": {"posterior_slope": 1.0, "alternatives_slope": 0.0, "offset": 0.0},
        "lost_words": {"heard_slope": 1.0, "inserted_slope": 0.0, "offset": -5.0},
        "callsign_odds": {"offset": 0.0, "name": 1.0, "sign": 1.0, "loss": 0.5},
        "call_calibration": as_it_is,
        "least_word_confidence": 0.5,
        "best_word_threshold": 0.0,
        "language_weight": 0.0,
        "piece_reward": 0.0,
    }
    (out / "card.json").write_text(json.dumps(card, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
