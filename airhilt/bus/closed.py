"""The bus of a run that no other program can join."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from airhilt.sim.payload import Payload

Answer = Callable[[bytes], None]
"""Answers a query with a payload."""
Refused = Callable[[str, str], None]
"""Called with the key, relative to the run, and the cause of what does not count on the bus."""


class ClosedBus:
    """Bus without a session; `airhilt.bus.session.Bus` is what programs can join.

    Attributes
    ----------
    endpoint
        Endpoint at which it accepts connections; empty: none.
    refused
        Called, on any thread, with what a worker of the bus refuses.
    """

    def __init__(self, run: str, endpoint: str = "") -> None:
        self.run = run
        self.endpoint = endpoint
        self.refused: Refused = _ignored

    @property
    def returns_s(self) -> float:
        """Wall time in s in which a program that is out of reach may come back."""
        return 0.0

    def put(self, key: str, payload: Payload, attachment: bytes | None = None) -> None:
        """Publish to nobody; a deferred payload is not made."""

    def keep(self, key: str, payload: bytes) -> None:
        """Publish to nobody, and keep nothing."""

    def hear(self, pattern: str, heard: Callable[[str, bytes], None], *more: Any) -> None:
        """Hear nothing."""

    def watch_workers(self, changed: Callable[[str, bool], None]) -> None:
        """Wait for nobody."""

    def watch_holders(self, ended: Callable[[str, str], None]) -> None:
        """Wait for nobody."""

    def has_holder(self, seat_key: str, holder: str) -> bool:  # noqa: ARG002
        """Return False: nobody is there."""
        return False

    def answer(self, pattern: str, asked: Callable[[str, bytes, Answer], None]) -> None:
        """Answer nothing."""

    def close(self) -> None:
        """Let go of whom it tells."""
        self.refused = _ignored


def _ignored(_key: str, _cause: str) -> None:
    """Take no note."""
