"""What was read of files, kept until one of them changes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Generic, NamedTuple, TypeVar

T = TypeVar("T")


class _Stamp(NamedTuple):
    """State of a file, which is another one once the file was written or replaced."""

    inode: int
    size_bytes: int
    modified_ns: int


class FileCache(Generic[T]):
    """Keeps what was read of files until one of them is written, replaced, made or deleted."""

    def __init__(self) -> None:
        self._kept: dict[tuple[Path, ...], tuple[list[_Stamp | None], T]] = {}

    def get(self, read: Callable[[], T], *paths: Path) -> T:
        """Return what a function reads of some files, as it did if none has changed since.

        What it raises is not kept.
        """
        stamps = list(map(_stamp, paths))  # Before reading: what changes meanwhile is read again.
        kept = self._kept.get(paths)
        if kept is not None and kept[0] == stamps:
            return kept[1]
        found = read()
        self._kept[paths] = stamps, found
        return found


def _stamp(path: Path) -> _Stamp | None:
    """Return the state of a file, None if there is none."""
    try:
        found = path.lstat()
    except OSError:
        return None
    return _Stamp(found.st_ino, found.st_size, found.st_mtime_ns)
