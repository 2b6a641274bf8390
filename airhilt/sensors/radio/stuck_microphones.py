"""Microphones that are stuck: carriers that block their frequencies for a time."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

from airhilt.scenario.models import Failure, StuckMicrophone
from airhilt.sensors.radio.on_air import Utterance
from airhilt.sensors.radio.stations import Stations
from airhilt.sensors.radio.surroundings import RadioFailures
from airhilt.sensors.radio.transmissions import Transmissions
from airhilt.sim import Director, Priority
from airhilt.units import seconds_to_ns


class StuckMicrophones:
    """Lets the microphones of a scenario get stuck, and come free again."""

    def __init__(
        self,
        director: Director,
        stations: Stations,
        transmissions: Transmissions,
        failures: RadioFailures,
    ) -> None:
        self._director = director
        self._stations = stations
        self._transmissions = transmissions
        self._failures = failures
        self._count = 0
        """Number of microphones that are stuck."""

    def schedule(self, failures: Iterable[Failure]) -> None:
        """Schedule the failures that are stuck microphones."""
        for failure in failures:
            if isinstance(failure, StuckMicrophone):
                at_ns = seconds_to_ns(failure.at_s)
                self._director.at(at_ns, partial(self._begin, failure), Priority.SCRIPT)

    def _begin(self, failure: StuckMicrophone) -> None:
        actor = failure.actor
        self._count += 1
        self._failures.microphone_stuck(actor, f"its microphone is stuck for {failure.for_s:g} s")
        free_ns = self._director.now_ns + seconds_to_ns(failure.for_s)
        self._director.at(free_ns, self._end, Priority.SCRIPT)
        for frequency_khz in self._stations.frequencies_of(actor):
            name = f"stuck-microphone.{actor}.{failure.at_s:g}.{frequency_khz}"
            carrier = Utterance(name, frequency_khz, actor, None, "")
            self._transmissions.transmit_carrier(carrier, failure.for_s)

    def _end(self) -> None:
        self._count -= 1
        if not self._count:
            self._failures.microphones_free()
