"""Runs that did not finish, by their cause."""

from __future__ import annotations

from typing import Any

from airhilt.host.text import readable
from airhilt.report.figures import Figures
from airhilt.report.sweeps.data import SweepData
from airhilt.report.sweeps.sections import SweepSection

MOST_KEYS = 4
"""Greatest number of runs that are named for one cause."""


def content(sweep: SweepData, figures: Figures) -> dict[str, Any] | None:  # noqa: ARG001
    """Return how often each cause ended a run, and of which runs; None if all finished."""
    machine = sweep.machine
    failed = machine[machine["status"] != "finished"].fillna({"cause": ""})
    if failed.empty:
        return None
    scenarios = sweep.runs.set_index("key")["scenario"].to_dict()
    groups = failed.groupby(["status", "cause"], sort=True)
    rows = [
        {
            "status": str(status).replace("_", " "),
            "cause": readable(str(cause)),
            "count": len(group),
            "runs": [
                {"key": str(key)[:16], "scenario": scenarios.get(key, "")}
                for key in group["key"].head(MOST_KEYS)
            ],
        }
        for (status, cause), group in groups
    ]
    return {"rows": sorted(rows, key=lambda row: -row["count"])}


SECTION = SweepSection("failures", order=70, module=__file__, content=content)
