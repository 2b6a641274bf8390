"""The manifest of a run or a sweep: SHA-256 and size of each of its files.

It is in ``run.json`` or ``sweep.json``, beside a hash of that document itself. It tells damage;
only a signature (`airhilt.record.signature`) tells what was changed on purpose.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath
from typing import Any

from pydantic import BaseModel, ConfigDict

from airhilt.host.files import open_inside, sha256


class FileRecord(BaseModel):
    """A file of a run or a sweep, as it was written."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    sha256: str
    size_bytes: int


def manifest(folder: Path, files: Iterable[Path]) -> dict[str, FileRecord]:
    """Return the record of each file that is there, by its path below the folder."""
    return {
        path.relative_to(folder).as_posix(): FileRecord(
            sha256=sha256(path), size_bytes=path.stat().st_size
        )
        for path in files
        if path.is_file()
    }


def digest(document: Mapping[str, Any]) -> str:
    """Return the SHA-256 of a document with a manifest, without its field ``digest``.

    It is taken over JSON with sorted names, without spaces, and with ASCII characters only.
    """
    content = {name: value for name, value in document.items() if name != "digest"}
    canonical = json.dumps(content, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(canonical.encode()).hexdigest()


def digest_problem(name: str, document: Mapping[str, Any]) -> str:
    """Return in words why a document is not what its ``digest`` says, empty if it is."""
    try:
        is_right = digest(document) == document.get("digest")
    except RecursionError:
        is_right = False
    return "" if is_right else f"{name}: damaged or changed: not what its digest says"


def problem_of(folder: Path, name: str, record: FileRecord, manifest_name: str = "run.json") -> str:
    """Return in words why a file is not the one of the manifest, empty if it is."""
    place = PurePosixPath(name)
    if place.is_absolute() or ".." in place.parts:
        return f"{name}: outside of the folder; the manifest was not written by AIRHILT"
    try:
        with open_inside(folder, folder / place) as stream:
            size_bytes = os.fstat(stream.fileno()).st_size
            if record.size_bytes != size_bytes:
                return (
                    f"{name}: damaged or changed: it has {size_bytes} bytes, and "
                    f"{manifest_name} says {record.size_bytes}"
                )
            if hashlib.file_digest(stream, "sha256").hexdigest() == record.sha256:
                return ""
    except FileNotFoundError:
        return f"{name}: missing"
    except OSError as error:
        return f"{name}: cannot be read: {error.strerror}"
    return f"{name}: damaged or changed: its SHA-256 is not that in {manifest_name}"
