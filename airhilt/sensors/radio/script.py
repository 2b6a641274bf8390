"""The scripted calls: when each is due."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import Condition, RadioLine
from airhilt.sensors.radio.backend import RadioBackend
from airhilt.sim import Director, Priority
from airhilt.units import seconds_to_ns


class RadioScript:
    """Says when a line is to be said: not before its time, nor before its condition is true.

    Parameters
    ----------
    once
        Calls its second argument as soon as its first, a condition, is true.
    failed
        Called with each line that something is wrong with, when it would have been said.
    due
        Called with each line when it is to be said, as it is said.
    """

    def __init__(
        self,
        director: Director,
        lines: Sequence[EffectiveLine],
        once: Callable[[Condition, Callable[[], None]], None],
        failed: Callable[[EffectiveLine], None],
        due: Callable[[RadioLine], None],
    ) -> None:
        self._director = director
        self._once = once
        self._failed = failed
        self._say = due
        for happening in lines:
            at_ns = seconds_to_ns(happening.declared.at_s)
            director.at(at_ns, partial(self._await, happening), Priority.SCRIPT)

    def _await(self, happening: EffectiveLine) -> None:
        if happening.declared.when is None:
            self._due(happening)
        else:
            self._once(happening.declared.when, partial(self._due, happening))

    def _due(self, happening: EffectiveLine) -> None:
        if happening.failures:
            self._failed(happening)
        if happening.line is None:
            return
        say = partial(self._say, happening.line)
        if happening.late_s == 0.0:
            say()
        else:
            due_ns = self._director.now_ns + seconds_to_ns(happening.late_s)
            self._director.at(due_ns, say, Priority.SCRIPT)


def planned_ends_ns(lines: Sequence[EffectiveLine], sound: RadioBackend) -> dict[str, int]:
    """Return when each line, by its id, ends if it waits for nothing and its frequency is free.

    Raises
    ------
    airhilt.errors.SpeechError
        Its voices have failed.
    """
    ends_ns = {}
    for happening in lines:
        line = happening.line or happening.declared
        _, duration_s = sound.speak(line.speaker, line.text)
        ends_ns[line.id] = seconds_to_ns(line.at_s + happening.late_s) + seconds_to_ns(duration_s)
    return ends_ns
