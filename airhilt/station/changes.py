"""The changes of a run that goes on, in their order, for browsers that come and go.

A browser that comes late gets all changes from the first one on, and so sees the whole run. Once
there are too many, the oldest are forgotten.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from typing import Any, NamedTuple

from airhilt.station.audiences import EVERYBODY, Audience

MOST_CHANGES = 400_000
"""Largest number of changes that are kept: an hour of 20 aircraft, five states a second each."""
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


class Changes:
    """Keeps changes, each a JSON value, numbered from 0.

    Parameters
    ----------
    most
        Number of changes that are kept at least; a tenth more are there at most.
    """

    def __init__(self, most: int = MOST_CHANGES) -> None:
        self._most = most
        self._kept: list[_Change] = []
        self._forgotten = 0
        self._lock = threading.Lock()

    @property
    def next_number(self) -> int:
        """Number of the change that is added next."""
        with self._lock:
            return self._forgotten + len(self._kept)

    def add(self, *change: Any, audience: Audience = EVERYBODY) -> None:
        """Add a change (any thread): its kind, and what belongs to it.

        Parameters
        ----------
        audience
            Persons at seats who may see it.
        """
        text = json.dumps(change, separators=(",", ":"), allow_nan=False)
        with self._lock:
            self._kept.append(_Change(text, audience))
            if (surplus := len(self._kept) - self._most) > self._most // 10:
                del self._kept[:surplus]
                self._forgotten += surplus

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
            stop = begin + MOST_AT_ONCE
            if end is not None:
                stop = max(min(stop, end - self._forgotten), 0)
            wanted = self._kept[begin:stop]
            next_number = self._forgotten + begin + len(wanted)
        if not wanted:
            return None
        texts = (change.text for change in wanted if admits(change.audience))
        return Batch(f"[{','.join(texts)}]", next_number)


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
