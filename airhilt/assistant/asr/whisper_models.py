"""Whisper models in the user's cache, by the names that faster-whisper gives them.

Each is a folder that CTranslate2's converter made, with `RECORD` beside the files. Only `download`
asks the network.
"""

from __future__ import annotations

import re
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from pydantic import BaseModel, ConfigDict, ValidationError

from airhilt.errors import SpeechError, first_line
from airhilt.host.caches import MODELS, cache_folder
from airhilt.host.files import replace_file, sha256

MODEL_FILES = ("config.json", "model.bin", "tokenizer.json")
"""Files of a folder that CTranslate2's converter made from Whisper.

It was called with ``--copy_files tokenizer.json preprocessor_config.json``: without tokenizer.json,
faster-whisper would look for one on the network."""
EXPECTED = f"a folder with {', '.join(MODEL_FILES)}"
RECORD = "source.json"
"""File of a downloaded model with its `Source`."""
NAME = re.compile(r"\w[\w.-]*(/\w[\w.-]*)?")
"""Name of a model, such as small.en, or of a repository with its owner."""
SHA256 = re.compile(r"[0-9a-f]{64}")


class Source(BaseModel):
    """Where a model came from, and what it was."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    repository: str
    """Repository of the Hugging Face hub, with its owner."""
    revision: str
    """Commit of the repository."""
    files: dict[str, str]
    """SHA-256 of each file, by its name."""


def models_folder() -> Path:
    """Return the folder of all downloaded Whisper models."""
    return cache_folder() / MODELS / "whisper"


def require_model(model: str) -> Path:
    """Return the folder of a model, which is named or is the folder itself.

    Raises
    ------
    SpeechError
        It is not there, or a file of it is missing.
    """
    folder = Path(model)
    if not folder.is_dir():
        if folder.exists() or not NAME.fullmatch(model):
            raise SpeechError(f"ASR whisper: {model}: no folder; expected {EXPECTED}")
        folder = models_folder() / model
        if not folder.is_dir():
            raise SpeechError(
                f"ASR whisper: {model}: neither a folder nor a model that was downloaded; expected "
                f"{EXPECTED}, or `airhilt models get {model}` before the run"
            )
    if missing := [name for name in MODEL_FILES if not (folder / name).is_file()]:
        raise SpeechError(
            f"ASR whisper: {folder}: without {', '.join(missing)}; expected {EXPECTED}, as "
            "`ct2-transformers-converter --copy_files tokenizer.json preprocessor_config.json` "
            "makes it"
        )
    return folder


def download(name: str, revision: str | None = None) -> Path:
    """Return the folder of a model; it is downloaded from the Hugging Face hub if it is not there.

    Parameters
    ----------
    revision
        Commit, tag or branch; None: what is there, or else the newest.

    Raises
    ------
    SpeechError
        There is no such model, or it cannot be downloaded or kept.
    """
    if not NAME.fullmatch(name):
        raise SpeechError(f"model {name!r}: expected a name such as small.en, or OWNER/REPOSITORY")
    folder = models_folder() / name
    if folder.is_dir() and (revision is None or source_of(folder).revision == revision):
        return folder
    try:
        from faster_whisper import download_model
    except ImportError as error:
        raise SpeechError(missing_package(error)) from None
    # What has arrived stays after an interruption, and the next attempt goes on with it.
    partial = folder.with_name(f".{folder.name}.partial")
    try:
        snapshot = Path(download_model(name, cache_dir=str(partial), revision=revision))
        source = _source(snapshot)
        require_model(str(snapshot))
        made = Path(tempfile.mkdtemp(dir=partial))
        for file in source.files:
            (snapshot / file).resolve().rename(made / file)
        replace_file(made / RECORD, source.model_dump_json(indent=2).encode())
        shutil.rmtree(folder, ignore_errors=True)
        made.rename(folder)
        shutil.rmtree(partial)
    except SpeechError:
        raise
    except Exception as error:  # the network's, the hub's, the disk's
        raise SpeechError(f"model {name!r}: cannot be downloaded: {first_line(error)}") from None
    return folder


def downloaded() -> Iterator[tuple[str, Source]]:
    """Yield name and source of each model that was downloaded, by name."""
    base = models_folder()
    for record in sorted(base.rglob(RECORD)):
        name = record.parent.relative_to(base).as_posix()
        if NAME.fullmatch(name):
            yield name, source_of(record.parent)


def remove(name: str) -> None:
    """Delete a downloaded model.

    Raises
    ------
    SpeechError
        It is not there.
    """
    names = [each for each, _ in downloaded()]
    if name not in names:
        raise SpeechError(
            f"model {name!r}: not downloaded; expected one of {', '.join(names) or 'none'}"
        )
    shutil.rmtree(models_folder() / name)


def source_of(folder: Path) -> Source:
    """Return where a downloaded model came from.

    Raises
    ------
    SpeechError
        Its record is missing or damaged.
    """
    try:
        return Source.model_validate_json((folder / RECORD).read_bytes())
    except (OSError, ValidationError) as error:
        raise SpeechError(
            f"{folder / RECORD}: cannot be read: {first_line(error)}; expected the folder to be "
            "deleted, and the model downloaded again"
        ) from None


def missing_package(error: ImportError) -> str:
    """Return in words that faster-whisper cannot be imported, and how to get it."""
    return (
        f"ASR whisper: the package faster-whisper is missing or does not load ({first_line(error)})"
        "; install it with `pip install airhilt[whisper]`"
    )


def _source(snapshot: Path) -> Source:
    """Return the source of files in the layout of the hub's own cache.

    There each file is a link to one that is named by the hub's checksum, which for large files is
    their SHA-256.
    """
    files = {path.name: sha256(path) for path in sorted(snapshot.iterdir())}
    for name, found in files.items():
        blob = (snapshot / name).resolve()
        if SHA256.fullmatch(blob.name) and blob.name != found:
            blob.unlink()
            raise SpeechError(
                f"{name} was damaged on the way: its SHA-256 is {found}; expected {blob.name}, as "
                "the hub has it; try again"
            )
    repository = snapshot.parents[1].name.removeprefix("models--").replace("--", "/")
    return Source(repository=repository, revision=snapshot.name, files=files)
