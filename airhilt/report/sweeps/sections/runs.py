"""The table of all runs, to sort and to filter."""

from __future__ import annotations

import math
from typing import Any

from airhilt.host.text import readable
from airhilt.report.figures import Figures
from airhilt.report.sweeps.data import SweepData
from airhilt.report.sweeps.sections import SweepSection

SHOWN = (
    "time_to_first_warning_s",
    "time_to_first_warning_after_window_s",
    "warned",
    "warned_in_time",
    "missed",
    "avoided",
    "lost",
    "lead_before_closest_approach_s",
    "nuisance_alerts",
    "radio_wer",
    "first_detection_range_m",
)
"""Metrics that the table shows at first."""
ON_REQUEST = (
    "nominal",
    "duration_s",
    "t_conflict_s",
    "t_first_warning_s",
    "margin_over_tcas_ta_s",
    "margin_over_tcas_ra_s",
    "closest_approach_horizontal_m",
    "closest_approach_vertical_m",
    "loss_of_separation",
    "nmac",
    "collision",
    "runway_incursion_category",
    "severity_max",
    "cautions",
    "warnings",
    "clarifications",
    "radio_callsign_accuracy",
    "radio_slot_accuracy",
    "vision_recall",
    "vision_false_per_minute",
    "first_detection_t_s",
    "latencies_asr_p50_s",
    "latencies_vision_p50_s",
    "latencies_decision_p50_s",
    "latencies_tts_p50_s",
    "cause",
)
"""Metrics that can be shown too; all others are in the Parquet file only."""
DIGITS = 6
"""Significant digits of a number in the page."""


def content(sweep: SweepData, figures: Figures) -> dict[str, Any]:  # noqa: ARG001
    """Return the columns with their values, and the folders of the runs that are kept."""
    runs, machine = sweep.runs, sweep.machine
    always = ("scenario", "assistant", "seed", *sweep.parameters, "status", *SHOWN)
    names = [
        name
        for name in dict.fromkeys((*always, *ON_REQUEST))
        if name in runs.columns and (name in always or runs[name].notna().any())
    ]
    kept = machine[machine["folder"].fillna("") != ""].set_index("key")["folder"].to_dict()
    return {
        "columns": [
            {
                "name": name,
                **sweep.columns[name],
                "shown": name in always,
                "values": [
                    _value(value)
                    for value in runs[name].astype(object).where(runs[name].notna(), None)
                ],
            }
            for name in names
        ],
        "keys": [str(key)[:16] for key in runs["key"]],
        "links": [_link(sweep, kept.get(key, "")) for key in runs["key"]],
    }


def _value(value: Any) -> Any:
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None
    return readable(value) if isinstance(value, str) else value


def _link(sweep: SweepData, folder: str) -> str:
    path = sweep.folder.path / folder
    if not folder or not path.resolve().is_relative_to(sweep.folder.path.resolve()):
        return ""
    page = path / "report.html"
    return sweep.link_to(page) if page.is_file() else f"{sweep.link_to(path)}/"


SECTION = SweepSection("runs", order=60, module=__file__, content=content)
