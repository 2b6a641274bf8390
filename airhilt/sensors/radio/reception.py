"""The reception of each call: its noise, and the part of the channel in its sound."""

from __future__ import annotations

from dataclasses import dataclass, replace

from airhilt.scenario.models import Radio
from airhilt.scenario.models.radio import ReceptionSettings
from airhilt.sensors.radio.on_air import Utterance


@dataclass(frozen=True, slots=True)
class Reception:
    """Reception of one call by one receiver."""

    snr_db: float | None
    """Signal-to-noise ratio; None: without noise."""
    wet: float | None
    """Part of the channel in the sound, in [0, 1]; None: that of the channel's profile."""


class Receptions:
    """Reception of the calls of a scenario.

    A line of the script has its own settings. Where it has none, those of its speaker's station
    apply, and where that has none, those of the whole radio. A listener whose receiver has an SNR
    of its own gets no call better than that.
    """

    def __init__(self, radio: Radio) -> None:
        self._radio = radio
        self._lines = {line.id: line for line in radio.lines}

    def of(self, said: Utterance, listener: str | None = None) -> Reception:
        """Return the reception of an utterance by a listener; None: at the units' site.

        The lower SNR counts: that of the call, or that of the listener's receiver. Nobody hears
        the own voice through the own receiver.
        """
        call = self._of_call(said)
        receiver = None if listener is None else self._radio.receivers.get(listener)
        if receiver is None or listener == said.speaker:
            return call
        ratios = (call.snr_db, receiver.snr_db)
        return replace(call, snr_db=min(ratio for ratio in ratios if ratio is not None))

    def opens_squelch(self, said: Utterance, listener: str | None = None) -> bool:
        """Return whether a call is strong enough for a receiver not to stay silent."""
        snr_db = self.of(said, listener).snr_db
        return snr_db is None or snr_db >= self._radio.squelch_db

    def _of_call(self, said: Utterance) -> Reception:
        """Return what a call has by its line, its speaker's station and the radio."""
        given = (self._lines.get(said.line or ""), self._radio.stations.get(said.speaker))
        settings: list[ReceptionSettings] = [each for each in given if each is not None]
        settings.append(self._radio)
        return Reception(
            _first([each.snr_db for each in settings]), _first([each.wet for each in settings])
        )


def _first(values: list[float | None]) -> float | None:
    """Return the first value that is given, None if none is."""
    return next((value for value in values if value is not None), None)
