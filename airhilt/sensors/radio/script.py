"""Scripted calls and stuck microphones, and when each is due."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import RadioLine, StuckMicrophone
from airhilt.sensors.radio.backends import RadioBackend
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.frequency_arbiter import FrequencyArbiter
from airhilt.sensors.radio.on_air import Utterance
from airhilt.sim import Priority
from airhilt.units import seconds_to_ns


class RadioScript:
    """Says each line not before its time, nor before its condition is true; microphones get stuck.

    A line is said with the words that failures give it.
    """

    def __init__(
        self, context: RadioContext, arbiter: FrequencyArbiter, say: Callable[[RadioLine], None]
    ) -> None:
        self._context = context
        self._arbiter = arbiter
        self._say = say
        self._stuck = 0
        """Number of microphones that are stuck."""

    def start(self) -> None:
        """Schedule all lines, and the microphones that get stuck."""
        at = self._context.director.at
        for line in self._context.lines:
            at(seconds_to_ns(line.declared.at_s), partial(self._await, line), Priority.SCRIPT)
        for failure in self._context.scenario.failures:
            if isinstance(failure, StuckMicrophone):
                at(seconds_to_ns(failure.at_s), partial(self._stick, failure), Priority.SCRIPT)

    def _await(self, line: EffectiveLine) -> None:
        if line.declared.when is None:
            self._due(line)
        else:
            self._context.world.once(line.declared.when, partial(self._due, line))

    def _due(self, line: EffectiveLine) -> None:
        if line.failures:
            self._context.failures.line_failed(line)
        if line.line is None:
            return
        say = partial(self._say, line.line)
        if line.late_s == 0.0:
            say()
        else:
            self._context.director.after(line.late_s, say)

    def _stick(self, failure: StuckMicrophone) -> None:
        """Block the frequencies of an actor by a carrier for a time."""
        context, actor, for_s = self._context, failure.actor, failure.for_s
        self._stuck += 1
        context.failures.microphone_stuck(actor, f"its microphone is stuck for {for_s:g} s")
        context.director.after(for_s, self._come_free)
        for frequency_khz in context.stations.frequencies_of(actor):
            name = f"stuck-microphone.{actor}.{failure.at_s:g}.{frequency_khz}"
            carrier = Utterance(name, frequency_khz, actor, None, "")
            self._arbiter.transmit_carrier(carrier, for_s)

    def _come_free(self) -> None:
        self._stuck -= 1
        if not self._stuck:
            self._context.failures.microphones_free()


def planned_ends_ns(lines: Sequence[EffectiveLine], backend: RadioBackend) -> dict[str, int]:
    """Return the end of each line, by its id, if nothing delays it, or raise SpeechError."""
    ends_ns = {}
    for effective in lines:
        line = effective.line or effective.declared
        _, duration_s = backend.speak(line.speaker, line.text)
        begin_ns = seconds_to_ns(line.at_s + effective.late_s)
        ends_ns[line.id] = begin_ns + seconds_to_ns(duration_s)
    return ends_ns
