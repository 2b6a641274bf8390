"""``latency.jsonl``: the steps of each worker, with wall times, apart from the log of the world."""

from __future__ import annotations

import errno
import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from airhilt.errors import RunFolderError, first_line, writing_to_run
from airhilt.host.files import open_inside
from airhilt.sim import StepRecord

LONGEST_STEP_BYTES = 1_000_000
"""Greatest length of a line that is read."""


class LatencyLog:
    """Writes one line for each step; it is flushed before the log that has the results of steps.

    All methods raise `RunFolderError` if the disk is full or gone.
    """

    def __init__(self, path: Path) -> None:
        self._stream = path.open("w", encoding="utf-8")

    def step(self, record: StepRecord) -> None:
        """Write a step."""
        missed = f', "missed": {json.dumps(record.missed)}' if record.missed else ""
        self._write(
            f'{{"worker": "{record.worker}", "seq": {record.seq}, "t_in_ns": {record.t_in_ns}, '
            f'"t_start_ns": {record.t_start_ns}, "latency_ns": {record.latency_ns}, '
            f'"compute_s": {record.compute_s!r}, "outputs": {record.outputs}, '
            f'"wake_ns": {"null" if record.wake_ns is None else record.wake_ns}, '
            f'"finished": {"true" if record.finished else "false"}{missed}}}\n'
        )

    def lost(self, worker: str, t_ns: int, cause: str) -> None:
        """Write the loss of a worker."""
        row = {"worker": worker, "t_ns": t_ns, "lost": cause}
        self._write(json.dumps(row) + "\n")

    def _write(self, line: str) -> None:
        with writing_to_run(self._stream.name):
            self._stream.write(line)

    def flush(self) -> None:
        """Hand all lines to the operating system, so that they outlive this process."""
        with writing_to_run(self._stream.name):
            self._stream.flush()

    def close(self) -> None:
        """Close the file."""
        with writing_to_run(self._stream.name):
            self._stream.close()


@dataclass
class Loss:
    """The loss of a worker: when, and why."""

    t_ns: int
    cause: str


@dataclass
class UnfinishedStep:
    """A step that did not end, and when it would have."""

    seq: int
    due_ns: int


@dataclass
class RecordedLatencies:
    """The content of a latency log."""

    latencies_ns: dict[str, dict[int, int]] = field(default_factory=dict)
    outputs: dict[str, dict[int, int]] = field(default_factory=dict)
    wakes_ns: dict[str, dict[int, int | None]] = field(default_factory=dict)
    missed: dict[str, dict[int, str]] = field(default_factory=dict)
    """Why steps had no result for an input; steps that had all are left out."""
    losses: dict[str, Loss] = field(default_factory=dict)
    unfinished: dict[str, UnfinishedStep] = field(default_factory=dict)
    """The step that each worker had begun when it was lost, or when the run ended."""


def read_latencies(path: Path) -> RecordedLatencies:
    """Return the steps of a run; a last line that breaks off is left out.

    It raises `RunFolderError` if the file cannot be read, or a line is no step of a worker.
    """
    recorded = RecordedLatencies()
    try:
        for number, line in enumerate(latency_lines(path), start=1):
            if not line.endswith(b"\n"):
                break
            try:
                _take(json.loads(line), recorded)
            except (ValueError, TypeError, LookupError, RecursionError) as error:
                raise RunFolderError(
                    f"{path}: line {number}: {first_line(error)}; expected a step of a worker"
                ) from None
    except OSError as error:
        raise RunFolderError(f"{path}: cannot be read: {error.strerror}") from None
    return recorded


def latency_lines(path: Path) -> Iterator[bytes]:
    """Yield the lines of a latency log one by one.

    It raises OSError if the file cannot be read, or a line is longer than `LONGEST_STEP_BYTES`.
    """
    with open_inside(path.parent, path) as stream:
        while line := stream.readline(LONGEST_STEP_BYTES + 1):
            if len(line) > LONGEST_STEP_BYTES:
                what = f"has a line of over {LONGEST_STEP_BYTES:,} bytes"
                raise OSError(errno.EFBIG, what, str(path))
            yield line


def _take(row: dict[str, Any], recorded: RecordedLatencies) -> None:
    worker = row["worker"]
    if "lost" in row:
        if type(row["t_ns"]) is not int:
            raise TypeError("its time is no whole number")
        recorded.losses[worker] = Loss(row["t_ns"], row["lost"])
        return
    seq = row["seq"]
    numbers = (seq, row["latency_ns"], row["outputs"], row["t_start_ns"])
    if not all(type(number) is int for number in (*numbers, row["wake_ns"] or 0)):
        raise TypeError("a number is no whole one")
    recorded.latencies_ns.setdefault(worker, {})[seq] = row["latency_ns"]
    recorded.outputs.setdefault(worker, {})[seq] = row["outputs"]
    recorded.wakes_ns.setdefault(worker, {})[seq] = row["wake_ns"]
    if "missed" in row:
        recorded.missed.setdefault(worker, {})[seq] = str(row["missed"])
    if not row["finished"]:
        due_ns = row["t_start_ns"] + row["latency_ns"]
        recorded.unfinished[worker] = UnfinishedStep(seq, due_ns)
