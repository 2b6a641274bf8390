"""A log that cannot be read says why."""

from __future__ import annotations

from pathlib import Path

import pytest

from airhilt.errors import RunFolderError
from airhilt.record import LogWriter, read_log


def test_a_log_that_ends_before_its_first_message_says_so(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    LogWriter(path).close()
    path.write_bytes(path.read_bytes()[:40])
    with pytest.raises(RunFolderError, match=r"log\.mcap: not an MCAP log: it ends before its"):
        list(read_log(path))


def test_a_file_of_another_kind_is_no_log(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    path.write_bytes(b"years of work, in plain text")
    with pytest.raises(RunFolderError, match=r"not an MCAP log: .*magic"):
        list(read_log(path))
