"""The folder in which workers leave run folders: all of them must see it, wherever they are."""

from __future__ import annotations

import os
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from airhilt.errors import AirhiltError
from airhilt.record.sweep_folder import SweepFolderError


@contextmanager
def probe_in(folder: Path) -> Iterator[Path]:
    """Put a file into a folder for the workers to look for; it goes with the context.

    Raises
    ------
    SweepFolderError
        It cannot be written.
    """
    probe = folder.absolute() / f".probe-{uuid.uuid4().hex}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe.touch()
    except OSError as error:
        raise SweepFolderError(f"{folder}: cannot be written: {error.strerror}") from None
    try:
        yield probe
    finally:
        probe.unlink(missing_ok=True)


def require_seen(probe: Path, where: str) -> None:
    """Complain about a worker that could not leave run folders where the sweep is.

    Raises
    ------
    AirhiltError
        The message names the worker and the folder.
    """
    if not probe.exists() or not os.access(probe.parent, os.W_OK):
        raise AirhiltError(
            f"worker {where}: does not see {probe.parent}, or cannot write there; expected --out "
            "on a file system that all workers share, or --keep none"
        )
