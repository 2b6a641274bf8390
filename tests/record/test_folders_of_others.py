"""A folder of somebody else leads neither reading nor writing to files outside of it."""

from __future__ import annotations

import os
import shutil
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest

from airhilt.errors import RunFolderError
from airhilt.host.files import make_folder, read_inside, replace_file
from airhilt.record import RunFolder
from airhilt.record.sweep_folder import SweepFolder
from airhilt.station.started_runs import StartedRun, StartedRuns
from radio_folder import busy_radio
from sweep_tables import grid, sweep_row, write_sweep

PRECIOUS = "export PATH\n"


@pytest.fixture
def outside(tmp_path: Path) -> Path:
    """A file of the user's, outside of all folders."""
    path = tmp_path / "home" / ".bashrc"
    path.parent.mkdir()
    path.write_text(PRECIOUS)
    return path


def lead_out(folder: Path, outside: Path, *names: str) -> None:
    """Put links to a file in the place of files, and of those that are being written."""
    for name in names:
        for link in (folder / name, folder / f"{name}.partial"):
            link.unlink(missing_ok=True)
            link.symlink_to(outside)


# --- writing --------------------------------------------------------------------------------


def test_a_file_is_written_in_the_place_of_a_link_and_not_through_it(
    tmp_path: Path, outside: Path
) -> None:
    lead_out(tmp_path, outside, "page.html")
    replace_file(tmp_path / "page.html", b"page")
    assert not (tmp_path / "page.html").is_symlink()
    assert (tmp_path / "page.html").read_bytes() == b"page"
    assert outside.read_text() == PRECIOUS


def test_a_folder_that_is_a_link_is_not_written_into(tmp_path: Path, outside: Path) -> None:
    (tmp_path / "audio").symlink_to(outside.parent)
    with pytest.raises(OSError, match="a link"):
        make_folder(tmp_path / "audio")


@pytest.mark.parametrize(
    ("names", "arguments"),
    [
        (["report.html"], ["report", "run"]),
        (["page.html"], ["report", "run", "--out", "run/page.html"]),
        (["people.csv"], ["report", "run", "--csv", "run/people.csv"]),
        (["page.html"], ["compare", "run", "run", "--out", "run/page.html"]),
    ],
    ids=lambda given: given[0],
)
def test_what_a_command_writes_into_a_run_folder_stays_in_it(
    airhilt_command: Any, run_copy: Path, outside: Path, names: list[str], arguments: list[str]
) -> None:
    lead_out(run_copy, outside, *names)
    done = airhilt_command(*arguments)
    assert "Traceback" not in done.stderr
    assert outside.read_text() == PRECIOUS


def test_what_is_written_into_a_sweep_folder_stays_in_it(
    airhilt_command: Any, tmp_path: Path, outside: Path
) -> None:
    folder = write_sweep(tmp_path / "sweep", [sweep_row("s01a_tight_timing", "reference", 0)])
    lead_out(folder, outside, "report.html", "runs.csv")
    assert airhilt_command("report", folder, "--csv", folder / "runs.csv").returncode == 0
    assert airhilt_command("report", folder).returncode == 0
    assert outside.read_text() == PRECIOUS
    assert (folder / "runs.csv").read_text().startswith('"')


def test_figures_are_not_written_through_a_link(
    airhilt_command: Any, tmp_path: Path, outside: Path
) -> None:
    rows = [sweep_row("s01a_x", "reference", n, snr_db=9.0 * n, avoided=True) for n in range(2)]
    folder = write_sweep(tmp_path / "sweep", rows)
    (folder / "figures").symlink_to(outside.parent)
    done = airhilt_command("report", folder)
    assert done.returncode == 2
    assert "figures: cannot be written: a link" in done.stderr
    assert list(outside.parent.iterdir()) == [outside]


