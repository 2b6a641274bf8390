"""ONNX networks, run so that the same input gives the same bytes and one core is enough."""

from __future__ import annotations

from pathlib import Path

import onnxruntime

from airhilt.errors import AirhiltError, SpeechError, first_line


def open_network(
    path: Path,
    subject: str,
    expected: str,
    error: type[AirhiltError] = SpeechError,
    threads: int = 1,
) -> onnxruntime.InferenceSession:
    """Return the network of an ONNX file.

    Parameters
    ----------
    subject
        Words for its purpose, at the head of error messages.
    expected
        Kind of network, at the end of error messages.
    error
        Class of all errors.
    threads
        Number of threads; it does not change the output.

    Raises
    ------
    AirhiltError
        There is no such file, or no network in it that can be run.
    """
    if not path.is_file():
        raise error(f"{subject}: no such file; expected {expected}")
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = threads
    options.add_session_config_entry("session.intra_op.allow_spinning", "0")
    options.inter_op_num_threads = 1
    options.log_severity_level = 4
    try:
        return onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
    except Exception as cause:  # onnxruntime raises classes of its own that share no base
        raise error(
            f"{subject}: no ONNX model that can be run: {first_line(cause)}; expected {expected}"
        ) from None
