"""Formats in which ``airhilt export`` writes a run: one module each, named as the format.

A format is a function ``write(run: Result, out: Path) -> list[Path]``: it writes files into the
folder ``out``, which is there and empty, and returns their paths. Its first sentence is its help.
An installed package adds one as an entry point of the group ``airhilt.exports``.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from airhilt.errors import AirhiltError, RunFolderError
from airhilt.plugins import Family

if TYPE_CHECKING:
    from airhilt.metrics.result import Result

FORMATS = Family("export format", "airhilt.exports", __name__, "write")


def export(run: Result, name: str, out: Path) -> list[Path]:
    """Write a run in a format into a new or empty folder, and return the files.

    It raises `AirhiltError` if there is no such format, the folder holds something, or a file
    cannot be written; nothing is left then.
    """
    if name not in FORMATS.names():
        raise AirhiltError(
            f"no export format named {name!r}; expected one of {', '.join(FORMATS.names())}"
        )
    write: Callable[[Result, Path], list[Path]] = FORMATS.load(name)
    try:
        if out.exists() and (not out.is_dir() or any(out.iterdir())):
            raise AirhiltError(
                f"{out}: there already; delete it, or choose another folder with --out"
            )
        out.mkdir(parents=True, exist_ok=True)
        with _nothing_if_it_fails(out):
            return write(run, out)
    except OSError as error:
        raise RunFolderError(f"{out}: cannot be written: {error.strerror or error}") from None


@contextmanager
def _nothing_if_it_fails(folder: Path) -> Iterator[None]:
    try:
        yield
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
