"""Converts a Whisper of Hugging Face, such as a fine-tune, to a folder for `--asr whisper:FOLDER`.

    pip install '.[finetune]'
    python tools/asr/convert_whisper.py HF_FOLDER FOLDER
    airhilt cosim --scenario s01a_nominal --asr whisper:FOLDER

It looks at the files first, and loads the result once as a run does. Nothing is downloaded.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from pathlib import Path
from typing import Any

from airhilt.assistant.asr.engines.whisper import Whisper
from airhilt.errors import SpeechError, first_line

CONFIGURATION = "config.json"
TOKENIZER = "tokenizer.json"
FEATURES = ("preprocessor_config.json", "processor_config.json")
"""Settings of the features: transformers 5 writes them in the second file, others in the first."""
WEIGHTS = ("model.safetensors", "pytorch_model.bin")
"""Weights in one file; several have an index of this name and ``.index.json``."""
ADAPTER = "adapter_config.json"
QUANTIZATIONS = ("int8", "float16", "float32")


def require_whisper(folder: Path) -> None:
    """Check that a folder has what transformers needs to load a Whisper, and a tokenizer.

    Raises
    ------
    SpeechError
        Something is missing, or it is another model.
    """
    if not folder.is_dir():
        raise SpeechError(f"{folder}: no folder; expected a Whisper as transformers saves it")
    if (folder / ADAPTER).is_file() and not (folder / CONFIGURATION).is_file():
        raise SpeechError(
            f"{folder}: an adapter without its model; merge it first (`merge_and_unload` of peft), "
            "and save the merged model with its tokenizer and feature extractor"
        )
    missing = [name for name in (CONFIGURATION, TOKENIZER) if not (folder / name).is_file()]
    missing += _missing_weights(folder)
    if not any((folder / name).is_file() for name in FEATURES):
        missing.append(" or ".join(FEATURES))
    if missing:
        raise SpeechError(
            f"{folder}: without {', '.join(missing)}; {TOKENIZER} and {FEATURES[0]} may be copied "
            "from the model that was fine-tuned, as fine-tuning does not change them"
        )
    kind = _json(folder / CONFIGURATION).get("model_type")
    if kind != "whisper":
        raise SpeechError(f"{folder / CONFIGURATION}: model_type is {kind!r}; expected 'whisper'")


def convert(folder: Path, out: Path, quantization: str = "int8") -> None:
    """Write a model as faster-whisper reads it; nothing stays if that fails.

    Raises
    ------
    SpeechError
        The folder lacks something, the new one is there, or the result does not load.
    """
    require_whisper(folder)
    if out.exists():
        raise SpeechError(f"{out}: is there; expected the name of a new folder")
    try:
        from ctranslate2.converters import TransformersConverter
        from transformers import WhisperFeatureExtractor
    except ImportError as error:
        raise SpeechError(
            f"conversion needs ctranslate2, torch and transformers ({first_line(error)}); "
            "install them with `pip install '.[finetune]'`"
        ) from None
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=out.parent) as scratch:
        made = Path(scratch) / out.name
        try:
            converter = TransformersConverter(str(folder), copy_files=[TOKENIZER])
            converter.convert(str(made), quantization=quantization)
            features = WhisperFeatureExtractor.from_pretrained(folder, local_files_only=True)
            features.save_pretrained(made)
        except Exception as error:  # transformers', torch's, CTranslate2's
            raise SpeechError(f"{folder}: does not convert: {first_line(error)}") from None
        Whisper(str(made))
        made.rename(out)


def _missing_weights(folder: Path) -> list[str]:
    for name in WEIGHTS:
        if (folder / name).is_file():
            return []
        index = folder / f"{name}.index.json"
        if index.is_file():
            parts = sorted(set(_json(index).get("weight_map", {}).values()))
            return [part for part in parts if not (folder / part).is_file()]
    return [" or ".join(WEIGHTS)]


def _json(path: Path) -> dict[str, Any]:
    try:
        return dict(json.loads(path.read_text(encoding="utf-8")))
    except (ValueError, TypeError) as error:
        raise SpeechError(f"{path}: no JSON object: {first_line(error)}") from None


def main() -> None:
    """Read the command line, and convert."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="the model as transformers saves it")
    parser.add_argument("out", type=Path, help="a new folder")
    parser.add_argument("--quantization", choices=QUANTIZATIONS, default="int8")
    given = parser.parse_args()
    try:
        convert(given.folder, given.out, given.quantization)
    except SpeechError as error:
        parser.error(str(error))
    for path in sorted(given.out.iterdir()):
        print(f"{path.stat().st_size:12d} {path}")


if __name__ == "__main__":
    main()
