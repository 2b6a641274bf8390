"""Files and folders of models are recorded with their SHA-256."""

from __future__ import annotations

import shutil
from pathlib import Path

import airhilt
from airhilt.assistant import asr
from airhilt.cosim.replay import replay
from airhilt.files import content_sha256
from airhilt.record import RunFolder
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


def test_a_model_that_is_not_used_is_not_recorded(encounter: Scenario, tmp_path: Path) -> None:
    short = encounter.model_copy(update={"duration_s": 1.0})
    folder = airhilt.run(short, out=tmp_path / "run", latency="fixed", speech=False).folder
    info = RunFolder(folder).info()
    assert (info.models, info.other_packages) == ({}, {})
