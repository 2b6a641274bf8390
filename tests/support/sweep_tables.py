"""Folders of sweeps that never ran: tables by the contract, with numbers that look like results."""

from __future__ import annotations

import hashlib
import itertools
import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from airhilt.metrics.columns import Column, column_of, metric_columns
from airhilt.record.manifest import digest

TYPES = {
    "string": pa.string(), "bool": pa.bool_(), "int64": pa.int64(), "float64": pa.float64(),
}  # fmt: skip
IDENTITY = tuple(
    column_of(name, "string", name) for name in ("key", "scenario", "family", "assistant")
)
SEED = Column("seed", "int64", "", "seed of the run")
ENDING = tuple(column_of(name, "string", name) for name in ("status", "cause"))
MACHINE = (
    *(column_of(name, "string", name) for name in ("key", "status", "cause", "host", "folder")),
    *(column_of(name, "float64", name) for name in ("cpu_s", "wall_s", "peak_memory_mb")),
)
Row = dict[str, Any]


def table(columns: Sequence[Column], rows: Iterable[Row]) -> pa.Table:
    """Return rows as a table whose fields have units and descriptions."""
    given = list(rows)
    fields = [
        pa.field(each.name, TYPES[each.type],
                 metadata={"unit": each.unit, "description": each.description})
        for each in columns
    ]  # fmt: skip
    arrays = [pa.array([row.get(each.name) for row in given], TYPES[each.type]) for each in columns]
    return pa.table(arrays, schema=pa.schema(fields))


def sweep_row(scenario: str, assistant: str, seed: int, **given: Any) -> Row:
    """Return the row of a run that finished: parameters and metrics as given."""
    identity = {"scenario": scenario, "assistant": assistant, "seed": seed}
    content = json.dumps(
        [identity, {k: v for k, v in given.items() if "." in k or k in PARAMETERS}]
    )
    family = scenario.partition("_")[0] if "_" in scenario else ""
    return {
        "key": hashlib.sha256(content.encode()).hexdigest(), "family": family,
        "status": "finished", "cause": "", "duration_s": 120.0, "nominal": False,
        "nuisance_alerts": 0, "clarifications": 0, **identity, **given,
    }  # fmt: skip


PARAMETERS: dict[str, Column] = {
    "snr_db": column_of("snr_db", "float64", "signal-to-noise ratio"),
    "visibility_m": column_of("visibility_m", "float64", "visibility"),
    "latency": column_of("latency", "string", "latency source"),
}


def write_sweep(folder: Path, rows: Sequence[Row], ended: Sequence[Row] = (), **info: Any) -> Path:
    """Write a sweep folder; ``ended`` are rows of runs that a limit ended."""
    folder.mkdir(parents=True, exist_ok=True)
    used = [each for name, each in PARAMETERS.items() if any(name in row for row in rows)]
    columns = (*IDENTITY, SEED, *used, *ENDING, *metric_columns())
    pq.write_table(
        table(columns, sorted(rows, key=lambda row: str(row["key"]))), folder / "sweep.parquet"
    )
    cost = {"cpu_s": 2.0, "wall_s": 3.0, "peak_memory_mb": 400.0, "host": "lab1", "folder": ""}
    machine = [{**cost, **{k: row[k] for k in row if k in ("key", "status", "cause", "folder")}}
               for row in (*rows, *ended)]  # fmt: skip
    pq.write_table(table(MACHINE, machine), folder / "machine.parquet")
    document = {"format": 1, "specification": {"scenarios": ["s01a_*"]}, "runs": len(machine)}
    document |= info
    (folder / "sweep.json").write_text(json.dumps(document | {"digest": digest(document)}))
    return folder


def grid(
    scenarios: Sequence[str],
    assistants: Sequence[str],
    seeds: int = 4,
    snrs: Sequence[float] = (0.0, 10.0, 20.0),
    visibilities: Sequence[float] = (400.0, 1600.0, 10000.0),
) -> list[Row]:
    """Return rows in which more noise and less visibility make warnings later and fewer."""
    random = np.random.default_rng(0)
    rows = []
    for scenario, assistant, seed, snr, visibility in itertools.product(
        scenarios, assistants, range(seeds), snrs, visibilities
    ):
        strength = {"reference": 1.2, "paper": 0.0, "adsb_only": -0.6}.get(assistant, -9.0)
        chance = 1.0 / (1.0 + np.exp(-(strength + snr / 12.0 + np.log10(visibility / 1600.0))))
        is_nominal = "nominal" in scenario
        warned = None if is_nominal else bool(random.random() < chance)
        avoided = None if is_nominal else bool(warned and random.random() < 0.85)
        after_s = float(random.gamma(6.0, 1.3 + (20.0 - snr) / 40.0)) - 1.0 if warned else None
        rows.append(
            sweep_row(
                scenario, assistant, seed, snr_db=snr, visibility_m=visibility,
                nominal=is_nominal, warned=warned,
                warned_in_time=None if is_nominal else bool(warned and random.random() < 0.8),
                missed=None if is_nominal else not warned,
                avoided=avoided, lost=bool(not is_nominal and not avoided),
                time_to_first_warning_s=after_s,
                lead_before_closest_approach_s=None if after_s is None else 30.0 - after_s,
                nuisance_alerts=int(random.random() < 0.1), severity_max="WARNING",
                radio_wer=float(np.clip(0.5 - snr / 50 + random.normal(0, 0.05), 0, 1)),
                first_detection_range_m=float(min(visibility, 900) * random.uniform(0.3, 0.8)),
            )
        )  # fmt: skip
    return rows
