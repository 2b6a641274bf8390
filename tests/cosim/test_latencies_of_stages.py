"""A stage may have a latency source of its own, and a replay has the same one."""

from __future__ import annotations

import json
from collections import defaultdict
from pathlib import Path

import pytest

import airhilt
from airhilt.cosim.latency_presets import DECISION_S
from airhilt.units import SECOND_NS


def latencies_ns(folder: Path) -> dict[str, set[int]]:
    found: dict[str, set[int]] = defaultdict(set)
    for line in (folder / "latency.jsonl").read_text(encoding="utf-8").splitlines():
        record = json.loads(line)
        found[record["worker"]].add(record["latency_ns"])
    return found


@pytest.fixture(scope="module")
def warned(encounter: airhilt.Scenario) -> airhilt.Scenario:
    """The encounter until somebody was warned."""
    return encounter.model_copy(update={"duration_s": 6.0})


def test_only_the_named_stage_takes_the_time_that_is_given_for_it(
    warned: airhilt.Scenario, tmp_path: Path
) -> None:
    airhilt.run(
        warned, speech=False, out=tmp_path / "run", latency="fixed:0.1,decision=fixed:2",
    )  # fmt: skip
    found = latencies_ns(tmp_path / "run")
    assert found["decision"] == {2 * SECOND_NS}
    assert found["adsb"] == {SECOND_NS // 10}


@pytest.mark.parametrize("text", ["fixed,desision=fixed:2", "decicion=measured"])
def test_a_stage_that_is_not_there_is_refused_with_the_nearest(text: str) -> None:
    with pytest.raises(airhilt.AirhiltError, match="did you mean 'decision'"):
        airhilt.run("s02a_headon", latency=text)


def test_with_the_times_of_the_paper_only_steps_that_publish_take_the_language_model(
    warned: airhilt.Scenario, tmp_path: Path
) -> None:
    airhilt.run(warned, speech=False, out=tmp_path / "run", latency="paper")
    found = latencies_ns(tmp_path / "run")
    assert found["decision"] == {0, round(DECISION_S * SECOND_NS)}
