"""Parquet: one table for each frame of a run."""

from __future__ import annotations

from pathlib import Path

from airhilt.metrics.result import Result


def write(run: Result, out: Path) -> list[Path]:
    """Write each frame as a Parquet table, with its index, units and descriptions."""
    files = []
    for name, frame in run.frames().items():
        files.append(out / f"{name}.parquet")
        frame.to_parquet(files[-1], compression="zstd")
    return files