@pytest.mark.parametrize("name", ["audio", "pictures", "video"])
def test_a_run_is_not_replaced_where_a_link_leads_elsewhere(
    airhilt_command: Any, encounter_file: Path, run_copy: Path, tmp_path: Path, name: str
) -> None:
    music = tmp_path / "music"
    music.mkdir()
    files = [music / f"mine.{suffix}" for suffix in ("wav", "png", "jpg", "mp4")]
    for file in files:
        file.touch()
    (run_copy / name).symlink_to(music)
    done = airhilt_command("cosim", "--scenario", encounter_file, "--out", run_copy, "--overwrite")
    assert done.returncode == 2
    assert f"{name}: a link" in done.stderr
    assert sorted(music.iterdir()) == sorted(files)


@pytest.mark.parametrize("name", ["parts", "runs", "figures"])
def test_a_sweep_does_not_begin_where_a_link_leads_elsewhere(
    tmp_path: Path, outside: Path, name: str
) -> None:
    folder = SweepFolder(tmp_path / "sweep")
    folder.create()
    if name == "parts":
        (folder.parts_path / ".lock").unlink()
        folder.parts_path.rmdir()
    (folder.path / name).symlink_to(outside.parent)
    with pytest.raises(Exception, match=f"{name}: a link"):
        folder.create()
    assert list(outside.parent.iterdir()) == [outside]


def test_the_lock_of_a_sweep_empties_no_file_behind_a_link(tmp_path: Path, outside: Path) -> None:
    folder = SweepFolder(tmp_path / "sweep")
    folder.create()
    lead_out(folder.parts_path, outside, ".lock")
    with pytest.raises(Exception, match="cannot be written"), folder.locked():
        pass
    assert outside.read_text() == PRECIOUS


def test_tables_of_a_sweep_are_written_in_the_place_of_links(tmp_path: Path, outside: Path) -> None:
    folder = SweepFolder(tmp_path / "sweep")
    folder.create()
    lead_out(folder.path, outside, "sweep.parquet", "machine.parquet", "sweep.json")
    table = pa.table({"key": ["a"], "status": ["finished"], "folder": [""]})
    folder.write_tables(table, table, {"format": 1, "grid_sha256": "a"})
    assert outside.read_text() == PRECIOUS
    assert folder.table().num_rows == 1


