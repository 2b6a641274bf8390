"""A process that races others for an entry of a cache; here, where it can be imported."""

from __future__ import annotations

from pathlib import Path
from threading import Barrier

from airhilt.host.caches import CacheFolder

CONTENT_BYTES = 4_000_000
TIMES = 20


def race(base: Path, start: Barrier, number: int) -> None:
    """Make and read one entry again and again, while the first process deletes it."""
    cache = CacheFolder("voices", base)
    content = bytes([7]) * CONTENT_BYTES
    for _ in range(TIMES):
        start.wait(60.0)
        if cache.get("key", lambda: content) != content:
            raise AssertionError("an entry was read that is not whole")
        if number == 0:
            for path in (base / "voices").glob("*.entry"):
                path.unlink()
    start.wait(60.0)
    cache.get("key", lambda: content)
