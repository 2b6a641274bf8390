"""What a sweep leaves in its folder, told apart by how its runs end; no run is run."""

from __future__ import annotations

import math
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar

import pytest

from airhilt.errors import AirhiltError
from airhilt.host.machine import available_cores
from airhilt.record.sweep_folder import SweepFolder
from airhilt.record.verification import verify
from airhilt.sweep import engine
from airhilt.sweep.engine import MOST_CRASHES, SweepObserver, SweepResult, sweep
from airhilt.sweep.environment import environment
from airhilt.sweep.estimate import estimate
from airhilt.sweep.outcome import Outcome, Request
from airhilt.sweep.specification import Specification, specification_of
from airhilt.sweep.work import Work
from made_up_runs import Ends, MadeUpRuns, outcome


def first(seeds: int) -> Specification:
    options = {"cameras": False, "speech": False, "latency": "fixed"}
    document = {"scenarios": ["s02a_headon"], "seeds": list(range(seeds)), "options": options}
    return specification_of(document, "test")


class Noted(SweepObserver):
    def __init__(self) -> None:
        self.notices: list[str] = []

    def notice(self, text: str) -> None:
        self.notices.append(text)


class Sweeps:
    """Sweeps into one folder, whose runs end as a test says."""

    def __init__(self, out: Path) -> None:
        self.out = out

    def run(self, ends: Ends, seeds: int = 2, **work: Any) -> tuple[SweepResult, list[str]]:
        """Return the result, and what the user is told."""
        observer, executors = Noted(), MadeUpRuns(ends).executors()
        asked = first(seeds), Work(self.out, **work), observer
        return sweep(*asked, executors=executors), observer.notices

    def seeds_of_tables(self) -> tuple[int, list[int]]:
        """Return how many seeds sweep.json asks for, and those of the table beside it."""
        folder = SweepFolder.open(self.out)
        asked = folder.info()["specification"]["seeds"]
        return len(asked), sorted(folder.table()["seed"].to_pylist())


@pytest.fixture
def sweeps(tmp_path: Path) -> Sweeps:
    return Sweeps(tmp_path / "sweep")


def finishes(request: Request) -> Outcome:
    return outcome(request.key)


def crashes(request: Request) -> Outcome:
    return outcome(request.key, "crashed", "No space left on device")


def fails(request: Request) -> Outcome:
    return outcome(request.key, "failed", "no such thing")


def test_a_sweep_without_a_run_that_finished_is_not_complete(sweeps: Sweeps) -> None:
    result, _ = sweeps.run(fails)
    assert (result.rows, result.failed, result.missing) == (2, 2, 0)
    assert not result.is_complete
    result, _ = sweeps.run(finishes, seeds=3)
    assert result.is_complete


def test_another_sweep_in_a_folder_is_told_and_replaces_tables_and_specification_at_once(
    sweeps: Sweeps,
) -> None:
    _, notices = sweeps.run(finishes)
    assert notices == []
    assert sweeps.seeds_of_tables() == (2, [0, 1])

    def looks(request: Request) -> Outcome:
        assert sweeps.seeds_of_tables() == (2, [0, 1])
        return finishes(request)

    _, notices = sweeps.run(looks, seeds=3)
    assert sweeps.seeds_of_tables() == (3, [0, 1, 2])
    (told,) = notices
    assert "holds another sweep, of 2 runs" in told
    assert len(told.splitlines()) == 1
    assert not SweepFolder(sweeps.out).next_info_path.exists()


