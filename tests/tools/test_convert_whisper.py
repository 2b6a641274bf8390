"""The conversion of a Whisper names what is missing before anything is loaded."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from airhilt.errors import SpeechError
from convert_whisper import convert, main, require_whisper


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The files of a model, empty but for its kind."""
    made = tmp_path / "model"
    made.mkdir()
    (made / "config.json").write_text(json.dumps({"model_type": "whisper"}))
    for name in ("model.safetensors", "tokenizer.json", "preprocessor_config.json"):
        (made / name).write_text("{}")
    return made


@pytest.mark.parametrize(
    "name", ["config.json", "model.safetensors", "tokenizer.json", "preprocessor_config.json"]
)
def test_a_file_that_is_missing_is_named(name: str, folder: Path) -> None:
    (folder / name).unlink()
    with pytest.raises(SpeechError, match=f"model: without {name}"):
        require_whisper(folder)


def test_the_settings_of_a_processor_are_those_of_the_features(folder: Path) -> None:
    (folder / "preprocessor_config.json").rename(folder / "processor_config.json")
    require_whisper(folder)


def test_weights_in_parts_need_all_of_them(folder: Path) -> None:
    (folder / "model.safetensors").rename(folder / "part-1.safetensors")
    parts = {"a": "part-1.safetensors", "b": "part-2.safetensors"}
    index = folder / "model.safetensors.index.json"
    index.write_text(json.dumps({"weight_map": parts}))
    with pytest.raises(SpeechError, match=r"without part-2\.safetensors;"):
        require_whisper(folder)
    (folder / "part-2.safetensors").touch()
    require_whisper(folder)


def test_an_adapter_is_to_be_merged_first(folder: Path) -> None:
    (folder / "config.json").rename(folder / "adapter_config.json")
    with pytest.raises(SpeechError, match="an adapter without its model; merge it first"):
        require_whisper(folder)


def test_another_model_is_refused_by_its_kind(folder: Path) -> None:
    (folder / "config.json").write_text(json.dumps({"model_type": "wav2vec2"}))
    with pytest.raises(SpeechError, match="model_type is 'wav2vec2'; expected 'whisper'"):
        require_whisper(folder)


def test_a_folder_that_is_there_is_never_overwritten(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(SpeechError, match="is there; expected the name of a new folder"):
        convert(folder, tmp_path)


def test_without_the_packages_the_error_says_how_to_get_them(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "ctranslate2.converters", None)
    with pytest.raises(SpeechError, match=r"pip install '\.\[finetune\]'"):
        convert(folder, tmp_path / "out")


def test_a_mistake_ends_the_command_without_a_traceback(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["convert_whisper.py", str(tmp_path / "no"), "out"])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    assert "no: no folder" in capsys.readouterr().err
