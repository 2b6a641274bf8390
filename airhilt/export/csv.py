"""CSV: one table for each frame of a run."""

from __future__ import annotations

from pathlib import Path

from airhilt.metrics.result import Result


def write(run: Result, out: Path) -> list[Path]:
    """Write each frame as a CSV table, in which what is null is empty."""
    files = []
    for name, frame in run.frames().items():
        files.append(out / f"{name}.csv")
        frame.to_csv(files[-1])
    return files
