"""The discrete-event loop: a heap of (t_ns, priority, sequence)."""

from __future__ import annotations

import heapq
from collections import deque
from collections.abc import Callable
from enum import IntEnum
from functools import partial
from threading import Event
from typing import Protocol

from airhilt.sim.pace import Pace
from airhilt.units import seconds_to_ns

Action = Callable[[], None]


class Priority(IntEnum):
    """Order of events of one instant: the world moves, sensors measure, workers answer."""

    PHYSICS = 0
    SCRIPT = 1
    SENSOR = 2
    RESULT = 3
    START = 4
    """Workers whose inputs are due are called, all of an instant before any is waited for."""
    SETTLE = 5
    OBSERVE = 6


class Scheduler(Protocol):
    """The part of a director that measurements are scheduled with."""

    @property
    def now_ns(self) -> int:
        """Simulation time."""

    def at(self, t_ns: int, action: Action, priority: Priority) -> None:
        """Schedule an action at a time that is not past."""

    def every(self, period_ns: int, action: Action, priority: Priority, first_ns: int = 0) -> None:
        """Schedule an action at a first time and then once every period."""

    def post(self, action: Action) -> None:
        """Run an action as soon as possible, at whatever time it then is (any thread)."""


class Director:
    """Runs events in order of simulation time.

    Events of one instant and priority run in the order in which they were scheduled, so a run
    depends on nothing but what is scheduled. Only `post` may be called from another thread.
    """

    def __init__(self, pace: Pace) -> None:
        self.now_ns = 0
        self.pace = pace
        self._heap: list[tuple[int, int, int, Action]] = []
        self._sequence = 0
        self._posted: deque[Action] = deque()
        self._wake = Event()
        self._stopped = False
        self._interrupted = False
        self._most_behind_ns: int | None = None
        self._stalled: Callable[[int], None] = lambda _: None

    @property
    def behind_ns(self) -> int:
        """Simulation time by which the events are later than the pace asks."""
        return self.pace.elapsed_ns(self.now_ns) - self.now_ns

    def at(self, t_ns: int, action: Action, priority: Priority) -> None:
        """Schedule ``action`` at ``t_ns``, an int that does not lie in the past."""
        if not isinstance(t_ns, int):
            raise TypeError(f"event at {t_ns!r} ns; expected an int")
        if t_ns < self.now_ns:
            raise ValueError(f"event at {t_ns} ns, but it is already {self.now_ns} ns")
        heapq.heappush(self._heap, (t_ns, priority, self._sequence, action))
        self._sequence += 1

    def after(self, delay_s: float, action: Action) -> None:
        """Schedule ``action`` at a delay in s from now, as a part of the script."""
        self.at(self.now_ns + seconds_to_ns(delay_s), action, Priority.SCRIPT)

    def every(self, period_ns: int, action: Action, priority: Priority, first_ns: int = 0) -> None:
        """Schedule ``action`` at ``first_ns`` and then once every ``period_ns``, more than 0."""
        if period_ns <= 0:
            raise ValueError(f"period of {period_ns} ns; it must be positive")

        self.at(first_ns, partial(self._tick, period_ns, action, priority), priority)

    def _tick(self, period_ns: int, action: Action, priority: Priority) -> None:
        """Do an action, and schedule it again after its period."""
        action()
        self.at(self.now_ns + period_ns, partial(self._tick, period_ns, action, priority), priority)

    def post(self, action: Action) -> None:
        """Run ``action`` as soon as possible, at whatever time it then is (any thread)."""
        self._posted.append(action)
        self._wake.set()

    def interrupt(self) -> None:
        """Let `run` raise KeyboardInterrupt after the event in hand (from a signal handler)."""
        self._interrupted = True

    def stop(self) -> None:
        """End `run` after the event in hand."""
        self._stopped = True

    def clear(self) -> None:
        """Forget all that is scheduled: the run is over."""
        self._heap.clear()
        self._posted.clear()
        self._most_behind_ns, self._stalled = None, lambda _: None

    def lose_time(self, most_behind_ns: int, stalled: Callable[[int], None]) -> None:
        """Lose the time by which events are later than a limit, rather than make up for it.

        ``stalled`` is called after that, with the time that was lost in ns, as something that was
        posted.
        """
        self._most_behind_ns, self._stalled = most_behind_ns, stalled

    def change_pace(self, pace: Pace) -> None:
        """Go on at another pace from now."""
        pace.start(self.now_ns)
        self.pace = pace

    def run(self, until_ns: int | None = None) -> bool:
        """Run events until `stop` is called or none is left; `interrupt` raises KeyboardInterrupt.

        With a time, it returns before the first event that is later; it returns true if the next
        call goes on from there. A run in steps has the same events as a whole one.

        What was posted runs between two instants, never among the events of one, so that it can
        be repeated from its time alone. Where two instants leave no room for it, the second comes
        first, at once: a pause would never come to it.
        """
        heap, posted, pop = self._heap, self._posted, heapq.heappop
        self.pace.start(self.now_ns)
        while heap and not self._stopped:
            if self._interrupted:
                raise KeyboardInterrupt
            t_ns = heap[0][0]
            if until_ns is not None and t_ns > until_ns:
                return True
            if self._most_behind_ns is not None:
                self._lose_time(t_ns, self._most_behind_ns)
            if posted and t_ns > self.now_ns + 1:
                elapsed_ns = self.pace.elapsed_ns(self.now_ns)
                self.now_ns = min(max(elapsed_ns, self.now_ns + 1), t_ns - 1)
                posted.popleft()()
            elif posted or self.pace.wait_until(t_ns, self._wake):
                self.now_ns, _, _, action = pop(heap)
                action()
            else:
                self._wake.clear()
        return False

    def _lose_time(self, t_ns: int, most_behind_ns: int) -> None:
        """Take the clock anew if the next event, at ``t_ns``, is too late."""
        if self.pace.elapsed_ns(t_ns) - t_ns > most_behind_ns:
            self._posted.appendleft(partial(self._stalled, self.behind_ns))
            self.pace.start(self.now_ns)
