"""The transmissions of a run: they begin, are received, and end; and the truth about each."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass

from airhilt.messages import SpokenTruth, Transcript
from airhilt.phraseology.parties import with_parties
from airhilt.scenario.models import Radio
from airhilt.sensors.base import Publish
from airhilt.sensors.radio.backends import RadioBackend
from airhilt.sensors.radio.frequency_arbiter import FrequencyArbiter
from airhilt.sensors.radio.on_air import OnAir, Utterance
from airhilt.sensors.radio.open_microphone import OpenMicrophone
from airhilt.sensors.radio.receiver import RadioReceiver, SeatReceiver
from airhilt.sensors.radio.reception import Receptions
from airhilt.sensors.radio.stations import Stations
from airhilt.sim import Director


@dataclass(frozen=True, slots=True)
class EndedTransmission:
    """A transmission that has ended and has been published."""

    on_air: OnAir
    is_blocked: bool
    """True if another one was received at the same time."""
    transcript: Transcript | None
    """Its words, where no recogniser is needed to find them."""


class Transmissions:
    """All transmissions of a run.

    Parameters
    ----------
    began
        Called with each utterance when its transmission begins.
    ended
        Called with each transmission when it has ended and has been published.
    roster
        Callsigns that the controller expects.
    seats
        Units and actors at which a person hears; those with a receiver of their own get its sound.
    """

    def __init__(
        self,
        director: Director,
        radio: Radio,
        stations: Stations,
        backend: RadioBackend,
        publish: Publish,
        *,
        began: Callable[[Utterance], None],
        ended: Callable[[EndedTransmission], None],
        roster: Collection[str] = (),
        seats: Collection[str] = (),
    ) -> None:
        self._director = director
        self._controller = radio.controller
        self._roster = roster
        self._receptions = Receptions(radio)
        self._stations = stations
        self._backend = backend
        self._publish = publish
        self._receiver = RadioReceiver(director, self._receptions, stations, backend, publish)
        self._at_seats = [
            SeatReceiver(seat, director, self._receptions, stations, backend, publish)
            for seat in sorted(seats)
            if seat in radio.receivers
        ]

        def open_receivers(on_air: OnAir) -> None:
            self._open(on_air)
            began(on_air.utterance)

        self._arbiter = FrequencyArbiter(
            director,
            backend.speak,
            stations.audible,
            began=open_receivers,
            ended=lambda on_air: ended(self._finish(on_air)),
        )

    def say(self, utterance: Utterance) -> None:
        """Say something as soon as its speaker finds the frequency free."""
        self._arbiter.say(utterance)

    def transmit_carrier(self, utterance: Utterance, for_s: float) -> None:
        """Transmit a carrier without words for a time in s."""
        self._arbiter.transmit_carrier(utterance, for_s)

    def press(self, utterance: Utterance) -> OpenMicrophone:
        """Transmit from now on what a person's microphone gives, until its button is released."""
        return self._arbiter.press(utterance)

    def close(self) -> None:
        """Cut off what is on the air, and publish it as far as it has come; the run ends."""
        for on_air in self._arbiter.close():
            self._finish(on_air)

    def reaches(self, on_air: OnAir, listener: str) -> bool:
        """Return whether a transmission reaches a listener, and no other at the same time."""
        audible = self._stations.audible
        return (
            self._receptions.opens_squelch(on_air.utterance, listener)
            and audible(on_air.utterance.speaker, listener)
            and not any(audible(other.utterance.speaker, listener) for other in on_air.overlapping)
        )

    def _open(self, on_air: OnAir) -> None:
        self._receiver.open(on_air)
        for receiver in self._at_seats:
            receiver.open(on_air)

    def _finish(self, on_air: OnAir) -> EndedTransmission:
        mixed_with = self._receiver.mixed_with(on_air)
        self._publish_truth(on_air, mixed_with)
        transcript = None
        if self._receiver.close(on_air):
            transcript = self._backend.transcript(on_air, mixed_with)
        for receiver in self._at_seats:
            receiver.close(on_air)
        if transcript is not None:
            keyed_by = self._stations.keyed_by(on_air.utterance.speaker)
            transcript = with_parties(transcript, self._roster, self._controller, keyed_by)
        return EndedTransmission(on_air, bool(mixed_with), transcript)

    def _publish_truth(self, on_air: OnAir, mixed_with: tuple[OnAir, ...]) -> None:
        said = on_air.utterance
        truth = SpokenTruth(
            t_ns=self._director.now_ns,
            id=said.id,
            speaker=said.speaker,
            addressed=said.addressed,
            frequency_khz=said.frequency_khz,
            text=said.text,
            t_tx_ns=on_air.t_tx_ns,
            t_end_ns=on_air.t_end_ns,
            in_reply_to=said.in_reply_to,
            blocked_by=tuple(other.utterance.id for other in mixed_with),
            snr_db=self._receptions.of(said).snr_db,
            is_from_microphone=said.is_from_microphone,
        )
        self._publish(f"truth/radio/{said.id}", truth)
