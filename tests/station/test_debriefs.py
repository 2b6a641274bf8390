"""The list of runs that a station can show."""

from __future__ import annotations

import asyncio
import json
import shutil
import threading
from pathlib import Path
from typing import Any

import httpx
import pytest

from airhilt.errors import StationError
from airhilt.record import open_run
from airhilt.station.debriefs import Debriefs
from airhilt.station.home import home_app
from airhilt.station.scenario_choices import ScenarioChoices
from airhilt.station.started_runs import StartedRuns
from stations import PATIENCE_S, serving


def test_a_run_whose_record_cannot_be_read_is_left_out(recorded_run: Path, tmp_path: Path) -> None:
    shutil.copytree(recorded_run, tmp_path / "good")
    shutil.copytree(recorded_run, tmp_path / "bad")
    (tmp_path / "bad" / "run.json").write_bytes(b"[" * 100_000)
    (row,) = Debriefs(StartedRuns(tmp_path)).rows()
    assert row["name"] == "good"
    assert row["scenario"] == "encounter"
    assert row["phase"] == "finished"
    assert row["seats"] == []


@pytest.fixture
def run_with_a_person(run_copy: Path) -> Path:
    """The folder of a run with a person at a seat that has not ended, or was killed."""
    path = run_copy / "run.json"
    info = json.loads(path.read_text())
    info["options"]["seat"] = ["tower"]
    path.write_text(json.dumps(info | {"phase": "running"}))
    return run_copy


def test_the_truth_of_a_run_with_people_that_another_program_has_started_is_not_shown(
    run_with_a_person: Path,
) -> None:
    debriefs = Debriefs(StartedRuns(run_with_a_person.parent))
    try:
        with pytest.raises(StationError, match="goes on, with people at seats"):
            asyncio.run(debriefs.open((run_with_a_person.name,)))
    finally:
        debriefs.close()


def test_a_run_with_people_whose_process_was_killed_is_shown(run_with_a_person: Path) -> None:
    name, started = run_with_a_person.name, StartedRuns(run_with_a_person.parent)
    killed = {"name": name, "scenario": "s", "seats": ["tower"], "process": 2**22, "created_s": 0.0}
    (started.folder / ".station").mkdir()
    (started.folder / ".station" / f"{name}.json").write_text(json.dumps(killed))
    debriefs = Debriefs(started)
    try:
        assert asyncio.run(debriefs.open((run_with_a_person.name,))) == "/1/"
    finally:
        debriefs.close()


def test_a_run_that_takes_long_to_read_holds_up_no_other_and_not_the_end(
    recorded_run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("slow", "quick"):
        shutil.copytree(recorded_run, tmp_path / name)
    begun, go_on, reads = threading.Event(), threading.Event(), []

    def opened(path: Path, *given: Any) -> Any:
        reads.append((path.name, threading.current_thread().daemon))
        if path.name == "slow":
            begun.set()
            assert go_on.wait(PATIENCE_S)
        return open_run(path, *given)

    monkeypatch.setattr("airhilt.station.debriefs.open_run", opened)
    started = StartedRuns(tmp_path)
    debriefs = Debriefs(started)
    answers: list[httpx.Response] = []
    with serving(home_app(ScenarioChoices(()), started, debriefs, [])) as url:

        def ask(name: str) -> None:
            given = {"runs": [name]}
            answers.append(httpx.post(f"{url}api/debriefs", json=given, timeout=PATIENCE_S))

        waiting = [threading.Thread(target=ask, args=("slow",)) for _ in range(2)]
        for thread in waiting:
            thread.start()
        assert begun.wait(PATIENCE_S)
        ask("quick")
        assert answers[0].json() == {"url": "debriefs/1/"}
        assert httpx.get(f"{url}debriefs/1/api/run", timeout=PATIENCE_S).status_code == 200
        assert len(httpx.get(f"{url}api/runs", timeout=PATIENCE_S).json()["recorded"]) == 2
    for thread in waiting:  # The server has ended while the run is still read.
        thread.join(PATIENCE_S)
    assert {answer.status_code for answer in answers[1:]} == {503}
    assert sorted(reads) == [("quick", True), ("slow", True)]
    go_on.set()
    assert asyncio.run(debriefs.open(("slow",))) == "/2/"
    debriefs.close()
