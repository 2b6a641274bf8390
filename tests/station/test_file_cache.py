"""What was read of files is kept until one of them changes."""

from __future__ import annotations

from pathlib import Path

import pytest

from airhilt.host.files import replace_file
from airhilt.station.file_cache import FileCache


class Reader:
    """Reads two files, of which one need not be there, and counts how often."""

    def __init__(self, folder: Path) -> None:
        self.first, self.second = folder / "first", folder / "second"
        self.times = 0
        self._cache = FileCache[str]()

    def read(self) -> str:
        """Return what both files say."""
        return self._cache.get(self._read, self.first, self.second)

    def _read(self) -> str:
        self.times += 1
        second = self.second.read_text() if self.second.exists() else ""
        return self.first.read_text() + second


def test_files_are_read_again_when_one_is_replaced_made_or_deleted(tmp_path: Path) -> None:
    reader = Reader(tmp_path)
    reader.first.write_text("a")
    assert [reader.read(), reader.read(), reader.times] == ["a", "a", 1]
    replace_file(reader.first, b"b")  # As large, and perhaps at the same instant.
    assert [reader.read(), reader.read(), reader.times] == ["b", "b", 2]
    reader.second.write_text("c")
    assert [reader.read(), reader.read(), reader.times] == ["bc", "bc", 3]
    reader.second.unlink()
    assert [reader.read(), reader.read(), reader.times] == ["b", "b", 4]


def test_an_error_is_not_kept(tmp_path: Path) -> None:
    reader = Reader(tmp_path)
    for _ in range(2):
        with pytest.raises(FileNotFoundError):
            reader.read()
    assert reader.times == 2


def test_a_file_that_changes_while_it_is_read_is_read_again(tmp_path: Path) -> None:
    path, cache = tmp_path / "first", FileCache[str]()
    path.write_text("old")

    def read() -> str:
        text = path.read_text()
        replace_file(path, b"new")
        return text

    assert [cache.get(read, path), cache.get(path.read_text, path)] == ["old", "new"]
