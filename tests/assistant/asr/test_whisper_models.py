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
from airhilt.assistant.asr.whisper_models import downloaded
from airhilt.errors import SpeechError
from model_hub import COMMIT, REPOSITORY, Hub, hub_of
from paths import DATA
from services import nobody

Cli = Callable[..., subprocess.CompletedProcess[str]]

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
def get(hub: Hub, tmp_path: Path) -> Cli:
    """Runs ``airhilt models get`` in a process of its own: the hub's address is read once in it."""

    def call(name: str, endpoint: str = hub.url) -> subprocess.CompletedProcess[str]:
        environment = os.environ | {"HF_ENDPOINT": endpoint, "HF_HOME": str(tmp_path / "home")}
        command = [sys.executable, "-m", "airhilt", "models", "get", name]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)

    return call


def test_a_name_that_was_not_downloaded_is_refused_with_the_command_that_does() -> None:
    with pytest.raises(SpeechError, match=r"`airhilt models get small\.en` before the run"):
        Whisper("small.en")


def test_a_run_and_a_sweep_refuse_it_before_they_begin(
    airhilt_command: Cli, tmp_path: Path
) -> None:
    done = airhilt_command("cosim", "s01a_nominal", "--asr", "whisper:small.en", "--no-cameras")
    assert done.returncode == 2
    assert ("airhilt models get small.en" if INSTALLED else "airhilt[whisper]") in done.stderr
    assert not (tmp_path / "runs").exists()


@pytest.mark.whisper
@WITH_PACKAGE
class TestWithFasterWhisper:
    def test_a_downloaded_model_is_used_by_its_name_and_listed_with_its_commit(
        self, get: Cli, hub: Hub, cache: Path, airhilt_command: Cli
    ) -> None:
        done = get(REPOSITORY)
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
        assert airhilt_command("models", "get", REPOSITORY, "--revision", COMMIT).returncode == 0
        assert hub.asked == []
        listed = f"{REPOSITORY}  {REPOSITORY} at {COMMIT}\n"
        assert airhilt_command("models", "list").stdout == listed
        assert airhilt_command("models", "remove", REPOSITORY).returncode == 0
        assert airhilt_command("models", "list").stdout == ""

    def test_a_file_that_is_damaged_on_the_way_is_not_kept_and_can_be_got_again(
        self, get: Cli, hub: Hub
    ) -> None:
        hub.sent["model.bin"] = bytes(len(hub.files["model.bin"]))
        done = get(REPOSITORY)
        assert done.returncode == 2
        assert "model.bin was damaged on the way" in done.stderr
        assert list(downloaded()) == []
        hub.sent.clear()
        assert get(REPOSITORY).returncode == 0

    @pytest.mark.parametrize(
        ("name", "is_there", "why"),
        [("somebody/nothing", True, "404"), (REPOSITORY, False, "Connect")],
    )
    def test_what_no_hub_has_is_told_in_one_line(
        self, get: Cli, hub: Hub, name: str, is_there: bool, why: str
    ) -> None:
        done = get(name, hub.url if is_there else nobody())
        assert done.returncode == 2
        assert why in done.stderr
        assert len(done.stderr.splitlines()) == 2  # after the one that says what is done
        assert list(downloaded()) == []

    @pytest.mark.parametrize(
        ("name", "why"),
        [
            ("huge-and-perfect", "Invalid model size 'huge-and-perfect', expected one of"),
            ("../../elsewhere", "expected a name such as small.en"),
        ],
    )
    def test_a_name_that_no_model_has_is_refused(
        self, airhilt_command: Cli, name: str, why: str
    ) -> None:
        done = airhilt_command("models", "get", name)
        assert done.returncode == 2
        assert why in done.stderr
