"""Whisper models by name: downloaded by one command, from a hub on loopback, and by no run."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from airhilt.assistant.asr.engines.whisper import Whisper
from airhilt.errors import SpeechError
from model_hub import COMMIT, REPOSITORY, Hub, hub_of
from paths import DATA
from services import nobody

Models = Callable[..., subprocess.CompletedProcess[str]]

MODEL = DATA / "tiny_whisper"
INSTALLED = importlib.util.find_spec("faster_whisper") is not None
WITH_PACKAGE = pytest.mark.skipif(
    not INSTALLED, reason="no faster-whisper: pip install airhilt[whisper]"
)


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache/airhilt/models/whisper"


@pytest.fixture
def hub() -> Iterator[Hub]:
    with hub_of(MODEL) as made:
        yield made


@pytest.fixture
def models(hub: Hub, tmp_path: Path) -> Models:
    """Runs ``airhilt models`` in a process of its own: the hub's library reads its address once."""

    def call(*arguments: str, endpoint: str = "") -> subprocess.CompletedProcess[str]:
        environment = os.environ | {
            "HF_ENDPOINT": endpoint or hub.url,
            "HF_HOME": str(tmp_path / "home"),
        }
        command = [sys.executable, "-m", "airhilt", "models", *arguments]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)

    return call


def test_a_name_that_was_not_downloaded_is_refused_with_the_command_that_does() -> None:
    with pytest.raises(SpeechError, match=r"`airhilt models get small\.en` before the run"):
        Whisper("small.en")


def test_a_run_and_a_sweep_refuse_it_before_they_begin(
    airhilt_command: Callable[..., subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    done = airhilt_command("cosim", "s01a_nominal", "--asr", "whisper:small.en", "--no-cameras")
    assert done.returncode == 2
    assert ("airhilt models get small.en" if INSTALLED else "airhilt[whisper]") in done.stderr
    assert not (tmp_path / "runs").exists()


@pytest.mark.whisper
@WITH_PACKAGE
class TestWithFasterWhisper:
    def test_a_downloaded_model_is_used_by_its_name_and_listed_with_its_commit(
        self, models: Models, hub: Hub, cache: Path
    ) -> None:
        done = models("get", REPOSITORY)
        assert done.returncode == 0, done.stderr
        expected = hashlib.sha256((MODEL / "model.bin").read_bytes()).hexdigest()
        assert f"{expected}  model.bin" in done.stdout
        assert f"{REPOSITORY} at {COMMIT}" in done.stdout
        assert not any("README" in path for path in hub.asked)
        assert {path.name for path in cache.rglob("*") if path.is_file()} == {
            "source.json",
            *(path.name for path in MODEL.iterdir()),
        }
        assert Whisper(REPOSITORY).name == f"whisper:{REPOSITORY}"
        hub.asked.clear()
        assert models("get", REPOSITORY, "--revision", COMMIT).returncode == 0
        assert hub.asked == []
        assert models("list").stdout == f"{REPOSITORY}  {REPOSITORY} at {COMMIT}\n"
        assert models("remove", REPOSITORY).returncode == 0
        assert models("list").stdout == ""

    def test_a_file_that_is_damaged_on_the_way_is_not_kept_and_can_be_got_again(
        self, models: Models, hub: Hub
    ) -> None:
        whole = hub.files["model.bin"]
        hub.sent["model.bin"] = bytes(len(whole))
        done = models("get", REPOSITORY)
        assert done.returncode == 2
        assert "model.bin was damaged on the way" in done.stderr
        assert models("list").stdout == ""
        hub.sent.clear()
        assert models("get", REPOSITORY).returncode == 0

    @pytest.mark.parametrize(
        ("name", "is_there", "why"),
        [
            ("somebody/nothing", True, "Not Found"),
            (REPOSITORY, False, "Connect"),
            ("huge-and-perfect", True, "Invalid model size 'huge-and-perfect', expected one of"),
            ("../../elsewhere", True, "expected a name such as small.en"),
        ],
    )
    def test_what_cannot_be_downloaded_is_told_in_one_line(
        self, models: Models, name: str, is_there: bool, why: str
    ) -> None:
        done = models("get", name, endpoint="" if is_there else nobody().removesuffix("/service"))
        assert done.returncode == 2
        assert why in done.stderr
        assert len(done.stderr.splitlines()) == 2  # after the one that says what is done
        assert models("list").stdout == ""
