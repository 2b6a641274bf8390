"""The scripted calls: who says what when, one at a time on each frequency."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from airhilt.scenario.failures import HappeningLine
from airhilt.scenario.models import Condition, RadioLine
from airhilt.sim import Director, Priority
from airhilt.units import seconds_to_ns

GAP_S = 0.4
"""Pause before a call that had to wait for the frequency."""


@dataclass(frozen=True, slots=True)
class Spoken:
    """A call that has ended."""

    line: RadioLine
    """As it was said."""
    t_tx_ns: int
    t_end_ns: int


class RadioScript:
    """Plays the lines in time; a call waits until its frequency is free.

    Parameters
    ----------
    once
        Calls its second argument as soon as its first, a condition, is true.
    failed
        Called with each line that something is wrong with, when it would have been said.
    ended
        Called with each call that has ended.
    """

    def __init__(
        self,
        director: Director,
        lines: Sequence[HappeningLine],
        words_per_minute: float,
        once: Callable[[Condition, Callable[[], None]], None],
        failed: Callable[[HappeningLine], None],
        ended: Callable[[Spoken], None],
    ) -> None:
        self._director = director
        self._seconds_per_word = 60.0 / words_per_minute
        self._once = once
        self._failed = failed
        self._ended = ended
        self._busy_until_ns: dict[int, int] = {}
        for happening in lines:
            at_ns = seconds_to_ns(happening.declared.at_s)
            director.at(at_ns, partial(self._await, happening), Priority.SCRIPT)

    def planned_end_ns(self, happening: HappeningLine) -> int:
        """Return when a line ends if it waits for nothing and its frequency is free."""
        line = happening.line or happening.declared
        return seconds_to_ns(line.at_s + happening.late_s) + self._duration_ns(line)

    def _duration_ns(self, line: RadioLine) -> int:
        return seconds_to_ns(len(line.text.split()) * self._seconds_per_word)

    def _await(self, happening: HappeningLine) -> None:
        if happening.declared.when is None:
            self._due(happening)
        else:
            self._once(happening.declared.when, partial(self._due, happening))

    def _due(self, happening: HappeningLine) -> None:
        if happening.failures:
            self._failed(happening)
        if happening.line is None:
            return
        begin = partial(self._begin, happening.line)
        if happening.late_s == 0.0:
            begin()
        else:
            due_ns = self._director.now_ns + seconds_to_ns(happening.late_s)
            self._director.at(due_ns, begin, Priority.SCRIPT)

    def _begin(self, line: RadioLine) -> None:
        now_ns = self._director.now_ns
        free_ns = self._busy_until_ns.get(line.frequency_khz, 0)
        if free_ns > now_ns:
            again = free_ns + seconds_to_ns(GAP_S)
            self._director.at(again, partial(self._begin, line), Priority.SCRIPT)
            return
        end_ns = now_ns + self._duration_ns(line)
        self._busy_until_ns[line.frequency_khz] = end_ns
        spoken = Spoken(line, now_ns, end_ns)
        self._director.at(end_ns, partial(self._ended, spoken), Priority.SCRIPT)
