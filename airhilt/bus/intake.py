"""Intake of the messages that programs publish by themselves: which of them a run drops."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from threading import Lock
from typing import Any

from airhilt.bus.access import PUBLISHED
from airhilt.messages import DropCause, Limit

MOST_WAITING = 2000
"""Number of messages that may wait until the run has time for them."""
MOST_WAITING_BYTES = 32_000_000
"""Size of the messages that may wait, in bytes."""
MOST_SENDERS = 1000
"""Number of senders whose numbering is followed."""
MOST_MISSING = 100_000
"""Greatest number of messages that are taken to be missing between two of one sender; beyond it the
sender has begun to count anew, or has made the number up."""
ROUTED_BYTES = 8_000_000
"""Size in bytes above which the router drops a message of a program, so that neither the run nor
another program gets it. Nothing counts these."""


def size_filter(prefix: str) -> Any:
    """Return the setting ``low_pass_filter`` of Zenoh for the keys below a prefix."""
    keys = [f"{prefix}/{key}" for keys in PUBLISHED.values() for key in keys]
    return [
        {
            "id": "size",
            "flows": ["ingress"],
            "messages": ["put", "delete"],
            "key_exprs": keys,
            "size_limit": ROUTED_BYTES,
        }
    ]


@dataclass(frozen=True, slots=True)
class Source:
    """Number that a sender gave to a message (`SourceInfo` of Zenoh)."""

    sender: str
    number: int


class _Allowance:
    """Number of messages that may come now: at most those of one second."""

    def __init__(self, rate_hz: int, now_s: float) -> None:
        self._rate_hz = rate_hz
        self._left = float(rate_hz)
        self._at_s = now_s

    def take(self, now_s: float) -> bool:
        """Return true if one more may come, and count it."""
        added = (now_s - self._at_s) * self._rate_hz
        self._left, self._at_s = min(self._left + added, float(self._rate_hz)), now_s
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True


class Intake:
    """Decides which messages of programs a run takes, and counts the others (any thread).

    Attributes
    ----------
    dropped
        Number of messages that do not count, by kind of key and cause.

    Parameters
    ----------
    limits
        Limit of each kind of key.
    dropping
        Called with kind of key and cause when the first message of these does not count.
    clock
        Returns the wall time in s.
    """

    def __init__(
        self,
        limits: Mapping[str, Limit],
        dropping: Callable[[str, DropCause], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.dropped: Counter[tuple[str, DropCause]] = Counter()
        self._limits = limits
        self._dropping = dropping
        self._clock = clock
        self._lock = Lock()
        self._allowances = {
            keys: _Allowance(limit.rate_hz, clock()) for keys, limit in limits.items()
        }
        self._waiting = self._waiting_bytes = 0
        self._numbers: dict[str, int] = {}

    def admit(self, keys: str, size: int, source: Source | None = None) -> bool:
        """Return true if a message is to be taken; it then waits until `release`.

        Parameters
        ----------
        keys
            Kind of its key.
        size
            Its size, in bytes.
        """
        with self._lock:
            self._count(keys, "transport", self._missing(source))
            cause = self._cause(keys, size)
            if cause is not None:
                self._count(keys, cause, 1)
                return False
            self._waiting += 1
            self._waiting_bytes += size
            return True

    def release(self, size: int) -> None:
        """Take note that a message of this size does not wait any more."""
        with self._lock:
            self._waiting -= 1
            self._waiting_bytes -= size

    def close(self) -> None:
        """Tell nobody of drops any more."""
        with self._lock:
            self._dropping = lambda _keys, _cause: None

    def _cause(self, keys: str, size: int) -> DropCause | None:
        """Return why a message is not taken, None if it is."""
        if size > self._limits[keys].size_bytes:
            return "size"
        if not self._allowances[keys].take(self._clock()):
            return "rate"
        is_full = self._waiting >= MOST_WAITING or self._waiting_bytes + size > MOST_WAITING_BYTES
        return "queue" if is_full else None

    def _missing(self, source: Source | None) -> int:
        """Return how many messages of a sender are missing before this one."""
        if source is None:
            return 0
        last = self._numbers.get(source.sender)
        if last is None and len(self._numbers) >= MOST_SENDERS:
            return 0
        if last is None or abs(source.number - last) > MOST_MISSING + 1:
            self._numbers[source.sender] = source.number
            return 0
        self._numbers[source.sender] = max(source.number, last)
        return max(source.number - last - 1, 0)

    def _count(self, keys: str, cause: DropCause, number: int) -> None:
        if not number:
            return
        if not self.dropped[keys, cause]:
            self._dropping(keys, cause)
        self.dropped[keys, cause] += number
