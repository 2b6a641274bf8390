"""Keys of a run that are past their time are refused, with the day on which that was."""

from __future__ import annotations

import datetime as calendar
from pathlib import Path

import pytest

from airhilt.bus import certificates
from airhilt.bus.certificates import make_keys, read_keys
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
