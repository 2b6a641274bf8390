"""The list of runs that a station can show."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from airhilt.errors import StationError
from airhilt.station.debriefs import Debriefs
from airhilt.station.started_runs import StartedRuns


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
            debriefs.open((run_with_a_person.name,))
    finally:
        debriefs.close()


def test_a_run_with_people_whose_process_was_killed_is_shown(run_with_a_person: Path) -> None:
    name, started = run_with_a_person.name, StartedRuns(run_with_a_person.parent)
    killed = {"name": name, "scenario": "s", "seats": ["tower"], "process": 2**22, "created_s": 0.0}
    (started.folder / ".station").mkdir()
    (started.folder / ".station" / f"{name}.json").write_text(json.dumps(killed))
    debriefs = Debriefs(started)
    try:
        assert debriefs.open((run_with_a_person.name,)) == "/1/"
    finally:
        debriefs.close()
