"""The head of the page: what was run, over what, and how many runs there are of it."""

from __future__ import annotations

from typing import Any

from airhilt.report.figures import Figures
from airhilt.report.sweeps.axes import Axis
from airhilt.report.sweeps.data import SweepData
from airhilt.report.sweeps.sections import SweepSection

MOST_NAMES = 12
"""Greatest number of names that are shown one by one."""


def content(sweep: SweepData, figures: Figures) -> dict[str, Any]:  # noqa: ARG001
    """Return names and values."""
    runs, machine = sweep.runs, sweep.machine
    ended = machine["status"].value_counts().to_dict()
    finished = int(ended.pop("finished", 0))
    return {
        "finished": finished,
        "not_finished": [{"status": str(name).replace("_", " "), "count": int(count)}
                         for name, count in sorted(ended.items())],
        "facts": [
            {"name": "Scenarios", "value": _names(sorted(runs["scenario"].dropna().unique()))},
            {"name": "Assistants", "value": _names(sweep.assistants)},
            {"name": "Seeds", "value": str(runs["seed"].nunique())},
            *({"name": axis.label, "value": _levels(axis)}
              for axis in sweep.axes() if axis.name != "assistant"),
        ],
        "simulated_h": round(float(sweep.finished["duration_s"].sum()) / 3600.0, 1),
    }  # fmt: skip


def _names(names: list[str]) -> str:
    if len(names) > MOST_NAMES:
        return f"{len(names)}: {', '.join(names[:MOST_NAMES])} …"
    return ", ".join(names)


def _levels(axis: Axis) -> str:
    names = _names([level.label for level in axis.levels])
    is_binned = axis.distinct > len(axis.levels)
    return f"{axis.distinct} values, in bins {names}" if is_binned else names


SECTION = SweepSection("header", order=10, module=__file__, content=content)
