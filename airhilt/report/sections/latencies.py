"""The latencies of each stage and worker, and the inputs that were dropped."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterable
from typing import Any

from airhilt.record import RunFolder
from airhilt.record.latency import latency_lines
from airhilt.report.data import RunData
from airhilt.report.sections import Content, Section
from airhilt.units import SECOND_NS

Json = dict[str, Any]

BINS_PER_DECADE = 8
"""Number of bins of the histogram between 1 ms and 10 ms, and so on."""
LEAST_LATENCY_S = 1e-5
"""Latencies below this, in s, are counted in the first bin."""


class Latencies(Content):
    """A histogram of each worker's simulated latencies, in bins of equal ratio."""

    def as_json(self, run: RunData) -> list[Json]:
        """Return one object for each worker."""
        bins: dict[str, Counter[int]] = {}
        for worker, latency_s in finished_steps(run.folder, run.notes):
            bins.setdefault(worker, Counter())[_bin(latency_s)] += 1
        return [
            {
                "worker": worker,
                "n": counts.total(),
                "bins": [
                    {"from_s": _edge_s(index), "to_s": _edge_s(index + 1), "n": counts[index]}
                    for index in sorted(counts)
                ],
            }
            for worker, counts in bins.items()
        ]


def finished_steps(folder: RunFolder, notes: list[str]) -> Iterable[tuple[str, float]]:
    """Yield worker and latency from input to result in s, up to where the file breaks off."""
    try:
        for number, line in enumerate(latency_lines(folder.latency_path), start=1):
            try:
                row = json.loads(line)
            except (ValueError, RecursionError):
                if line.endswith(b"\n"):
                    notes.append(f"latency.jsonl cannot be read from line {number} on.")
                return
            if row.get("finished"):
                waited_ns = row["t_start_ns"] - row["t_in_ns"]
                yield row["worker"], (waited_ns + row["latency_ns"]) / SECOND_NS
    except OSError as error:
        notes.append(f"latency.jsonl cannot be read: {error.strerror}.")


def _bin(latency_s: float) -> int:
    if latency_s <= LEAST_LATENCY_S:
        return 0
    return math.floor(math.log10(latency_s / LEAST_LATENCY_S) * BINS_PER_DECADE)


def _edge_s(index: int) -> float:
    return float(f"{LEAST_LATENCY_S * 10.0 ** (index / BINS_PER_DECADE):.4g}")


SECTION = Section("latencies", order=80, module=__file__, content=Latencies)
