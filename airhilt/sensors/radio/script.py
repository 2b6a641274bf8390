"""The scripted calls, and when each is due."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import RadioLine
from airhilt.sensors.radio.backends import RadioBackend
from airhilt.sensors.radio.surroundings import RadioFailures, RadioWorld
from airhilt.sim import Director, Priority
from airhilt.units import seconds_to_ns


class RadioScript:
    """Determines when a line is said: not before its time, nor before its condition is true.

    Parameters
    ----------
    due
        Called with each line when it is to be said, with the words that failures give it.
    """

    def __init__(
        self,
        director: Director,
        lines: Sequence[EffectiveLine],
        world: RadioWorld,
        failures: RadioFailures,
        due: Callable[[RadioLine], None],
    ) -> None:
        self._director = director
        self._lines = lines
        self._world = world
        self._failures = failures
        self._say = due

    def start(self) -> None:
        """Schedule all lines."""
        for line in self._lines:
            at_ns = seconds_to_ns(line.declared.at_s)
            self._director.at(at_ns, partial(self._await, line), Priority.SCRIPT)

    def _await(self, line: EffectiveLine) -> None:
        if line.declared.when is None:
            self._due(line)
        else:
            self._world.once(line.declared.when, partial(self._due, line))

    def _due(self, line: EffectiveLine) -> None:
        if line.failures:
            self._failures.line_failed(line)
        if line.line is None:
            return
        say = partial(self._say, line.line)
        if line.late_s == 0.0:
            say()
        else:
            due_ns = self._director.now_ns + seconds_to_ns(line.late_s)
            self._director.at(due_ns, say, Priority.SCRIPT)


def planned_ends_ns(lines: Sequence[EffectiveLine], backend: RadioBackend) -> dict[str, int]:
    """Return the end of each line, by its id, if nothing delays it.

    Raises
    ------
    airhilt.errors.SpeechError
        The voices have failed.
    """
    ends_ns = {}
    for effective in lines:
        line = effective.line or effective.declared
        _, duration_s = backend.speak(line.speaker, line.text)
        begin_ns = seconds_to_ns(line.at_s + effective.late_s)
        ends_ns[line.id] = begin_ns + seconds_to_ns(duration_s)
    return ends_ns
