"""``latency.jsonl``: the steps of each worker, with wall times, apart from the log of the world."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path

from airhilt.errors import RunFolderError, disk_failed
from airhilt.sim import StepRecord


class LatencyLog:
    """Writes one line for each step.

    Whoever writes the log of the run as well flushes this one first: a step whose result is in the
    log of a run that was killed is then here too.
    """

    def __init__(self, path: Path) -> None:
        self._stream = path.open("w", encoding="utf-8")

    def step(self, record: StepRecord) -> None:
        """Write a step.

        Raises
        ------
        RunFolderError
            The disk is full or gone. The other methods raise the same.
        """
        self._write(
            f'{{"worker": "{record.worker}", "seq": {record.seq}, "t_in_ns": {record.t_in_ns}, '
            f'"t_start_ns": {record.t_start_ns}, "latency_ns": {record.latency_ns}, '
            f'"compute_s": {record.compute_s!r}, "outputs": {record.outputs}, '
            f'"wake_ns": {"null" if record.wake_ns is None else record.wake_ns}, '
            f'"finished": {"true" if record.finished else "false"}}}\n'
        )

    def lost(self, worker: str, t_ns: int, cause: str) -> None:
        """Write the loss of a worker."""
        row = {"worker": worker, "t_ns": t_ns, "lost": cause}
        self._write(json.dumps(row) + "\n")

    def _write(self, line: str) -> None:
        try:
            self._stream.write(line)
        except OSError as error:
            raise disk_failed(self._stream.name, error) from None

    def flush(self) -> None:
        """Hand all lines to the operating system, so that they outlive this process."""
        try:
            self._stream.flush()
        except OSError as error:
            raise disk_failed(self._stream.name, error) from None

    def close(self) -> None:
        """Close the file."""
        try:
            self._stream.close()
        except OSError as error:
            raise disk_failed(self._stream.name, error) from None


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
    losses: dict[str, Loss] = field(default_factory=dict)
    unfinished: dict[str, UnfinishedStep] = field(default_factory=dict)
    """The step that each worker had begun when it was lost, or when the run ended."""


def read_latencies(path: Path) -> RecordedLatencies:
    """Return the steps of a run, up to where the file breaks off.

    Raises
    ------
    RunFolderError
        The file cannot be read.
    """
    recorded = RecordedLatencies()
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise RunFolderError(f"{path}: cannot be read: {error.strerror}") from None
    for line in lines:
        try:
            row = json.loads(line)
        except json.JSONDecodeError:
            break
        worker = row["worker"]
        if "lost" in row:
            recorded.losses[worker] = Loss(row["t_ns"], row["lost"])
        else:
            seq = row["seq"]
            recorded.latencies_ns.setdefault(worker, {})[seq] = row["latency_ns"]
            recorded.outputs.setdefault(worker, {})[seq] = row["outputs"]
            recorded.wakes_ns.setdefault(worker, {})[seq] = row["wake_ns"]
            if not row["finished"]:
                due_ns = row["t_start_ns"] + row["latency_ns"]
                recorded.unfinished[worker] = UnfinishedStep(seq, due_ns)
    return recorded
