"""Bytes that are costly to make, and that most who get them never read."""

from __future__ import annotations

from collections.abc import Callable


class DeferredBytes:
    """Bytes of a known number that are made when somebody reads them, and then kept.

    ``bytes(payload)`` and ``len(payload)`` are right for these and for `bytes`.
    """

    def __init__(self, size: int, make: Callable[[], bytes]) -> None:
        self._size = size
        self._make = make
        self._made: bytes | None = None

    def __len__(self) -> int:
        return self._size

    def __bytes__(self) -> bytes:
        if self._made is None:
            self._made = self._make()
        return self._made


Payload = bytes | DeferredBytes
"""Payload of a message."""
