"""Keys of a run that have expired, or are open to others, are refused."""

from __future__ import annotations

import datetime as calendar
from pathlib import Path

import pytest

from airhilt.bus import certificates
from airhilt.bus.certificates import key_file, make_keys, read_keys
from airhilt.errors import BusError


class Later(calendar.datetime):
    """Clock of somebody who uses the keys a century after they were made."""

    @classmethod
    def now(cls, tz: calendar.tzinfo | None = None) -> Later:
        return cls(2126, 11, 26, tzinfo=tz)


def test_keys_that_have_expired_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_keys(tmp_path, "tls/127.0.0.1:7447")
    assert read_keys(tmp_path, "worker").endpoint == "tls/127.0.0.1:7447"
    monkeypatch.setattr(certificates, "datetime", Later)
    with pytest.raises(BusError, match=r"worker\.json: its certificate has expired on \d{4}-"):
        read_keys(tmp_path, "worker")


def test_keys_that_others_may_read_are_refused(tmp_path: Path) -> None:
    make_keys(tmp_path, "tls/127.0.0.1:7447")
    for holder in ("router", "worker"):
        key_file(tmp_path, holder).chmod(0o644)
        with pytest.raises(BusError, match=r"other users may read .*; expected .*: chmod 600 "):
            read_keys(tmp_path, holder)


@pytest.mark.parametrize("mode", [0o777, 0o770, 0o702])
def test_keys_are_not_made_in_a_folder_that_others_may_write(tmp_path: Path, mode: int) -> None:
    folder = tmp_path / "keys"
    folder.mkdir()
    folder.chmod(mode)
    with pytest.raises(BusError, match="other users may write into this folder"):
        make_keys(folder, "tls/127.0.0.1:7447")
    assert list(folder.iterdir()) == []


def test_keys_of_another_authority_are_told_before_any_is_made(tmp_path: Path) -> None:
    key_file(tmp_path, "recorder").write_text("{}")
    with pytest.raises(BusError, match=r"recorder\.json: is there already"):
        make_keys(tmp_path, "tls/127.0.0.1:7447")
    assert [path.name for path in tmp_path.iterdir()] == ["recorder.json"]
