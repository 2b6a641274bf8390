"""The validation against the paper covers its family, and shows warnings before the begin."""

from __future__ import annotations

from typing import Any

import pytest
from rich.console import Console

from airhilt.metrics.summary import Summary, WarningParts
from validate_paper import OVERALL, parts, statistics_of, times, variants


def warned(time_s: float) -> Summary:
    fields: dict[str, Any] = {
        "t_first_warning_s": 60.0 + time_s,
        "time_to_first_warning_s": time_s,
        "time_to_first_warning_after_call_s": time_s - 4.0,
        "first_warning_parts": WarningParts(
            speech_s=4.0, recognition_s=1.9, evidence_s=time_s - 7.2, decision_s=0.4, voice_s=0.9
        ),
    }
    return Summary.model_construct(**fields)


def test_all_variants_with_a_conflict_are_compared() -> None:
    assert "s01a_misaddressed_takeoff" in variants()
    assert "s01a_nominal" not in variants()
    assert all(name.startswith("s01a_") for name in variants())


def test_every_run_counts_once_in_the_row_over_all(capsys: pytest.CaptureFixture[str]) -> None:
    statistics = statistics_of({"one": [warned(8.0)], "two": [warned(7.0), warned(-3.0)]})
    assert statistics[OVERALL].runs == 3
    assert statistics[OVERALL].mean_s == pytest.approx(4.0)
    console = Console(width=140)
    console.print(times(statistics))
    console.print(parts(statistics))
    shown = capsys.readouterr().out
    assert "33%" in shown
    assert "-3.20" in shown
