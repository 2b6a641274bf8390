"""ONNX networks, run so that the same input gives the same bytes and one core is enough."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from threading import Timer
from typing import Any

import onnxruntime

from airhilt.errors import AirhiltError, SpeechError, first_line, shown

PROVIDERS = "AIRHILT_ONNX_PROVIDERS"
"""Environment variable with the execution providers of networks, separated by commas, the preferred
one first; the processor does what is left."""
CPU = "CPUExecutionProvider"
LARGEST_FILE_BYTES = 500_000_000
"""Size of the largest file that is loaded."""
LARGEST_MEMORY_BYTES = 4_000_000_000
"""Memory that all networks of a process may have at a time."""
LONGEST_LOAD_S = 60.0
"""Wall time after which a network is not loaded any more; it stops at its next step."""
FIRST_LOOK_S = 20.0
"""Longest wall time of the first look of a network, in s; a loop in it may never end."""


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
    threads
        Number of threads; it does not change the output.

    Raises
    ------
    AirhiltError
        There is no such file, no network in it that can be run, or no such execution provider.
    """
    if not path.is_file():
        raise error(f"{subject}: no such file; expected {expected}")
    if path.stat().st_size > LARGEST_FILE_BYTES:
        raise error(f"{subject}: has over {LARGEST_FILE_BYTES:,} bytes; expected {expected}")
    wanted = providers(error)
    _bound_memory()
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = threads
    options.add_session_config_entry("session.intra_op.allow_spinning", "0")
    options.inter_op_num_threads = 1
    options.log_severity_level = 4
    options.add_session_config_entry("session.use_env_allocators", "1")
    try:
        with _after(LONGEST_LOAD_S, lambda: options.set_load_cancellation_flag(True)):
            network = onnxruntime.InferenceSession(str(path), options, providers=wanted)
    except Exception as cause:  # onnxruntime raises classes of its own that share no base
        raise error(
            f"{subject}: no ONNX model that can be run: {first_line(cause)}; expected {expected}"
        ) from None
    missing = [name for name in wanted if name not in network.get_providers()]
    if missing:
        raise error(
            f"{PROVIDERS} {shown(missing[0])}: onnxruntime cannot load it; install what it needs, "
            "or leave it out"
        )
    return network


def providers(error: type[AirhiltError] = AirhiltError) -> list[str]:
    """Return the execution providers that are asked for, and the processor last.

    Raises
    ------
    AirhiltError
        The installed onnxruntime does not have one of them.
    """
    given = [name.strip() for name in os.environ.get(PROVIDERS, "").split(",") if name.strip()]
    there = onnxruntime.get_available_providers()
    for name in given:
        if name not in there:
            raise error(
                f"{PROVIDERS} {shown(name)}: the installed onnxruntime has no such execution "
                f"provider; expected of {', '.join(there)}"
            )
    return [*(name for name in given if name != CPU), CPU]


def first_look(
    network: onnxruntime.InferenceSession, inputs: Mapping[str, Any], limit_s: float | None = None
) -> list[Any]:
    """Return the outputs of a network that may never end.

    Parameters
    ----------
    limit_s
        Wall time after which it is stopped; None: `FIRST_LOOK_S`.

    Raises
    ------
    TimeoutError
        It did not end within the limit.
    """
    limit_s = FIRST_LOOK_S if limit_s is None else limit_s
    options = onnxruntime.RunOptions()
    options.log_severity_level = 4
    try:
        with _after(limit_s, lambda: setattr(options, "terminate", True)):
            found: list[Any] = network.run(None, dict(inputs), options)
    except Exception:
        if options.terminate:
            raise TimeoutError(f"does not end within {limit_s:g} s") from None
        raise
    return found


def require_end(
    network: onnxruntime.InferenceSession,
    inputs: Mapping[str, Any],
    subject: str,
    error: type[AirhiltError],
) -> None:
    """Raise an error if a network does not end, or fails, when it is tried."""
    try:
        first_look(network, inputs)
    except TimeoutError as cause:
        raise error(f"{subject}: the network {cause}; expected one that ends") from None
    except Exception as cause:  # onnxruntime raises classes of its own that share no base
        raise error(f"{subject} has failed: {first_line(cause)}") from None


@contextmanager
def _after(limit_s: float, stop: Callable[[], None]) -> Iterator[None]:
    """Stop what is done here if it has not ended after some wall time."""
    timer = Timer(limit_s, stop)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


@cache
def _bound_memory() -> None:
    """Give all networks of this process one allocator, which has a limit."""
    where = onnxruntime.OrtMemoryInfo(
        "Cpu",
        onnxruntime.OrtAllocatorType.ORT_ARENA_ALLOCATOR,
        0,
        onnxruntime.OrtMemType.DEFAULT,
    )
    limit = onnxruntime.OrtArenaCfg({"max_mem": LARGEST_MEMORY_BYTES})
    onnxruntime.create_and_register_allocator(where, limit)
