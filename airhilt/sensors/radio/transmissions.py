"""The transmissions of a run: they are received, and end; and the truth about each."""

from __future__ import annotations

from typing import NamedTuple

from airhilt.audio.pcm import SAMPLE_BYTES
from airhilt.messages import SpokenTruth, Transcript, Transmission
from airhilt.phraseology.parties import with_parties
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.on_air import OnAir
from airhilt.sensors.radio.receiver import RadioReceiver, sha256_of


class EndedTransmission(NamedTuple):
    """Outcome of a transmission that has ended and been published."""

    is_blocked: bool
    """True if another one was received at the same time."""
    transcript: Transcript | None
    """Its words, where no recogniser is needed to find them."""


class Transmissions:
    """All transmissions of a run, at the units' receiver and at seats with one of their own."""

    def __init__(self, context: RadioContext) -> None:
        self._context = context
        self._receiver = RadioReceiver(context)
        seats = sorted(state.seat for state in context.seats)
        own = [seat for seat in seats if seat in context.radio.receivers]
        self._receivers = [self._receiver, *(RadioReceiver(context, seat) for seat in own)]

    def open(self, on_air: OnAir) -> None:
        """Begin to stream a transmission at each receiver that gets it."""
        for receiver in self._receivers:
            receiver.open(on_air)

    def finish(self, on_air: OnAir) -> EndedTransmission:
        """Publish a transmission that has ended, and the truth about it."""
        context, said = self._context, on_air.utterance
        mixed_with = self._receiver.mixed_with(on_air)
        self._publish_truth(on_air, mixed_with)
        transcript = None
        pcm = self._receiver.close(on_air)
        if pcm is not None:
            self._publish_whole(on_air, pcm)
            transcript = context.backend.transcript(on_air, mixed_with)
        for receiver in self._receivers[1:]:
            receiver.close(on_air)
        if transcript is not None:
            keyed_by = context.stations.keyed_by(said.speaker)
            roster, controller = context.scenario.roster, context.radio.controller
            transcript = with_parties(transcript, roster, controller, keyed_by)
        return EndedTransmission(bool(mixed_with), transcript)

    def reaches(self, on_air: OnAir, listener: str) -> bool:
        """Return whether a transmission reaches a listener, and no other at the same time."""
        audible = self._context.stations.audible
        return (
            self._context.receptions.opens_squelch(on_air.utterance, listener)
            and audible(on_air.utterance.speaker, listener)
            and not any(audible(other.utterance.speaker, listener) for other in on_air.overlapping)
        )

    def _publish_truth(self, on_air: OnAir, mixed_with: tuple[OnAir, ...]) -> None:
        said = on_air.utterance
        truth = SpokenTruth(
            t_ns=self._context.director.now_ns,
            id=said.id,
            speaker=said.speaker,
            addressed=said.addressed,
            frequency_khz=said.frequency_khz,
            text=said.text,
            t_tx_ns=on_air.t_tx_ns,
            t_end_ns=on_air.t_end_ns,
            in_reply_to=said.in_reply_to,
            blocked_by=tuple(other.utterance.id for other in mixed_with),
            snr_db=self._context.receptions.of(said).snr_db,
            is_from_microphone=said.is_from_microphone,
        )
        self._context.publish(f"truth/radio/{said.id}", truth)

    def _publish_whole(self, on_air: OnAir, pcm: bytes) -> None:
        said = on_air.utterance
        transmission = Transmission(
            t_ns=on_air.t_end_ns,
            id=said.id,
            frequency_khz=said.frequency_khz,
            t_tx_ns=on_air.t_tx_ns,
            t_end_ns=on_air.t_end_ns,
            keyed_by=self._context.stations.keyed_by(said.speaker),
            snr_db=self._context.receptions.of(said).snr_db,
            samples=len(pcm) // SAMPLE_BYTES,
            sha256=sha256_of(pcm),
        )
        self._context.publish(f"radio/{said.frequency_khz}/tx", transmission, raw=pcm)
