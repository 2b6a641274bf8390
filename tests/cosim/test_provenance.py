"""Files and folders of models are recorded with their SHA-256."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import airhilt
from airhilt.assistant import asr
from airhilt.cosim import replay as replaying
from airhilt.cosim.replay import replay
from airhilt.host.files import content_sha256
from airhilt.host.machine import cpu_s
from airhilt.record import RunFolder, read_log
from airhilt.record.folder import versions
from airhilt.scenario import Scenario


def test_the_hash_of_a_folder_is_that_of_its_names_and_contents(tmp_path: Path) -> None:
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep" / "a").write_text("1")
    first = content_sha256(tmp_path)
    assert content_sha256(tmp_path) == first
    (tmp_path / "deep" / "a").rename(tmp_path / "deep" / "b")
    assert content_sha256(tmp_path) != first
    (tmp_path / "deep" / "b").rename(tmp_path / "deep" / "a")
    (tmp_path / "deep" / "a").write_text("2")
    assert content_sha256(tmp_path) != first


def test_a_model_that_was_changed_is_told_in_a_replay(encounter: Scenario, tmp_path: Path) -> None:
    model = tmp_path / "model"
    shutil.copytree(Path(asr.__file__).parent / "model", model)
    short = encounter.model_copy(update={"duration_s": 1.0})
    folder = airhilt.run(
        short, out=tmp_path / "run", latency="fixed", asr=f"embedded:{model}"
    ).folder
    assert RunFolder(folder).info().models == {str(model): content_sha256(model)}
    (model / "note.txt").touch()
    assert f"{model} is not the file of the recording any more" in replay(folder).notes


def test_a_replay_that_differs_names_other_versions_before_the_difference(
    recorded_run: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(replaying, "read_log", lambda path: list(read_log(path))[:-1])
    assert "differs first at message" in str(replay(recorded_run)).splitlines()[0]
    monkeypatch.setattr(replaying, "versions", lambda: versions() | {"numpy": "0.1"})
    verdict = replay(recorded_run)
    cause, difference, *_ = str(verdict).splitlines()
    assert cause.startswith("cause: other software or another machine than the run had (numpy ")
    assert "-> 0.1); the same bytes need the same versions" in cause
    assert "differs first at message" in difference
    assert verdict.as_dict()["cause"] == verdict.cause


def test_a_replay_on_other_versions_that_is_identical_has_no_cause(
    recorded_run: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(replaying, "versions", lambda: versions() | {"numpy": "0.1"})
    verdict = replay(recorded_run)
    assert (verdict.identical, verdict.cause) == (True, "")
    assert any("numpy" in note for note in verdict.notes)


@pytest.mark.skipif(sys.platform == "win32", reason="has no resource usage")
def test_cpu_time_counts_children_that_ended_and_those_that_live() -> None:
    burn = "import time\nwhile time.process_time() < 0.5: pass\nprint(1, flush=True)\ninput()"
    before_s = cpu_s()
    with subprocess.Popen(
        [sys.executable, "-c", burn], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as child:
        assert child.stdout is not None
        child.stdout.readline()
        living_s = cpu_s() - before_s
        child.communicate(b"\n")
    assert living_s >= 0.4
    assert cpu_s() - before_s >= 0.4
