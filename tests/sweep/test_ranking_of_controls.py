"""No negative control is ranked above an assistant that looks, in encounters that are flown."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import airhilt
from airhilt.metrics.columns import metrics_of
from airhilt.sweep.evaluation.ranking import Tried, youden_index

pytestmark = pytest.mark.slow

ENCOUNTERS = {
    "s01": ("s01a_bad_readback", "s01a_tight_timing", "s01b_noncompliance"),
    "s02": ("s02a_headon", "s02a_vertical", "s02b_engine_out_driftdown"),
}
CONTROLS = ("silent", "cry_wolf", "cry_wolf:5", "cry_wolf:20")
"""The last two cite a call that was really made, and has nothing to do with a conflict."""


def flown(scenario: str, assistant: str, out: Path, *, twin: bool = False) -> dict[str, Any]:
    result = airhilt.run(
        scenario, out=out / scenario / f"{assistant.replace(':', '_')}{twin}", assistant=assistant,
        twin=twin, latency="fixed", cameras=False, speech=False, report=False,
    )  # fmt: skip
    found = metrics_of(result.summary.model_dump(mode="json"))
    return {"scenario": scenario, "seed": 0, **found}


@pytest.mark.parametrize(
    ("family", "assistants"), [("s01", ("reference", "paper")), ("s02", ("reference", "tcas"))]
)
def test_no_control_is_ranked_above_an_assistant(
    family: str, assistants: tuple[str, ...], tmp_path: Path
) -> None:
    nobody = [flown(name, "none", tmp_path) for name in ENCOUNTERS[family]]
    index: dict[str, float] = {}
    for assistant in (*assistants, *CONTROLS):
        tried = Tried(
            [flown(name, assistant, tmp_path) for name in ENCOUNTERS[family]],
            [flown(name, assistant, tmp_path, twin=True) for name in ENCOUNTERS[family]],
        )
        value = youden_index(tried, nobody).value
        assert value is not None
        index[assistant] = value
    assert index["silent"] == 0.0
    assert max(index[name] for name in CONTROLS) <= 0.0 <= min(index[name] for name in assistants)
    assert index["reference"] > 0.0