def test_a_sweep_that_is_refused_leaves_tables_and_specification_as_they_were(
    sweeps: Sweeps,
) -> None:
    sweeps.run(finishes)
    with pytest.raises(ZeroDivisionError):
        sweeps.run(lambda _: 1 // 0, seeds=3)  # type: ignore[arg-type,return-value]
    assert sweeps.seeds_of_tables() == (2, [0, 1])


def test_crashes_are_no_results_and_are_done_again_when_asked(sweeps: Sweeps) -> None:
    result, notices = sweeps.run(crashes)
    assert (result.rows, result.failed, result.missing) == (0, 2, 0)
    assert any("2 runs ended by a crash or a limit" in each for each in notices)
    assert any("--retry" in each for each in notices)
    result, _ = sweeps.run(finishes)
    assert result.rows == 0
    result, notices = sweeps.run(finishes, retry=True)
    assert (result.rows, notices) == (2, [])
    assert result.is_complete


def test_a_full_disk_ends_a_sweep_and_leaves_the_rest_to_do(sweeps: Sweeps) -> None:
    seeds = MOST_CRASHES + 10
    result, notices = sweeps.run(crashes, seeds=seeds)
    assert MOST_CRASHES <= result.failed < seeds
    assert result.missing == seeds - result.failed
    assert any(f"ended after {MOST_CRASHES} crashes in a row" in each for each in notices)
    result, _ = sweeps.run(finishes, seeds=seeds, retry=True)
    assert result.rows == seeds


class Probe:
    """A runner whose run takes ten seconds; it notes the seeds of its runs."""

    seeds: ClassVar[list[int]] = []

    def __init__(self, *_: object) -> None:
        self.environment = environment("")
        self.seeds.clear()

    def run(self, request: Request) -> Outcome:
        self.seeds.append(int(str(request.options["seed"])))
        ended = outcome(request.key)
        return ended.model_copy(update={"machine": ended.machine.model_copy(update={"wall_s": 10})})

    def close(self) -> None:
        """Do nothing."""


def test_a_dry_run_tries_what_is_left_and_changes_nothing(
    sweeps: Sweeps, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    sweeps.run(finishes)
    (SweepFolder(sweeps.out).parts_path / "damaged.parquet").write_text("no table")
    before = {path: path.read_bytes() for path in sweeps.out.rglob("*") if path.is_file()}
    monkeypatch.setattr("airhilt.sweep.estimate.RunnerProcess", Probe)
    work = Work(sweeps.out, workers=1)
    found = estimate(first(4), work)
    assert (found.runs, found.finished, found.total_s, Probe.seeds) == (4, 2, 20.0, [2])
    found = estimate(first(2), work)
    assert (found.runs, found.finished, found.total_s, Probe.seeds) == (2, 2, 0.0, [])
    with_many = estimate(first(1002), replace(work, workers=1000))
    assert with_many.total_s == 10.0 * math.ceil(1000 / available_cores())
    elsewhere = estimate(first(4), replace(work, scheduler="tcp://127.0.0.1:1"))
    assert elsewhere.total_s is None
    assert before == {path: path.read_bytes() for path in sweeps.out.rglob("*") if path.is_file()}
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(AirhiltError, match="holds files that are no sweep"):
        estimate(first(2), Work(tmp_path))


@pytest.mark.parametrize(
    ("options", "shares"),
    [
        ({"latency": "fixed"}, True),
        ({"latency": "measured"}, False),
        ({"latency": "fixed", "cameras": False}, False),
    ],
)
def test_runs_share_pictures_where_it_changes_nothing(
    options: dict[str, Any], shares: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    runs = MadeUpRuns(finishes)
    monkeypatch.setattr(engine, "_own_environment", lambda *_: environment(""))
    asked = {"scenarios": ["s02a_headon"], "options": {"speech": False, **options}}
    work = Work(tmp_path / "sweep")
    sweep(specification_of(asked, "test"), work, executors=runs.executors())
    assert [each.options.get("share_pictures", False) for each in runs.asked] == [shares]


def test_the_tables_of_a_sweep_are_intact_until_they_are_written_anew(sweeps: Sweeps) -> None:
    sweeps.run(finishes)

    def looks(request: Request) -> Outcome:
        assert verify(sweeps.out).state == "unfinished"
        return finishes(request)

    before = verify(sweeps.out)
    sweeps.run(looks, seeds=3)
    after = verify(sweeps.out)
    assert [before.state, after.state] == ["intact", "intact"]
    assert before.additional == after.additional == ()


def test_a_sweep_joined_from_the_parts_of_two_machines_is_intact(
    sweeps: Sweeps, tmp_path: Path
) -> None:
    other = Sweeps(tmp_path / "other")
    sweeps.run(finishes, seeds=1)
    other.run(finishes, seeds=2)
    for part in SweepFolder(other.out).parts_path.glob("*.parquet"):
        shutil.copy(part, SweepFolder(sweeps.out).parts_path)
    sweeps.run(crashes, seeds=2)
    assert sweeps.seeds_of_tables() == (2, [0, 1])
    assert verify(sweeps.out).state == "intact"


def test_a_run_folder_that_a_sweep_keeps_is_in_its_manifest(sweeps: Sweeps) -> None:
    def keeps(request: Request) -> Outcome:
        Path(request.folder).mkdir(parents=True)
        (Path(request.folder) / "run.json").write_text("{}")
        return finishes(request).model_copy(update={"is_kept": True})

    sweeps.run(keeps, keep="all")
    folder = SweepFolder(sweeps.out)
    runs = {f"{name}/run.json" for name in folder.machine()["folder"].to_pylist()}
    assert folder.files().keys() == {"sweep.parquet", "machine.parquet"} | runs
    assert len(runs) == 2
