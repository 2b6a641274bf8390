"""Formats in which ``airhilt export`` writes a run: one module each, named as the format.

A format is a function ``write(run: Result, out: Path) -> list[Path]``: it writes files into the
folder ``out``, which is there and empty, and returns their paths. Its first sentence is its help.
An installed package adds one as an entry point of the group ``airhilt.exports``.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from airhilt.errors import AirhiltError, RunFolderError
from airhilt.plugins import Family

if TYPE_CHECKING:
    from airhilt.metrics.result import Result

FORMATS = Family("export format", "airhilt.exports", __name__, "write")


def export(run: Result, name: str, out: Path) -> list[Path]:
    """Write a run in a format into a new folder, and return the files.

    It raises `AirhiltError` if there is no such format, the folder is there and not empty, or a
    file cannot be written.
    """
    if name not in FORMATS.names():
        raise AirhiltError(
            f"no export format named {name!r}; expected one of {', '.join(FORMATS.names())}"
        )
    write: Callable[[Result, Path], list[Path]] = FORMATS.load(name)
    if out.exists() and not (out.is_dir() and not any(out.iterdir())):
        raise AirhiltError(f"{out}: there already; delete it, or choose another folder with --out")
    try:
        out.mkdir(parents=True, exist_ok=True)
        return write(run, out)
    except OSError as error:
        raise RunFolderError(f"{out}: cannot be written: {error.strerror or error}") from None
