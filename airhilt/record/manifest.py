"""The manifest of a run: SHA-256 and size of each of its files, and a hash of ``run.json`` itself.

It tells damage from what the run wrote. Whoever changes a file on purpose can change the manifest
too: only a signature (`airhilt.record.signature`) tells that.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath
from typing import Any

from pydantic import BaseModel, ConfigDict

from airhilt.files import open_inside, sha256


class FileRecord(BaseModel):
    """A file of the run, as the run wrote it."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    sha256: str
    size_bytes: int | None = None
    """Size of the file; None in runs of version 0.5, which did not record it."""


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
    """Return the SHA-256 of the content of ``run.json`` without its field ``digest``.

    It is taken over JSON with sorted names, without spaces, and with ASCII characters only, so that
    it does not depend on how the file is laid out.
    """
    content = {name: value for name, value in document.items() if name != "digest"}
    canonical = json.dumps(content, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(canonical.encode()).hexdigest()


def problem_of(folder: Path, name: str, record: FileRecord) -> str:
    """Return in words why a file is not the one of the manifest, empty if it is."""
    place = PurePosixPath(name)
    if place.is_absolute() or ".." in place.parts:
        return f"{name}: outside of the run folder; the manifest was not written by AIRHILT"
    try:
        with open_inside(folder, folder / place) as stream:
            size_bytes = os.fstat(stream.fileno()).st_size
            if record.size_bytes not in (None, size_bytes):
                return (
                    f"{name}: damaged or changed: it has {size_bytes} bytes, and run.json says "
                    f"{record.size_bytes}"
                )
            found = hashlib.file_digest(stream, "sha256").hexdigest()
    except FileNotFoundError:
        return f"{name}: missing"
    except OSError as error:
        return f"{name}: cannot be read: {error.strerror}"
    if found == record.sha256:
        return ""
    return f"{name}: damaged or changed: its SHA-256 is not that in run.json"
