"""The decision workers of the examples and of the documentation save the aircraft they warn."""

from __future__ import annotations

import json
import re
import runpy
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from airhilt import load, run
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.metrics.result import Result
from airhilt.record import read_log
from breadth import mostly_slow
from notices import Notices
from paths import DOCS, EXAMPLES


def engine_of_the_page() -> Any:
    blocks = re.findall(r"```python\n(.*?)```", (DOCS / "your-assistant.md").read_text(), re.DOTALL)
    names: dict[str, Any] = {}
    exec(next(block for block in blocks if "class Nervous" in block), names)
    return names["Nervous"]()


def event_texts(result: Result, kind: str) -> Sequence[tuple[str, str]]:
    events = [
        json.loads(logged.data)
        for logged in read_log(result.folder / "log.mcap")
        if logged.key == "truth/event"
    ]
    return [(event["subject"], event["text"]) for event in events if event["kind"] == kind]


@pytest.mark.parametrize(
    "source", mostly_slow(["sdk_worker.py", "your-assistant.md"], "your-assistant.md")
)
def test_a_worker_of_the_examples_keeps_separation(source: str, tmp_path: Path) -> None:
    worker: Any
    if source == "your-assistant.md":
        worker = DecisionWorker(engine_of_the_page(), Template(), name="mine")
    else:
        worker = runpy.run_path(str(EXAMPLES / source))["SimpleWorker"]()
    observer = Notices()
    options: Any = {"latency": "fixed:0.2", "speech": False, "cameras": False, "workers": [worker]}
    result = run(load("s02a_headon"), out=tmp_path / "run", observer=observer, **options)
    assert result.summary.avoided
    assert {subject for subject, _ in event_texts(result, "pilot_reacts")} == {"AAL123", "DAL456"}
    assert observer.texts == []


@pytest.mark.slow
def test_the_crews_return_to_their_levels_when_the_conflict_is_over(tmp_path: Path) -> None:
    worker = runpy.run_path(str(EXAMPLES / "sdk_worker.py"))["SimpleWorker"]()
    scenario = load("s02a_headon").model_copy(update={"end_when": ()})
    options: Any = {"latency": "fixed:0.2", "speech": False, "cameras": False, "workers": [worker]}
    result = run(scenario, out=tmp_path / "run", **options)
    resumed = [text for _, text in event_texts(result, "pilot_reacts") if "resumes" in text]
    assert len(resumed) == 2
