"""Coqui XTTS-v2 from a folder."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

from airhilt.errors import SpeechError
from airhilt.radio.voices.coqui import MODEL_FILES, Coqui

INSTALLED = importlib.util.find_spec("TTS") is not None


@pytest.mark.parametrize("name", MODEL_FILES)
def test_an_incomplete_folder_is_refused_by_the_file_that_it_lacks(
    name: str, tmp_path: Path
) -> None:
    for other in MODEL_FILES:
        if other != name:
            (tmp_path / other).write_text("{}")
    with pytest.raises(SpeechError, match=f"without {name}; expected the files of XTTS-v2"):
        Coqui(tmp_path)


def test_a_folder_that_is_not_there_lacks_everything(tmp_path: Path) -> None:
    with pytest.raises(SpeechError) as refused:
        Coqui(tmp_path / "xtts")
    for name in MODEL_FILES:
        assert name in str(refused.value)


def test_without_the_package_the_error_says_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "TTS", None)
    for name in MODEL_FILES:
        (tmp_path / name).write_text("{}")
    with pytest.raises(SpeechError, match=r"pip install airhilt\[coqui\]"):
        Coqui(tmp_path)


@pytest.mark.skipif(not INSTALLED, reason="no coqui-tts: pip install airhilt[coqui]")
def test_files_that_are_no_model_are_refused(tmp_path: Path) -> None:
    for name in MODEL_FILES:
        (tmp_path / name).write_text("{}")
    with pytest.raises(SpeechError, match="does not load as XTTS-v2"):
        Coqui(tmp_path)
