"""Caches: files with what is costly to make and always the same, for all processes of a user.

A cache folder holds entries of one kind, such as synthesised speech. The name of an entry's file is
a hash of everything that determines its content. So nothing in it is ever out of date, processes
may share it, and it may be deleted at any time. Whatever goes wrong with it costs time only.
"""

from __future__ import annotations

import hashlib
import os
import re
import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from airhilt.errors import AirhiltError, shown
from airhilt.host.files import replace_file
from airhilt.host.library import nearest

LIMIT = "AIRHILT_CACHE_LIMIT_MB"
"""Environment variable with the greatest size of all entries together, in MB."""
DEFAULT_LIMIT_MB = 2000.0
KINDS = ("backgrounds", "detections", "landscapes", "pictures", "voices")
"""Kinds of entries that AIRHILT keeps itself; each is a folder in `cache_folder`."""
MODELS = "models"
"""Folder beside the kinds, for models that the user has downloaded: they are no entries."""
ENTRY = re.compile(r"[0-9a-f]{64}.*\.(entry|partial)")
"""Name of an entry, and of one that is being written."""
GROWTH = 0.05
"""Part of the limit that is written, by all processes together, between two looks at the size."""
_DIGEST_BYTES = hashlib.sha256().digest_size


def cache_folder() -> Path:
    """Return the folder of all kinds in the user's cache (XDG Base Directory Specification)."""
    named = Path(os.environ.get("XDG_CACHE_HOME", ""))
    if named.is_absolute():
        return named / "airhilt"
    with suppress(RuntimeError):
        return Path.home() / ".cache" / "airhilt"
    return Path(os.devnull, "airhilt")  # A user without a home: nothing can be written there.


def cache_limit_bytes() -> int:
    """Return the greatest size of all entries together, as the environment has it.

    Raises
    ------
    AirhiltError
        `LIMIT` is no number of megabytes.
    """
    text = os.environ.get(LIMIT, "") or str(DEFAULT_LIMIT_MB)
    try:
        return round(1e6 * max(float(text), 0.0))
    except (ValueError, OverflowError):
        raise AirhiltError(
            f"{LIMIT} {shown(text)}: expected a number of megabytes; 0 keeps nothing"
        ) from None


class CacheFolder:
    """Entries of one kind.

    Each is found whole or not at all: it is written under another name and then moved, and a
    checksum tells if it is damaged. Processes that make the same entry at once all write it, and
    one of the files stays. What cannot be written is made every time.

    Parameters
    ----------
    base
        Folder of all kinds; None takes `cache_folder`.
    limit_bytes
        Size to which all kinds together are reduced, the least recently used entries first; None
        takes `cache_limit_bytes`.
    """

    def __init__(self, kind: str, base: Path | None = None, limit_bytes: int | None = None) -> None:
        self._base = base or cache_folder()
        self._folder = self._base / kind
        self._limit_bytes = cache_limit_bytes() if limit_bytes is None else limit_bytes

    def get(self, key: str, make: Callable[[], bytes]) -> bytes:
        """Return the content of an entry, made if it is not there."""
        path = self._folder / f"{hashlib.sha256(key.encode()).hexdigest()}.entry"
        content = _read(path)
        if content is None:
            content = make()
            if len(content) + _DIGEST_BYTES <= self._limit_bytes:
                with suppress(OSError):
                    path.parent.mkdir(parents=True, exist_ok=True)
                    replace_file(path, hashlib.sha256(content).digest() + content)
                    # A look takes seconds where there are many entries. Some of those who write do
                    # it, chosen by names, which are evenly spread: the more often, the more it is.
                    if int(path.name[:8], 16) / 16**8 < len(content) / (GROWTH * self._limit_bytes):
                        _shrink(self._base, self._limit_bytes)
        return content


@dataclass(frozen=True)
class Usage:
    """The entries of one kind: their number, and their size together."""

    kind: str
    files: int
    size_bytes: int


def usage(base: Path) -> list[Usage]:
    """Return what each kind takes of a folder of all kinds."""
    return [_usage(kind, _entries(base / kind)) for kind in _kinds(base)]


def clear(base: Path, kinds: tuple[str, ...] = ()) -> list[Usage]:
    """Delete the entries of some kinds, or of all; other files stay. Return what was deleted.

    Raises
    ------
    AirhiltError
        There is no such kind; nothing is deleted.
    """
    known = _kinds(base)
    for kind in kinds:
        if kind not in known:
            raise AirhiltError(f"no kind of cache is named {kind!r}{nearest(kind, known)}")
    return [
        _usage(kind, [file for file in _entries(base / kind) if _delete(file.path)])
        for kind in dict.fromkeys(kinds or known)
    ]


def write_problem(base: Path) -> str:
    """Return why nothing can be written into a folder of all kinds; empty if it can."""
    try:
        base.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=base) as probe:
            probe.write(b"\0")
    except OSError as error:
        return f"{base}: {error.strerror}"
    return ""


class _File(NamedTuple):
    """An entry's file."""

    path: str
    size_bytes: int
    used_ns: int


def _kinds(base: Path) -> list[str]:
    """Return the kinds of AIRHILT, and those of other packages that have a folder."""
    with suppress(OSError), os.scandir(base) as there:
        return sorted({*KINDS, *(each.name for each in there if each.is_dir())} - {MODELS})
    return sorted(KINDS)


def _entries(folder: Path) -> Iterator[_File]:
    """Yield the files of entries in a folder, and no others."""
    with suppress(OSError), os.scandir(folder) as there:
        for each in there:
            with suppress(OSError):  # Another process has deleted it.
                if ENTRY.fullmatch(each.name) and each.is_file(follow_symlinks=False):
                    stat = each.stat(follow_symlinks=False)
                    yield _File(each.path, stat.st_size, stat.st_mtime_ns)


def _usage(kind: str, files: Iterable[_File]) -> Usage:
    sizes = [file.size_bytes for file in files]
    return Usage(kind, len(sizes), sum(sizes))


def _shrink(base: Path, limit_bytes: int) -> None:
    """Delete the least recently used entries of all kinds until the rest is within the limit."""
    import numpy as np

    def entries() -> Iterator[_File]:
        return chain.from_iterable(_entries(base / kind) for kind in _kinds(base))

    pairs = ((file.used_ns, file.size_bytes) for file in entries())
    used_ns, sizes = np.fromiter(pairs, dtype=(np.int64, 2)).T  # There may be a million.
    excess = int(sizes.sum()) - limit_bytes
    if excess <= 0:
        return
    order = np.argsort(used_ns)
    last = order[np.searchsorted(np.cumsum(sizes[order]), excess)]
    for file in entries():
        if file.used_ns <= used_ns[last]:
            _delete(file.path)


def _delete(path: str) -> bool:
    """Delete a file; return whether it is gone."""
    with suppress(OSError):
        Path(path).unlink(missing_ok=True)
    return not os.path.lexists(path)


def _read(path: Path) -> bytes | None:
    """Return the content of an entry and mark it as used; None if it is missing or damaged."""
    try:
        data = path.read_bytes()
    except OSError:
        return None
    digest, content = data[:_DIGEST_BYTES], data[_DIGEST_BYTES:]
    if hashlib.sha256(content).digest() != digest:
        return None
    with suppress(OSError):
        os.utime(path)
    return content
