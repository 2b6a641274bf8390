"""Damage to the files of a run."""

from __future__ import annotations

import re
from pathlib import Path

from airhilt.record import RunFolder
from airhilt.record.log_reader import BEFORE_COMPRESSION, COMPRESSION


def flip(path: Path, bit: int) -> None:
    """Flip one bit of a file."""
    data = bytearray(path.read_bytes())
    data[bit // 8] ^= 1 << bit % 8
    path.write_bytes(data)


def chunks(data: bytes) -> list[int]:
    """Return where the contents of the chunks of a log begin."""
    pattern = re.escape(COMPRESSION) + rb".{8}\x28\xb5\x2f\xfd"
    return [found.start() - BEFORE_COMPRESSION for found in re.finditer(pattern, data, re.DOTALL)]


def break_third_chunk(folder: Path) -> None:
    """Damage the messages of the third second of a run."""
    log = folder / "log.mcap"
    flip(log, 8 * (chunks(log.read_bytes())[2] + 80))


def kill(folder: Path) -> None:
    """Make it a run that was killed: without a manifest, and without the end of its log."""
    paths = RunFolder(folder)
    paths.write_info(paths.info().model_copy(update={"phase": "running", "files": {}}))
    data = paths.log_path.read_bytes()
    paths.log_path.write_bytes(data[: chunks(data)[-1]])
    paths.summary_path.unlink()
