"""Files and folders that runs name: what is in them decides results as any other value does."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from airhilt.errors import AirhiltError
from airhilt.files import content_sha256


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
            path = _path_in(text)
            is_there = os.path.exists if may_be_folder else os.path.isfile
            self._known[key] = _read(path) if path and is_there(path) else ""
        return self._known[key]


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


def _path_in(text: str) -> str:
    """Return the path that a text may be; empty if it looks like a name."""
    argument = text.partition(":")[2]
    return argument or (text if "/" in text or Path(text).suffix else "")


def _read(path: str) -> str:
    try:
        return content_sha256(Path(path))
    except OSError as error:
        raise AirhiltError(f"{path}: cannot be read: {error.strerror}") from None
