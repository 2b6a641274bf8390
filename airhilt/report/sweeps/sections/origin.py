"""Origin of a sweep: its specification, the software that ran it, and its cost."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from airhilt.host.files import sha256
from airhilt.metrics.measures import HOUR_S
from airhilt.report.figures import Figures
from airhilt.report.sweeps.data import SweepData
from airhilt.report.sweeps.sections import SweepSection
from airhilt.report.sweeps.words import number

if TYPE_CHECKING:
    from pandas import DataFrame


def content(sweep: SweepData, figures: Figures) -> dict[str, Any]:  # noqa: ARG001
    """Return the specification, and names and values of the rest."""
    rest = {name: value for name, value in sweep.info.items() if name != "specification"}
    specification = sweep.info.get("specification", {})
    return {
        "specification": json.dumps(specification, indent=2, ensure_ascii=False),
        "facts": [
            {"name": name, "value": value}
            for name, value in (
                ("SHA-256 of sweep.parquet", sha256(sweep.folder.table_path)),
                *_costs(sweep.machine),
                *_flat(rest),
            )
        ],
    }


def _costs(machine: DataFrame) -> Iterator[tuple[str, str]]:
    for name, column in (("CPU time", "cpu_s"), ("time of the runs, added up", "wall_s")):
        if column in machine and machine[column].notna().any():
            yield name, f"{number(float(machine[column].sum()) / HOUR_S)} h"
    if "peak_memory_mb" in machine and machine["peak_memory_mb"].notna().any():
        yield "most memory of a worker", f"{number(float(machine['peak_memory_mb'].max()))} MB"
    if "host" in machine:
        hosts = sorted(machine["host"].dropna().unique())
        yield "machines", ", ".join(filter(None, hosts)) or "not known"


def _flat(given: Any, path: str = "") -> Iterator[tuple[str, str]]:
    if isinstance(given, dict):
        for name, value in given.items():
            yield from _flat(value, f"{path} {name}".strip())
    else:
        text = given if isinstance(given, str) else json.dumps(given, ensure_ascii=False)
        yield path.replace("_", " "), text


SECTION = SweepSection("origin", order=80, module=__file__, content=content)