def test_threads_and_processes_that_write_one_file_leave_it_whole(tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    contents = [bytes([65 + number]) * 10_000 for number in range(8)]
    for pool in (ThreadPoolExecutor(8), ProcessPoolExecutor(2, mp_context=get_context("spawn"))):
        with pool:
            list(pool.map(replace_file, [path] * 80, contents * 10))
    assert path.read_bytes() in contents
    assert list(tmp_path.iterdir()) == [path]


# --- reading --------------------------------------------------------------------------------


def test_a_file_inside_is_read_and_others_are_not(tmp_path: Path, outside: Path) -> None:
    folder = tmp_path / "run"
    (folder / "audio").mkdir(parents=True)
    (folder / "audio" / "call.wav").write_bytes(b"sound")
    (folder / "link").symlink_to(outside)
    (folder / "home").symlink_to(outside.parent)
    (folder / "inside").symlink_to(folder / "audio" / "call.wav")
    os.mkfifo(folder / "pipe")
    assert read_inside(folder, folder / "audio" / "call.wav", 5) == b"sound"
    for name in ("link", "home/.bashrc", "inside", "pipe", "audio", "audio/../../home/.bashrc"):
        with pytest.raises(OSError, match="no regular file of its folder"):
            read_inside(folder, folder / name, 5)
    with pytest.raises(FileNotFoundError):
        read_inside(folder, folder / "nothing", 5)


@pytest.mark.parametrize("name", ["audio", "call.wav"])
def test_a_link_that_comes_while_a_file_is_opened_is_not_followed(
    tmp_path: Path, outside: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    folder, real_open = tmp_path / "run", os.open
    file = folder / "audio" / "call.wav"
    file.parent.mkdir(parents=True)
    file.write_bytes(b"sound")
    (outside.parent / "call.wav").write_text(PRECIOUS)

    def swap(path: Any, *rest: Any, **more: Any) -> int:
        place = file if name == file.name else file.parent
        if path == name and not place.is_symlink():
            place.rename(tmp_path / "moved")
            place.symlink_to(outside if place == file else outside.parent)
        return real_open(path, *rest, **more)

    monkeypatch.setattr(os, "open", swap)
    with pytest.raises(OSError, match="no regular file of its folder"):
        read_inside(folder, file, 100)


@pytest.mark.parametrize(
    ("name", "command"),
    [
        ("log.mcap", "report"),
        ("latency.jsonl", "replay"),
        ("summary.json", "report"),
        ("run.json", "verify"),
    ],
)
def test_a_link_in_the_place_of_a_file_of_a_run_is_named(
    airhilt_command: Any, run_copy: Path, tmp_path: Path, name: str, command: str
) -> None:
    shutil.move(run_copy / name, tmp_path / name)
    (run_copy / name).symlink_to(tmp_path / name)
    done = airhilt_command(command, run_copy)
    assert "Traceback" not in done.stderr
    assert f"{name}: " in done.stdout + done.stderr
    assert "no regular file of its folder" in done.stdout + done.stderr


@pytest.mark.parametrize("kind", ["link", "pipe"])
def test_sound_that_is_no_file_of_the_run_is_named_and_not_read(
    airhilt_command: Any, tmp_path: Path, kind: str
) -> None:
    folder = busy_radio(tmp_path / "radio")
    sound = folder / "audio" / "clearance.wav"
    shutil.move(sound, tmp_path / sound.name)
    os.mkfifo(sound) if kind == "pipe" else sound.symlink_to(tmp_path / sound.name)
    done = airhilt_command("listen", folder)
    assert done.returncode == 2
    assert "clearance.wav: cannot be read: no regular file of its folder" in done.stderr
    assert airhilt_command("report", folder).returncode == 0
    assert "The sound of 1 calls" in (folder / "report.html").read_text()


@pytest.mark.parametrize("kind", ["link", "pipe", "folder"])
def test_a_table_of_a_sweep_that_is_no_file_of_it_is_named(
    airhilt_command: Any, tmp_path: Path, kind: str
) -> None:
    folder = write_sweep(tmp_path / "sweep", grid(["s01a_tight_timing"], ["reference"]))
    table = folder / "sweep.parquet"
    shutil.move(table, tmp_path / table.name)
    match kind:
        case "link":
            table.symlink_to(tmp_path / table.name)
        case "pipe":
            os.mkfifo(table)
        case "folder":
            table.mkdir()
            shutil.copy(tmp_path / table.name, table / "part.parquet")
    done = airhilt_command("report", folder)
    assert done.returncode == 2
    assert "sweep.parquet: damaged (" in done.stderr
    assert "no regular file of its folder" in done.stderr


def test_a_station_passes_over_pipes_in_the_place_of_its_files(tmp_path: Path) -> None:
    kept = tmp_path / ".station"
    kept.mkdir()
    os.mkfifo(kept / "pipe.json")
    started = StartedRuns(tmp_path)
    assert started.runs() == []
    run = StartedRun(name="run", scenario="s", seats=(), process=1, created_s=0.0)
    os.mkfifo(kept / "run.txt")
    assert started.url(run) == ""


# --- folders that are none ---------------------------------------------------------------------


def test_a_folder_below_a_file_is_refused_before_anything_is_made(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(RunFolderError, match="file is no folder that you may write in"):
        RunFolder(tmp_path / "file" / "run").require_free()


def test_a_folder_with_files_that_are_no_run_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "letter.txt").touch()
    with pytest.raises(RunFolderError, match="holds files that are no run"):
        RunFolder(tmp_path).require_free(overwrite=True)
