"""Sweeps with real workers: processes on this machine."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

import airhilt
from airhilt.cosim.replay import replay
from airhilt.metrics.columns import metrics_of
from airhilt.scenario import Scenario
from airhilt.sweep.engine import SweepObserver, SweepResult, sweep
from airhilt.sweep.outcome import Outcome
from airhilt.sweep.runner_process import Limits
from airhilt.sweep.specification import Specification, specification_of
from airhilt.sweep.work import Work
from shortened import shortened

OPTIONS: dict[str, Any] = {"speech": False, "latency": "lognormal:0.3"}
UNLIMITED = Limits(wall_s=300.0, memory_mb=4000.0)


class Noted(SweepObserver):
    """Keeps what it is told."""

    def __init__(self) -> None:
        self.outcomes: list[Outcome] = []
        self.notices: list[str] = []

    def ended(self, outcome: Outcome) -> None:
        self.outcomes.append(outcome)

    def notice(self, text: str) -> None:
        self.notices.append(text)


@pytest.fixture(scope="session")
def scenario_file(encounter: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Some seconds of an encounter whose drawn speeds are out of range with some seeds."""
    document = shortened(encounter.model_dump(mode="json"), 6.0) | {"name": "short"}
    document["perturbations"] = [
        {
            "path": "actors/AAL123/initial/cas_kt",
            "distribution": {"type": "uniform", "limit": 78.0},
        }
    ]
    path = tmp_path_factory.mktemp("scenario") / "short.json"
    path.write_text(json.dumps(document))
    return path


def specification(scenario: Path, **fields: Any) -> Specification:
    return specification_of(
        {
            "scenarios": [str(scenario)],
            "seeds": {"from": 0, "to": 3, "step": 1},
            "options": OPTIONS,
            "axes": {"assistant": ["reference", "none"]},
            **fields,
        },
        "test",
    )


@pytest.fixture(scope="session")
def done(scenario_file: Path, tmp_path_factory: pytest.TempPathFactory) -> SweepResult:
    """A sweep of eight runs by two workers, of which three run folders are kept, if they ran."""
    out = tmp_path_factory.mktemp("sweeps") / "two"
    return sweep(
        specification(scenario_file), Work(out, UNLIMITED, workers=2, sample=3), SweepObserver()
    )


def rows(result: SweepResult) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = result.folder.table().to_pylist()
    return found


def test_every_run_is_a_row_sorted_by_parameters_and_seed(done: SweepResult) -> None:
    expected = [(assistant, seed) for assistant in ("none", "reference") for seed in range(4)]
    assert [(row["assistant"], row["seed"]) for row in rows(done)] == expected
    of_keys = [row["key"] for row in done.folder.machine().to_pylist()]
    assert of_keys == [row["key"] for row in rows(done)]
    assert (done.runs, done.rows, done.missing) == (8, 8, 0)


def test_a_row_has_the_numbers_of_the_run_itself(
    done: SweepResult, scenario_file: Path, tmp_path: Path
) -> None:
    """No run leaves anything to the next, so the last one of a worker is as the first."""
    finished = [row for row in rows(done) if row["status"] == "finished"]
    assert len(finished) >= 4
    for row in finished:
        alone = airhilt.run(
            scenario_file,
            out=tmp_path / row["key"],
            seed=row["seed"],
            assistant=row["assistant"],
            **OPTIONS,
        )
        metrics = metrics_of(alone.summary)
        assert {name: row[name] for name in metrics} == metrics


def test_a_run_that_fails_is_a_row_with_its_cause(done: SweepResult) -> None:
    failed = [row for row in rows(done) if row["status"] == "failed"]
    assert failed
    assert done.failed == len(failed)
    assert all("short" in row["cause"] for row in failed)
    assert all(row["avoided"] is None and row["duration_s"] is None for row in failed)


def test_the_table_says_units_and_meanings_and_nothing_of_the_machine(done: SweepResult) -> None:
    schema = done.folder.table().schema
    assert all(field.metadata[b"description"] for field in schema)
    assert schema.field("duration_s").metadata[b"unit"] == b"s"
    assert not {"cpu_s", "wall_s", "real_time_factor", "host"} & set(schema.names)
    machine = {row["key"]: row for row in done.folder.machine().to_pylist()}
    assert machine.keys() == {row["key"] for row in rows(done)}
    assert all(row["cpu_s"] > 0.0 and row["peak_memory_mb"] > 50.0 for row in machine.values())


@pytest.mark.slow
def test_sampled_runs_are_kept_whole_and_can_be_replayed(done: SweepResult) -> None:
    kept = [row["folder"] for row in done.folder.machine().to_pylist() if row["folder"]]
    assert 1 <= len(kept) == len(list(done.folder.runs_path.iterdir())) <= 3
    assert replay(done.folder.path / kept[0]).identical


def test_the_same_again_runs_nothing_and_has_the_same_bytes(
    done: SweepResult, scenario_file: Path
) -> None:
    before, observer = done.folder.table_path.read_bytes(), Noted()
    sweep(specification(scenario_file), Work(done.folder.path, UNLIMITED, workers=2), observer)
    assert observer.outcomes == []
    assert done.folder.table_path.read_bytes() == before


@pytest.mark.slow
def test_one_worker_gives_the_bytes_of_two(
    done: SweepResult, scenario_file: Path, tmp_path: Path
) -> None:
    """The seeds come in another order, and some of them in an earlier sweep into the folder."""
    work, observer = Work(tmp_path / "one", UNLIMITED, workers=1), Noted()
    sweep(specification(scenario_file, seeds=[2]), work, observer)
    assert len(observer.outcomes) == 2
    again = sweep(specification(scenario_file, seeds=[3, 2, 1, 0]), work, observer)
    assert len(observer.outcomes) == 8
    assert again.folder.table_path.read_bytes() == done.folder.table_path.read_bytes()


def test_a_sweep_that_was_killed_goes_on_where_it_was(
    done: SweepResult, scenario_file: Path, tmp_path: Path
) -> None:
    out, options = tmp_path / "killed", tmp_path / "options.json"
    options.write_text(json.dumps({"format": 1, "options": OPTIONS}))
    command = [
        *(sys.executable, "-m", "airhilt", "sweep", "--scenario", str(scenario_file)),
        *("--seeds", "4", "--assistant", "reference,none", "--workers", "1"),
        *("--file", str(options), "--out", str(out), "--quiet"),
    ]
    with subprocess.Popen(command, start_new_session=True) as process:
        until = time.monotonic() + 120.0
        while not any(out.glob("parts/*.parquet")) and time.monotonic() < until:
            time.sleep(0.02)
        os.killpg(process.pid, signal.SIGKILL)
    left = len(list(out.glob("parts/*.parquet")))
    assert 0 < left < 8
    table = out / "sweep.parquet"
    assert not table.exists()
    finished = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (finished.returncode, finished.stdout) == (0, "")
    assert all("failed: short" in line for line in finished.stderr.splitlines())
    assert table.read_bytes() == done.folder.table_path.read_bytes()
