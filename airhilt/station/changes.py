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
from collections.abc import Callable, Hashable, Sequence
from itertools import islice, takewhile
from typing import Any, NamedTuple

from airhilt.station.audiences import EVERYBODY, Audience

MOST_CHANGES = 400_000
"""Largest number of changes that are kept: an hour of 20 aircraft, five states a second each."""
MOST_IN_BLOCK = 1_000
"""Largest number of changes that are compressed together."""
MOST_AT_ONCE = 5_000
"""Largest number of changes in one message to a browser."""
MOST_OF_SEAT = 2_000
"""Largest number of tasks, offers, questions and notices of a seat that are kept."""

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


class SeatChanges:
    """Keeps what the person at a seat is told, so that who comes late knows what is in force.

    It keeps the newest of each subject alone: of the seat itself, its instruments and its position,
    of each task, each offer, and each question, which an answer ends. It first forgets the oldest
    of what is not in force any more: tasks that are done, offers that are over, questions that are
    answered, and notices.

    Parameters
    ----------
    most
        Number of tasks, offers, questions and notices that are kept at most.
    """

    def __init__(self, most: int = MOST_OF_SEAT) -> None:
        self._most = most
        self._state: dict[Hashable, _Told] = {}
        """Changes of which there is one of each kind at a seat, in the order of the numbers."""
        self._open: dict[Hashable, _Told] = {}
        """Tasks, offers and questions that are open, by subject, in the order of the numbers."""
        self._past: dict[Hashable, _Told] = {}
        """All else, likewise."""
        self._next_number = 0
        self._lock = threading.Lock()

    def add(self, *change: Any) -> None:
        """Add a change (any thread): its kind, and what belongs to it."""
        text = json.dumps(change, separators=(",", ":"), allow_nan=False)
        with self._lock:
            subject, place = self._place(*change)
            for kept in (self._state, self._open, self._past):
                kept.pop(subject, None)
            place[subject] = _Told(self._next_number, change[0], text)
            self._next_number += 1
            if len(self._open) + len(self._past) > self._most:
                surplus = self._past or self._open
                del surplus[next(iter(surplus))]

    def _place(self, kind: str, what: Any, *_: Any) -> tuple[Hashable, dict[Hashable, _Told]]:
        """Return the subject of a change, and where it is kept."""
        match kind:
            case "info" | "cockpit" | "state":
                return kind, self._state
            case "task":
                return (kind, what["line"]), self._past if what["done"] else self._open
            case "offer":
                return (kind, what["number"]), self._past if what["over"] else self._open
            case "question":
                return (kind, what), self._open
            case "answered":
                return ("question", what), self._past
        return self._next_number, self._past

    def forget_notices(self) -> None:
        """Forget what the person who sat here before was told, for it is not for the next one."""
        with self._lock:
            self._past = {on: told for on, told in self._past.items() if told.kind != "notice"}

    def since(self, number: int) -> Batch | None:
        """Return what is kept of the changes from a number on, None if nothing."""
        with self._lock:
            found = [
                told
                for kept in (self._state, self._open, self._past)
                for told in takewhile(lambda told: told.number >= number, reversed(kept.values()))
            ]
            next_number = self._next_number
        if not found:
            return None
        texts = (told.text for told in sorted(found))
        return Batch(f"[{','.join(texts)}]", next_number)


class _Told(NamedTuple):
    """A change of a seat, JSON as text."""

    number: int
    kind: str
    text: str
