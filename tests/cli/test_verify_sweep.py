"""`airhilt verify` says whether the tables of a sweep are as it wrote them, and who signed them."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import airhilt
from airhilt.record.damage import DamageWarning
from airhilt.record.manifest import digest
from airhilt.record.sweep_folder import SweepFolder
from damage import flip, kill
from verifying import verified

INFO = {"format": 1, "runs": 1, "grid_sha256": "a"}
KEPT = "runs/first"


@pytest.fixture
def sweep(recorded_run: Path, tmp_path: Path) -> Path:
    """A sweep of one run, whose folder was kept."""
    folder = SweepFolder(tmp_path / "sweep")
    folder.create()
    shutil.copytree(recorded_run, folder.path / KEPT)
    write(folder)
    return folder.path


def write(folder: SweepFolder, kept: str = KEPT) -> None:
    row = {"key": ["a"], "status": ["finished"]}
    folder.write_tables(pa.table(row), pa.table(row | {"folder": [kept]}), INFO)


@pytest.fixture
def signed(airhilt_command: Any, keys: Path, sweep: Path) -> Path:
    done = airhilt_command("sign", sweep, "--key", keys)
    assert done.returncode == 0, done.stderr
    return sweep


def change(sweep: Path, changes: Callable[[dict[str, Any]], object]) -> None:
    """Change ``sweep.json`` without making its hash right again."""
    path = sweep / "sweep.json"
    document = json.loads(path.read_text())
    changes(document)
    path.write_text(json.dumps(document))


# --- damage ---------------------------------------------------------------------------------


def test_a_sweep_as_it_was_written_is_intact(airhilt_command: Any, sweep: Path) -> None:
    (sweep / "figures").mkdir()
    (sweep / "figures" / "warnings.svg").write_text("<svg/>")
    (sweep / KEPT / "report.html").write_text("made later")
    SweepFolder(sweep).keep(pa.table({"key": ["a"], "status": ["finished"]}))
    (sweep / "notes.txt").write_text("on a Tuesday")
    code, found = verified(airhilt_command, sweep)
    assert (code, found["kind"], found["state"]) == (0, "sweep", "intact")
    assert (found["problems"], found["files"]) == ([], 3)
    assert found["made_again"] == ["figures/warnings.svg", f"{KEPT}/report.html"]
    assert found["additional"] == ["notes.txt"]
    done = airhilt_command("verify", sweep)
    assert done.stdout.startswith(f"{sweep}: intact: 3 files are as the sweep wrote them\n")


@pytest.mark.parametrize("name", ["machine.parquet", f"{KEPT}/run.json"])
def test_a_file_that_was_changed_or_is_missing_is_named(
    airhilt_command: Any, sweep: Path, name: str
) -> None:
    flip(sweep / name, 8 * ((sweep / name).stat().st_size // 2))
    code, found = verified(airhilt_command, sweep)
    assert (code, found["state"]) == (1, "damaged")
    changed = f"{name}: damaged or changed: its SHA-256 is not that in sweep.json"
    assert found["problems"] == [changed]
    (sweep / name).unlink()
    assert verified(airhilt_command, sweep)[1]["problems"] == [f"{name}: missing"]


def test_damage_of_a_run_that_was_kept_is_that_of_its_sweep(
    airhilt_command: Any, sweep: Path
) -> None:
    (sweep / KEPT / "latency.jsonl").unlink()
    (sweep / KEPT / "call.wav").write_bytes(b"RIFF")
    code, found = verified(airhilt_command, sweep)
    assert (code, found["problems"]) == (1, [f"{KEPT}/latency.jsonl: missing"])
    assert found["additional"] == [f"{KEPT}/call.wav"]


def test_a_run_that_a_limit_ended_is_no_damage(airhilt_command: Any, sweep: Path) -> None:
    kill(sweep / KEPT)
    write(SweepFolder(sweep))
    assert verified(airhilt_command, sweep)[0] == 0


@pytest.mark.parametrize(
    "changes",
    [
        lambda document: document.pop("digest"),
        lambda document: document["files"].pop("sweep.parquet"),
        lambda document: document.update(format=7),
    ],
)
def test_a_changed_specification_is_damage(
    airhilt_command: Any, sweep: Path, changes: Callable[[dict[str, Any]], object]
) -> None:
    change(sweep, changes)
    code, found = verified(airhilt_command, sweep)
    assert (code, found["state"]) == (1, "damaged")
    assert found["problems"][0].startswith("sweep.json: ")


def test_a_manifest_without_the_tables_is_damage_though_its_hash_is_right(
    airhilt_command: Any, sweep: Path
) -> None:
    def forge(document: dict[str, Any]) -> None:
        document["files"] = {"../secret.txt": document["files"]["sweep.parquet"]}
        document["digest"] = digest(document)

    (sweep.parent / "secret.txt").write_text("secret")
    change(sweep, forge)
    code, found = verified(airhilt_command, sweep)
    assert code == 1
    assert "sweep.json: its manifest has no sweep.parquet" in found["problems"]
    assert any("../secret.txt: outside of the folder" in line for line in found["problems"])


# --- signatures -----------------------------------------------------------------------------


def test_a_signature_is_of_the_tables_as_they_were(
    airhilt_command: Any, signed: Path, keys: Path
) -> None:
    code, found = verified(airhilt_command, signed, "--key", f"{keys}.pub")
    assert (code, found["state"], found["signature"]) == (0, "intact", "good")
    assert found["additional"] == []
    signature = (signed / "sweep.json.sig").read_bytes()
    write(SweepFolder(signed), kept="")
    assert verified(airhilt_command, signed)[1]["signature"] == "absent", "new tables end it"
    (signed / "sweep.json.sig").write_bytes(signature)
    assert verified(airhilt_command, signed)[0] == 0
    code, found = verified(airhilt_command, signed, "--key", f"{keys}.pub")
    assert (code, found["state"], found["signature"]) == (1, "intact", "bad")


def test_a_sweep_that_goes_on_is_unfinished_and_not_signed(
    airhilt_command: Any, sweep: Path, keys: Path
) -> None:
    SweepFolder(sweep).write_next_info(INFO)
    code, found = verified(airhilt_command, sweep)
    assert (code, found["state"]) == (3, "unfinished")
    done = airhilt_command("sign", sweep, "--key", keys)
    assert (done.returncode, "unfinished; expected a sweep" in done.stderr) == (2, True)
    (sweep / "sweep.json").unlink()
    done = airhilt_command("verify", sweep)
    assert done.returncode == 3
    assert "unfinished: the sweep was killed, or is still going on; it has no tables yet" in (
        done.stdout
    )
    assert not (sweep / "sweep.json.sig").exists()


def test_a_folder_in_which_no_sweep_begins_is_signed_also_without_its_parts(
    airhilt_command: Any, sweep: Path, keys: Path
) -> None:
    with SweepFolder(sweep).locked():
        done = airhilt_command("sign", sweep, "--key", keys)
    assert (done.returncode, "another sweep is writing here" in done.stderr) == (2, True)
    shutil.rmtree(sweep / "parts")
    assert airhilt_command("sign", sweep, "--key", keys).returncode == 0
    assert verified(airhilt_command, sweep, "--key", f"{keys}.pub")[0] == 0


# --- readers --------------------------------------------------------------------------------


@pytest.fixture
def changed(sweep: Path) -> Path:
    """The sweep, whose table somebody has written again with another status."""
    table = pq.read_table(sweep / "sweep.parquet")
    row = {"key": ["b"], "status": ["finished"]}
    pq.write_table(pa.table(row, schema=table.schema), sweep / "sweep.parquet")
    return sweep


def test_a_changed_table_is_told_to_who_reads_it_in_python(changed: Path) -> None:
    """The warning names the line that reads it."""
    with pytest.warns(DamageWarning, match=r"sweep.parquet: damaged or changed") as told:
        assert airhilt.read_sweep(changed)["key"].to_list() == ["b"]
    assert [each.filename for each in told] == [__file__]


def test_who_opens_a_sweep_is_told_of_each_change(sweep: Path) -> None:
    assert SweepFolder(sweep).damage() == ()
    assert airhilt.read_sweep(sweep)["key"].to_list() == ["a"]
    flip(sweep / "machine.parquet", 100)
    change(sweep, lambda document: document.update(runs=2))
    assert SweepFolder(sweep).damage() == (
        "sweep.json: damaged or changed: not what its digest says",
        "machine.parquet: damaged or changed: its SHA-256 is not that in sweep.json",
    )


def test_a_changed_table_is_told_by_commands_that_read_it(
    airhilt_command: Any, changed: Path, tmp_path: Path
) -> None:
    """The comparison then ends with a mistake: this table has no parameters."""
    told = f"{changed}: sweep.parquet: damaged or changed"
    done = airhilt_command("report", changed, "--csv", tmp_path / "table.csv")
    assert done.returncode == 0
    assert told in done.stderr
    assert airhilt_command("compare", changed, changed).stderr.count(told) == 1
