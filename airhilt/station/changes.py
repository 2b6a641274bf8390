"""The changes of a run that goes on, in their order, for browsers that come and go.

A browser that comes late gets all changes from the first one on, and so sees the whole run. Once
there are too many, the oldest are forgotten, so that a long run needs no more memory.
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


class Changes:
    """Keeps changes, each a JSON value, numbered from 0.

    Parameters
    ----------
    most
        Number of changes that are kept at least; a tenth more is there before the oldest go.
    """

    def __init__(self, most: int = MOST_CHANGES) -> None:
        self._most = most
        self._kept: list[tuple[str, Audience]] = []
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
            self._kept.append((text, audience))
            if len(self._kept) > self._most * 1.1:
                surplus = len(self._kept) - self._most
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
            most = begin + MOST_AT_ONCE
            stop = most if end is None else min(most, max(end - self._forgotten, 0))
            kept = self._kept[begin:stop]
            next_number = self._forgotten + begin + len(kept)
        if not kept:
            return None
        texts = (text for text, audience in kept if admits(audience))
        return Batch(f"[{','.join(texts)}]", next_number)
