"""Files and folders that runs name: what is in them decides results as any other value does."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from airhilt.errors import AirhiltError
from airhilt.host.files import content_sha256


class NamedFiles:
    """The SHA-256 of files and folders, each read once however many runs name it."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, bool], str] = {}

    def of(self, document: Mapping[str, Any], options: Mapping[str, Any]) -> dict[str, str]:
        """Return the SHA-256 of all that a run names, by the text that names it.

        In options that is a path, or one after ``NAME:``. In a scenario only files count: a text
        there may be the name of a folder by chance.

        Raises
        ------
        AirhiltError
            One cannot be read.
        """
        found = {text: self._sha256(text, may_be_folder=True) for text in _texts(options)}
        found |= {text: self._sha256(text, may_be_folder=False) for text in _texts(document)}
        return {text: sha256 for text, sha256 in found.items() if sha256}

    def _sha256(self, text: str, *, may_be_folder: bool) -> str:
        key = text, may_be_folder
        if key not in self._known:
            # After NAME:, or what looks like a path.
            path = text.partition(":")[2] or (text if "/" in text or Path(text).suffix else "")
            is_there = os.path.exists if may_be_folder else os.path.isfile
            try:
                self._known[key] = content_sha256(Path(path)) if path and is_there(path) else ""
            except OSError as error:
                raise AirhiltError(f"{path}: cannot be read: {error.strerror}") from None
        return self._known[key]


class OtherFilesError(AirhiltError):
    """A file is not here, or not the one that a run was planned with."""

    is_of_machine = True


def require_planned(
    planned: Mapping[str, str], document: Mapping[str, Any], options: Mapping[str, Any]
) -> None:
    """Complain if the files that a run names are not those it was planned with.

    Parameters
    ----------
    planned
        What `NamedFiles.of` returned when the run got its key.

    Raises
    ------
    OtherFilesError
        One is missing or has another content, or is here and was not there.
    """
    found = NamedFiles().of(document, options)
    for text in sorted(planned.keys() | found.keys()):
        if found.get(text) != planned.get(text):
            what = "another file than" if text in found else "not the file that was there"
            raise OtherFilesError(
                f"{text}: {what} when the sweep began, on {socket.gethostname()} in {Path.cwd()}; "
                "expected the same files for all workers, unchanged until the sweep ends"
            )


def _texts(value: Any) -> Iterator[str]:
    """Yield all texts in a JSON value, but the names of its fields."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        for each in value.values():
            yield from _texts(each)
    elif isinstance(value, list | tuple):
        for each in value:
            yield from _texts(each)
