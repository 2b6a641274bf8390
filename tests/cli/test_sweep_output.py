"""Texts of a sweep on the terminal."""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from airhilt.cli.sweep_output import print_estimate
from airhilt.record.sweep_folder import SweepFolder
from airhilt.sweep.engine import SweepResult
from airhilt.sweep.estimate import Estimate
from airhilt.sweep.specification import Specification
from airhilt.sweep.work import Work


@pytest.fixture
def _stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let sweeps end with two of three runs still to do."""

    def sweep(_specification: Specification, work: Work, _observer: object) -> SweepResult:
        return SweepResult(SweepFolder(work.out), runs=3, rows=1, failed=0, missing=2)

    monkeypatch.setattr("airhilt.sweep.engine.sweep", sweep)


def to_do(printed: str) -> list[str]:
    """Return the command that a sweep says for what is still to do, from ``sweep`` on."""
    (line,) = [line for line in printed.splitlines() if line.startswith("still to do: 2 runs")]
    words = shlex.split(line.partition(", with ")[2])
    return words[words.index("sweep") :]


@pytest.mark.usefixtures("_stopped")
def test_what_is_left_is_done_by_the_command_that_is_told(airhilt_command: Any) -> None:
    given = ("sweep", "--scenario", "s01a_*", "--seeds", "3")
    done = airhilt_command(*given)
    arguments = to_do(done.stdout)
    assert tuple(arguments[: len(given)]) == given
    assert arguments[len(given)] == "--out"
    assert Path(arguments[-1]).parent == Path("sweeps")
    assert f"--out {arguments[-1]}" in done.stderr
    again = airhilt_command(*arguments)
    assert to_do(again.stdout) == arguments


@pytest.mark.usefixtures("_stopped")
def test_a_quiet_sweep_says_nothing(airhilt_command: Any) -> None:
    done = airhilt_command("sweep", "--scenario", "s02a_headon", "--quiet")
    assert (done.stdout, done.stderr) == ("", "")


@pytest.mark.parametrize("command", [
    ("sweep", "--scenario", "x"),
    pytest.param(("evaluate", "--preset=paper", "--no-cameras"), marks=pytest.mark.slow),
])  # fmt: skip
def test_a_dry_run_says_first_that_it_does_a_run(
    command: tuple[str, ...], airhilt_command: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = Estimate(runs=1, finished=0, run_s=2.0, run_mb=300.0, workers=1, at_once=1, total_s=2.0)
    monkeypatch.setattr("airhilt.sweep.estimate.estimate", lambda *_: found)
    assert "does one of those that are left" in airhilt_command(*command, "--dry-run").stderr
    assert airhilt_command(*command, "--dry-run", "--quiet").stderr == ""


def test_an_estimate_says_what_is_there_already(capsys: pytest.CaptureFixture[str]) -> None:
    some = Estimate(runs=5, finished=3, run_s=2.0, run_mb=300.0, workers=1, at_once=1, total_s=4.0)
    print_estimate(some, False)
    print_estimate(replace(some, finished=5, run_s=None, run_mb=None, total_s=0.0), False)
    assert capsys.readouterr().out == (
        "5 runs, 3 of them there already; one took 2.0 s and 300 MB, so about 4 s, 1 at a time "
        "for the 2 that are left\n"
        "5 runs, all of them there already\n"
    )


def test_an_estimate_for_a_cluster_tells_no_time(capsys: pytest.CaptureFixture[str]) -> None:
    asked = Estimate(5, 0, run_s=2.0, run_mb=300.0, workers=2, at_once=None, total_s=None)
    print_estimate(asked, False)
    told = capsys.readouterr().out
    assert "how long all take depends on the workers of the scheduler" in told
    assert "about" not in told
