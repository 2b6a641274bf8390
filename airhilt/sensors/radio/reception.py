"""The reception of each call: its noise, and the part of the channel in its sound."""

from __future__ import annotations

from dataclasses import dataclass

from airhilt.scenario.models import Radio
from airhilt.scenario.models.radio import ReceptionSettings
from airhilt.sensors.radio.on_air import Utterance


@dataclass(frozen=True, slots=True)
class Reception:
    """Reception of one call by all receivers."""

    snr_db: float | None
    """Signal-to-noise ratio; None: without noise."""
    wet: float | None
    """Part of the channel in the sound, in [0, 1]; None: that of the channel's profile."""


class Receptions:
    """Reception of the calls of a scenario.

    A line of the script has its own settings. Where it has none, those of its speaker's station
    apply, and where that has none, those of the whole radio.
    """

    def __init__(self, radio: Radio) -> None:
        self._radio = radio
        self._lines = {line.id: line for line in radio.lines}

    def of(self, said: Utterance) -> Reception:
        """Return the reception of an utterance."""
        given = (self._lines.get(said.line or ""), self._radio.stations.get(said.speaker))
        settings: list[ReceptionSettings] = [each for each in given if each is not None]
        settings.append(self._radio)
        return Reception(
            _first([each.snr_db for each in settings]), _first([each.wet for each in settings])
        )

    def opens_squelch(self, said: Utterance) -> bool:
        """Return whether a call is strong enough for receivers not to stay silent."""
        snr_db = self.of(said).snr_db
        return snr_db is None or snr_db >= self._radio.squelch_db


def _first(values: list[float | None]) -> float | None:
    """Return the first value that is given, None if none is."""
    return next((value for value in values if value is not None), None)
