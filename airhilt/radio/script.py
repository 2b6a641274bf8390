"""The scripted calls: who says what when, one at a time on each frequency."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from airhilt.scenario.models import RadioLine
from airhilt.sim import Director, Priority
from airhilt.units import seconds_to_ns

GAP_S = 0.4
"""Pause before a call that had to wait for the frequency."""


@dataclass(frozen=True, slots=True)
class Spoken:
    """A call that has ended."""

    line: RadioLine
    t_tx_ns: int
    t_end_ns: int


class RadioScript:
    """Plays the lines in time; a call waits until its frequency is free."""

    def __init__(
        self,
        director: Director,
        lines: Sequence[RadioLine],
        words_per_minute: float,
        ended: Callable[[Spoken], None],
    ) -> None:
        self._director = director
        self._seconds_per_word = 60.0 / words_per_minute
        self._ended = ended
        self._busy_until_ns: dict[int, int] = {}
        for line in lines:
            director.at(seconds_to_ns(line.at_s), partial(self._begin, line), Priority.SCRIPT)

    def planned_end_ns(self, line: RadioLine) -> int:
        """Return when a line ends if its frequency is free."""
        return seconds_to_ns(line.at_s) + self._duration_ns(line)

    def _duration_ns(self, line: RadioLine) -> int:
        return seconds_to_ns(len(line.text.split()) * self._seconds_per_word)

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
