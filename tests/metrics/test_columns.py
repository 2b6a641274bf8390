"""A summary as one flat row: the same documented columns for every run."""

from __future__ import annotations

from typing import Any

import pytest

from airhilt.messages import Status
from airhilt.metrics.columns import (
    OF_PEOPLE,
    OF_REACTIONS,
    Column,
    metric_columns,
    metrics_of,
)
from airhilt.metrics.summary import (
    AdvisorySummary,
    ClosestApproach,
    Costs,
    LatencyStatistics,
    RadioStatistics,
    Summary,
    VisionStatistics,
)

NOT_MEASURED = LatencyStatistics.of([])
RADIO: dict[str, Any] = {
    name: None for name in RadioStatistics.model_fields if name not in ("hearing", "by_snr")
} | {"calls": 2, "words": 10, "wer": 0.25, "transmissions": 3, "blocked": 0, "repeats": 0,
     "stuck_microphone": 0, "say_agains": 0, "occupied_s": 9.0, "clarifications": 0, "by_snr": [],
     "hearing": {"understood": 2}}  # fmt: skip
COSTS = Costs(
    go_arounds=1, rejected_takeoffs=0, level_deviation_ft_s=500.0, path_deviation_nm_s=2.0,
    advisories_per_hour=30.0, advice_spoken_s=4.0,
)  # fmt: skip
VISION: dict[str, Any] = dict.fromkeys(VisionStatistics.model_fields) | {
    "latency": NOT_MEASURED, "by_size": [], "state": "on", "cause": "", "why_missed": "",
    "cameras": [], "first_detections": []}  # fmt: skip


def summary(**given: Any) -> Summary:
    """Return a summary of a run in which nothing happened, with some fields changed."""
    nothing: dict[str, Any] = {
        name: None for name, field in Summary.model_fields.items() if field.is_required()
    }
    nothing |= {
        "scenario": "s01a_tight_timing", "seed": 0, "assistant": "reference",
        "outcome": "finished", "duration_s": 120.0, "conflict_actors": ("AAL1", "DAL2"),
        "loss_of_separation": False, "nmac": False, "collision": False, "runway_incursions": [],
        "nuisance_alerts": 0, "advisories": [], "costs": COSTS, "radio": RADIO, "vision": VISION,
        "latencies": {}, "inputs_dropped": {}, "modalities": {"adsb": "on"}, "ended_actors": {},
        "real_time_factor": 1.0, "cpu_s": 1.0,
    }  # fmt: skip
    return Summary(**{**nothing, **given})


def advisory(severity: str) -> AdvisorySummary:
    return AdvisorySummary.model_validate(
        {
            "id": "a",
            "kind": "conflict",
            "traffic": (),
            "t_first_s": 1.0,
            "t_spoken_s": None,
            "severity": severity,
            "revisions": 1,
            "nuisance_to": [],
        }
    )


def test_every_modality_that_can_be_on_or_off_has_a_column() -> None:
    modalities = Status.model_json_schema()["properties"]["modality"]["enum"]
    assert "enhancement" in modalities
    assert {f"modalities_{name}" for name in modalities} <= {each.name for each in metric_columns()}


@pytest.mark.parametrize("columns", [metric_columns(), OF_PEOPLE.columns, OF_REACTIONS.columns])
def test_every_column_has_a_name_of_its_own_a_unit_and_a_description(
    columns: tuple[Column, ...],
) -> None:
    assert len({each.name for each in columns}) == len(columns)
    for each in columns:
        words = each.description.rpartition(": ")[2]
        assert words, each.name
        assert words != "None", each.name
        assert bool(each.unit) == (each.type in ("int64", "float64")), each.name


def test_a_row_has_exactly_the_columns_with_values_of_their_types() -> None:
    types = {"string": str, "bool": bool, "int64": int, "float64": float}
    row = metrics_of(summary(t_conflict_s=5, advisories=[advisory("CAUTION")]))
    assert list(row) == [each.name for each in metric_columns()]
    for each in metric_columns():
        value = row[each.name]
        assert value is None or type(value) is types[each.type], each.name


def test_models_within_models_and_stages_have_the_names_of_both() -> None:
    row = metrics_of(
        summary(
            closest_approach=ClosestApproach(t_s=1.0, horizontal_m=2.0, vertical_m=3.0),
            latencies={"asr": LatencyStatistics.of([1.0, 2.0]), "mine_step": NOT_MEASURED},
        )
    )
    assert row["closest_approach_vertical_m"] == 3.0
    assert row["latencies_asr_p50_s"] == 1.5
    assert row["latencies_tts_p50_s"] is None
    assert row["radio_wer"] == 0.25
    assert row["costs_level_deviation_ft_s"] == 500.0
    assert row["radio_hearing_understood"] == 2
    assert row["modalities_adsb"] == "on"
    assert not any("mine" in name for name in row)
