"""The folder of a sweep: nothing that was finished is lost."""

from __future__ import annotations

import errno
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest

from airhilt.errors import AirhiltError
from airhilt.host.files import replace_file
from airhilt.record import sweep_folder
from airhilt.record.sweep_folder import MOST_PARTS, SweepFolder


@pytest.fixture
def folder(tmp_path: Path) -> SweepFolder:
    made = SweepFolder(tmp_path / "sweep")
    made.create()
    made.write_tables(run("before"), run("before"), INFO)
    return made


def run(key: str, value: float = 0.5) -> pa.Table:
    return pa.table({"key": [key], "status": ["finished"], "value": [value], "folder": [""]})


SCHEMA = run("").schema
INFO = {"format": 1, "grid_sha256": "a"}


def finished(folder: SweepFolder) -> tuple[list[str], list[str]]:
    """Return the keys of the finished runs, and what is told."""
    told: list[str] = []
    table = folder.finished(SCHEMA, told.append)
    assert table.schema.equals(SCHEMA)
    return sorted(table["key"].to_pylist()), told


def keys(folder: SweepFolder) -> list[str]:
    found, told = finished(folder)
    assert not told
    return found


def test_a_sweep_killed_as_it_began_can_begin_again(tmp_path: Path) -> None:
    begun = SweepFolder(tmp_path)
    begun.parts_path.mkdir()
    begun.create()
    (tmp_path / "sweep.json.partial").write_text("{")
    begun.create()
    with begun.locked():
        begun.write_tables(run("a"), run("a"), INFO)
    assert begun.info()["grid_sha256"] == "a"


@pytest.mark.parametrize("name", ["sweep.json", "parts/mine.parquet"])
def test_a_folder_of_something_else_is_left_as_it_is(tmp_path: Path, name: str) -> None:
    mine = tmp_path / name
    mine.parent.mkdir(exist_ok=True)
    mine.write_text('{"format": 1, "scenarios": ["s02a_headon"]}')
    with pytest.raises(AirhiltError, match="holds files that are no sweep"):
        SweepFolder(tmp_path).create()
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == [mine]


def test_a_folder_without_a_sweep_is_named(tmp_path: Path) -> None:
    with pytest.raises(AirhiltError, match=r"no sweep here; expected a folder with a sweep\.json"):
        SweepFolder.open(tmp_path)


def test_many_parts_become_one_and_no_run_is_lost(folder: SweepFolder) -> None:
    expected = sorted(f"{number:03}" for number in range(MOST_PARTS + 10))
    for key in expected:
        folder.keep(run(key))
    assert keys(folder) == expected
    assert len(list(folder.parts_path.glob("*.parquet"))) <= MOST_PARTS


def test_a_disk_that_is_full_when_parts_become_one_loses_no_run(
    folder: SweepFolder, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = sorted(f"{number:03}" for number in range(MOST_PARTS + 1))
    for key in expected[:-1]:
        folder.keep(run(key))
    room = [True]

    def replace_while_there_is_room(path: Path, data: bytes) -> None:
        if not room:
            raise OSError(errno.ENOSPC, "No space left on device")
        room.pop()
        replace_file(path, data)

    monkeypatch.setattr(sweep_folder, "replace_file", replace_while_there_is_room)
    with pytest.raises(AirhiltError, match="No space left"):
        folder.keep(run(expected[-1]))
    assert keys(folder) == expected


def test_a_damaged_part_is_told_after_the_others_have_become_one(folder: SweepFolder) -> None:
    folder.keep(run("lost"))
    (damaged,) = folder.parts_path.glob("*.parquet")
    damaged.write_bytes(b"no parquet")
    for number in range(MOST_PARTS + 5):
        folder.keep(run(f"{number:03}"))
    found, told = finished(folder)
    assert len(found) == MOST_PARTS + 5
    assert len(told) == 1
    assert damaged.name in told[0]


def test_parts_of_an_earlier_version_have_fewer_columns(folder: SweepFolder) -> None:
    folder.keep(pa.table({"key": ["old"], "status": ["finished"]}))
    folder.keep(run("new"))
    table = folder.finished(SCHEMA, lambda _: None)
    assert {row["key"]: row["value"] for row in table.to_pylist()} == {"old": None, "new": 0.5}


def test_parts_of_other_versions_lose_no_column_when_many_become_one(folder: SweepFolder) -> None:
    other = run("other").append_column("more", pa.array([7]))
    folder.keep(other)
    for number in range(MOST_PARTS + 5):
        folder.keep(run(f"{number:03}"))
    assert len(keys(folder)) == MOST_PARTS + 6
    assert len(list(folder.parts_path.glob("*.parquet"))) < MOST_PARTS
    again = folder.finished(other.schema, lambda _: None).to_pylist()
    assert {row["more"] for row in again if row["key"] == "other"} == {7}


@pytest.mark.parametrize(
    ("columns", "reason"),
    [
        ({"status": ["finished"]}, "it has no column key"),
        ({"key": ["a"], "status": ["finished"], "value": ["much"]}, "column value: "),
    ],
)
def test_a_part_that_is_none_of_a_sweep_is_set_aside_by_name(
    folder: SweepFolder, columns: dict[str, list[Any]], reason: str
) -> None:
    folder.keep(pa.table(columns))
    (part,) = folder.parts_path.glob("*.parquet")
    folder.keep(run("b"))
    found, (told,) = finished(folder)
    assert found == ["b"]
    assert part.name in told
    assert reason in told
    assert keys(folder) == ["b"]


def test_tables_are_those_of_the_specification_beside_them(
    folder: SweepFolder, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A kill between the tables and sweep.json is told, and not shown as a result."""
    killed = RuntimeError("killed")

    def kill(*_: object) -> None:
        raise killed

    with monkeypatch.context() as patch:
        patch.setattr(sweep_folder, "_write_info", kill)
        with pytest.raises(RuntimeError):
            folder.write_tables(run("b"), run("b"), {"format": 1, "grid_sha256": "b"})
    assert folder.info()["grid_sha256"] == "a"
    for read in (folder.table, folder.machine):
        with pytest.raises(
            AirhiltError, match=r"not of the sweep in sweep\.json; give the command"
        ):
            read()


def test_a_sweep_that_was_killed_before_it_had_tables_is_told(tmp_path: Path) -> None:
    begun = SweepFolder(tmp_path)
    begun.create()
    assert not begun.is_there
    begun.write_next_info(INFO)
    assert begun.is_there
    with pytest.raises(AirhiltError, match="no tables yet; give the command of the sweep again"):
        SweepFolder.open(tmp_path)


def test_one_process_at_a_time_writes_into_a_folder(folder: SweepFolder) -> None:
    other = SweepFolder(folder.path).locked()
    with folder.locked(), pytest.raises(AirhiltError, match="another sweep is writing"), other:
        pass
    with folder.locked():
        pass


def test_tables_that_are_missing_or_damaged_say_how_to_make_them(folder: SweepFolder) -> None:
    folder.table_path.unlink()
    with pytest.raises(AirhiltError, match="give the command of the sweep again"):
        folder.table()
    folder.table_path.write_bytes(b"PAR1")
    with pytest.raises(AirhiltError, match="damaged"):
        folder.table()


def test_what_a_killed_sweep_left_half_written_is_removed_by_the_next(folder: SweepFolder) -> None:
    folder.keep(run("a"))
    halves = [folder.path / "sweep.parquet.partial", folder.parts_path / "b.parquet.partial"]
    for half in halves:
        half.write_bytes(b"PAR1")
    with folder.locked():
        assert not any(half.exists() for half in halves)
    assert keys(folder) == ["a"]
