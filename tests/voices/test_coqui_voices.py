"""Coqui XTTS-v2 from a folder, here one with a tiny model that has learned nothing."""

from __future__ import annotations

import importlib.util
import shutil
import socket
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from airhilt.errors import SpeechError
from airhilt.voices.engine import VoiceSpec
from airhilt.voices.engines.coqui import MODEL_FILES, Coqui
from tiny_models import XTTS_SPEAKERS, write_xtts

INSTALLED = importlib.util.find_spec("TTS") is not None
LANDING = "Cleared to land runway one left."


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    folder = tmp_path_factory.mktemp("xtts")
    write_xtts(folder)
    yield folder
    shutil.rmtree(folder)  # the vocoder's 90 MB


@pytest.fixture(scope="module")
def engine(model: Path) -> Coqui:
    return Coqui(model)


@pytest.fixture
def folder(model: Path, tmp_path: Path) -> Path:
    """The model, with files that a test may replace (and must not write into)."""
    copy = tmp_path / "model"
    copy.mkdir()
    for name in MODEL_FILES:
        (copy / name).symlink_to(model / name)
    return copy


def replace(path: Path, content: Any) -> None:
    import torch

    path.unlink()
    torch.save(content, path)


@pytest.mark.parametrize("name", MODEL_FILES)
def test_an_incomplete_folder_is_refused_by_the_file_that_it_lacks(
    name: str, tmp_path: Path
) -> None:
    for other in MODEL_FILES:
        if other != name:
            (tmp_path / other).write_text("{}")
    with pytest.raises(SpeechError, match=f"without {name}; expected the files of XTTS-v2"):
        Coqui(tmp_path)


def test_without_the_package_the_error_says_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in ("TTS", "TTS.tts.configs.xtts_config", "TTS.tts.models.xtts"):
        monkeypatch.setitem(sys.modules, module, None)
    for name in MODEL_FILES:
        (tmp_path / name).write_text("{}")
    with pytest.raises(SpeechError, match=r"pip install airhilt\[coqui\]"):
        Coqui(tmp_path)


@pytest.mark.coqui
@pytest.mark.skipif(not INSTALLED, reason="no coqui-tts: pip install airhilt[coqui]")
class TestWithCoquiTts:
    def test_speech_is_mono_at_16_khz_within_full_scale(self, engine: Coqui) -> None:
        for name in XTTS_SPEAKERS:
            audio = engine.synthesise(LANDING, VoiceSpec(name))
            assert audio.dtype == np.float32
            assert audio.ndim == 1
            assert 0.5 < float(np.abs(audio).max()) <= 1.0

    def test_speaking_leaves_the_draws_of_torch_alone(self, engine: Coqui) -> None:
        import torch

        before = torch.random.get_rng_state()
        engine.synthesise("Go around.", VoiceSpec(XTTS_SPEAKERS[0]))
        assert torch.equal(torch.random.get_rng_state(), before)

    def test_it_needs_no_network(self, model: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        def refuse(*_: Any, **__: Any) -> None:
            raise AssertionError("the network was asked")

        monkeypatch.setattr(socket, "getaddrinfo", refuse)
        monkeypatch.setattr(socket.socket, "connect", refuse)
        assert len(Coqui(model).synthesise("Go around.", VoiceSpec(XTTS_SPEAKERS[0])))

    def test_a_checkpoint_as_its_publisher_wrote_it_loads(
        self, model: Path, tmp_path: Path
    ) -> None:
        """With the configuration as an object, from when its classes were in another module."""
        import torch
        from TTS.tts.configs.xtts_config import XttsArgs, XttsAudioConfig, XttsConfig

        folder = Path(shutil.copytree(model, tmp_path / "model"))
        weights = torch.load(folder / "model.pth", weights_only=True)["model"]
        with pytest.MonkeyPatch.context() as then:
            for moved in (XttsArgs, XttsAudioConfig):
                then.setattr(moved, "__module__", "TTS.tts.models.xtts")
            torch.save({"config": XttsConfig(), "model": weights}, folder / "model.pth")
        first, second = Coqui(folder), Coqui(folder)
        assert first.version == second.version
        assert len(first.synthesise("Go around.", VoiceSpec(XTTS_SPEAKERS[0])))
        shutil.rmtree(folder)

    def test_files_that_are_no_model_are_refused(self, tmp_path: Path) -> None:
        for name in MODEL_FILES:
            (tmp_path / name).write_text("{}")
        with pytest.raises(SpeechError, match="does not load as XTTS-v2"):
            Coqui(tmp_path)

    @pytest.mark.parametrize("name", MODEL_FILES)
    def test_a_damaged_file_is_an_error_about_that_model(self, name: str, folder: Path) -> None:
        (folder / name).unlink()
        (folder / name).write_bytes(b"damaged")
        with pytest.raises(SpeechError, match=f"{folder}: does not load as XTTS-v2: "):
            Coqui(folder)
