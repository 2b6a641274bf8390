"""The receivers of a run: the one at the units' site, and those of seats that have their own."""

from __future__ import annotations

from airhilt.audio.pcm import SAMPLE_BYTES
from airhilt.messages import (
    SeatAudioChunk,
    SeatAudioClosed,
    SeatAudioOpened,
    Transmission,
    TransmissionChunk,
    TransmissionClosed,
    TransmissionOpened,
    key_chunk,
)
from airhilt.sensors.base import Publish
from airhilt.sensors.radio.audio_streams import AudioHeader, AudioStreams, sha256_of
from airhilt.sensors.radio.backends import RadioBackend
from airhilt.sensors.radio.on_air import OnAir
from airhilt.sensors.radio.reception import Receptions
from airhilt.sensors.radio.stations import Stations
from airhilt.sim import Director

AT_SEAT: dict[type[AudioHeader], type[SeatAudioOpened | SeatAudioChunk | SeatAudioClosed]] = {
    TransmissionOpened: SeatAudioOpened,
    TransmissionChunk: SeatAudioChunk,
    TransmissionClosed: SeatAudioClosed,
}
"""Messages of the receiver of a seat, by those of the one at the units' site."""


class RadioReceiver:
    """Publishes what is received: chunks on ``audio`` while a call lasts, all of it on ``tx``."""

    def __init__(
        self,
        director: Director,
        receptions: Receptions,
        stations: Stations,
        backend: RadioBackend,
        publish: Publish,
    ) -> None:
        self._receptions = receptions
        self._stations = stations
        self._publish = publish

        def publish_audio(header: AudioHeader, pcm: bytes) -> None:
            publish(f"radio/{header.frequency_khz}/audio", header, raw=pcm)

        self._streams = AudioStreams(None, director, receptions, stations, backend, publish_audio)

    def mixed_with(self, on_air: OnAir) -> tuple[OnAir, ...]:
        """Return the other transmissions that are received at the same time as one."""
        return self._streams.mixed_with(on_air)

    def open(self, on_air: OnAir) -> None:
        """Begin to stream a transmission, if it is received."""
        self._streams.open(on_air)

    def close(self, on_air: OnAir) -> bool:
        """Publish a transmission that has ended, and return whether it was received.

        One that could not be received when it began, but can be now, is published as a whole
        without having been streamed.
        """
        pcm = self._streams.close(on_air)
        if pcm is not None:
            self._publish_whole(on_air, pcm)
        return pcm is not None

    def _publish_whole(self, on_air: OnAir, pcm: bytes) -> None:
        transmission = Transmission(
            t_ns=on_air.t_end_ns,
            id=on_air.utterance.id,
            frequency_khz=on_air.utterance.frequency_khz,
            t_tx_ns=on_air.t_tx_ns,
            t_end_ns=on_air.t_end_ns,
            keyed_by=self._stations.keyed_by(on_air.utterance.speaker),
            snr_db=self._receptions.of(on_air.utterance).snr_db,
            samples=len(pcm) // SAMPLE_BYTES,
            sha256=sha256_of(pcm),
        )
        self._publish(f"radio/{transmission.frequency_khz}/tx", transmission, raw=pcm)


class SeatReceiver:
    """Publishes what the receiver of a seat gets on the frequencies of the seat."""

    def __init__(
        self,
        seat: str,
        director: Director,
        receptions: Receptions,
        stations: Stations,
        backend: RadioBackend,
        publish: Publish,
    ) -> None:
        self._frequencies_khz = frozenset(stations.selectable(seat))

        def publish_audio(header: AudioHeader, pcm: bytes) -> None:
            message = AT_SEAT[type(header)](seat=seat, **dict(header))
            publish(f"seat/{key_chunk(seat)}/audio", message, raw=pcm)

        self._streams = AudioStreams(seat, director, receptions, stations, backend, publish_audio)

    def open(self, on_air: OnAir) -> None:
        """Begin to stream a transmission, if it is received."""
        if on_air.utterance.frequency_khz in self._frequencies_khz:
            self._streams.open(on_air)

    def close(self, on_air: OnAir) -> None:
        """Publish the end of a transmission that was streamed."""
        if self._streams.has_open(on_air):
            self._streams.close(on_air)
