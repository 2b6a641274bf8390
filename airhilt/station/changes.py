"""The changes of a run that goes on, in their order, for browsers that come and go.

A browser that comes late gets all changes from the first one on, and so sees the whole run. All but
the newest are compressed, and once there are too many, the oldest are forgotten: a long run needs
little more memory than a short one.
"""

from __future__ import annotations

import json
import threading
import zlib
from collections import deque
from collections.abc import Callable, Sequence
from itertools import islice
from typing import Any, NamedTuple

from airhilt.station.audiences import EVERYBODY, Audience

MOST_CHANGES = 400_000
"""Largest number of changes that are kept: an hour of 20 aircraft, five states a second each."""
MOST_IN_BLOCK = 1_000
"""Largest number of changes that are compressed together."""
MOST_AT_ONCE = 5_000
"""Largest number of changes in one message to a browser."""

Admits = Callable[[Audience], bool]
"""Says of an audience if its changes are wanted."""


class Batch(NamedTuple):
    """Changes for one browser, a JSON array as text, and the number of the change after them."""

    changes: str
    next_number: int


class _Change(NamedTuple):
    text: str
    """JSON."""
    audience: Audience


class _Block:
    """Changes that are compressed: texts of the same kind differ in few places."""

    def __init__(self, changes: Sequence[_Change]) -> None:
        texts = "\n".join(change.text for change in changes)
        self._texts = zlib.compress(texts.encode(), level=1)
        each_once: dict[Audience, Audience] = {}
        self._audiences = [each_once.setdefault(one.audience, one.audience) for one in changes]

    def changes(self) -> list[_Change]:
        texts = zlib.decompress(self._texts).decode().split("\n")
        return [*map(_Change, texts, self._audiences)]


class Changes:
    """Keeps changes, each a JSON value, numbered from 0.

    Parameters
    ----------
    most
        Number of changes that are kept at least; a tenth more are there at most.
    """

    def __init__(self, most: int = MOST_CHANGES) -> None:
        self._most = most
        self._in_block = min(max(most // 10, 1), MOST_IN_BLOCK)
        self._blocks: deque[_Block] = deque()
        self._newest: list[_Change] = []
        self._forgotten = 0
        self._lock = threading.Lock()

    @property
    def next_number(self) -> int:
        """Number of the change that is added next."""
        with self._lock:
            return self._forgotten + self._count

    @property
    def _count(self) -> int:
        return len(self._blocks) * self._in_block + len(self._newest)

    def add(self, *change: Any, audience: Audience = EVERYBODY) -> None:
        """Add a change (any thread): its kind, and what belongs to it.

        Parameters
        ----------
        audience
            Persons at seats who may see it.
        """
        text = json.dumps(change, separators=(",", ":"), allow_nan=False)
        with self._lock:
            self._newest.append(_Change(text, audience))
            if len(self._newest) == 2 * self._in_block:
                self._blocks.append(_Block(self._newest[: self._in_block]))
                del self._newest[: self._in_block]
            if self._count - self._in_block >= self._most:
                self._blocks.popleft()
                self._forgotten += self._in_block

    def since(
        self, number: int, end: int | None = None, admits: Admits = lambda _: True
    ) -> Batch | None:
        """Return changes from a number on, None if there are none; forgotten ones are left out.

        Parameters
        ----------
        end
            Number before which the changes end; None: all.
        admits
            Says which audiences are wanted; changes of others are left out.
        """
        with self._lock:
            begin = max(number - self._forgotten, 0)
            most = begin + MOST_AT_ONCE
            stop = most if end is None else min(most, max(end - self._forgotten, 0))
            kept = self._between(begin, stop)
            next_number = self._forgotten + begin + len(kept)
        if not kept:
            return None
        texts = (change.text for change in kept if admits(change.audience))
        return Batch(f"[{','.join(texts)}]", next_number)

    def _between(self, begin: int, stop: int) -> list[_Change]:
        """Return the changes between two places, counted from the oldest that is kept."""
        first = min(begin // self._in_block, len(self._blocks))
        last = min(-(-stop // self._in_block), len(self._blocks))
        found = [one for block in islice(self._blocks, first, last) for one in block.changes()]
        if last == len(self._blocks):
            found += self._newest
        before = first * self._in_block
        return found[begin - before : max(stop - before, 0)]


class Newest:
    """Keeps the newest change of each kind at a seat, so that who comes late knows what is so."""

    def __init__(self) -> None:
        self._kept: dict[str, tuple[int, str]] = {}
        """Number and JSON of the newest change, by kind."""
        self._next_number = 0
        self._lock = threading.Lock()

    def put(self, kind: str, *what: Any) -> None:
        """Keep a change in the place of the last one of its kind (any thread)."""
        text = json.dumps((kind, *what), separators=(",", ":"), allow_nan=False)
        with self._lock:
            self._kept[kind] = (self._next_number, text)
            self._next_number += 1

    def since(self, number: int) -> Batch | None:
        """Return what is kept of the changes from a number on, None if nothing."""
        with self._lock:
            found = sorted(one for one in self._kept.values() if one[0] >= number)
            next_number = self._next_number
        texts = (text for _, text in found)
        return Batch(f"[{','.join(texts)}]", next_number) if found else None
