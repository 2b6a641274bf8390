"""A log that cannot be read says why."""

from __future__ import annotations

from pathlib import Path

import pytest

from airhilt.errors import RunFolderError
from airhilt.record import LogWriter, read_log


def test_the_log_of_a_run_that_was_killed_at_once_is_empty(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    writer = LogWriter(path)
    assert list(read_log(path)) == []
    writer.close()


def test_a_file_of_another_kind_is_no_log(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    path.write_bytes(b"years of work, in plain text")
    with pytest.raises(RunFolderError, match=r"not an MCAP log: .*magic"):
        list(read_log(path))
