"""The receiver at the units' site: the audio of a transmission while it lasts, then all of it."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from functools import partial

from airhilt.audio.pcm import SAMPLE_BYTES
from airhilt.messages import (
    Transmission,
    TransmissionChunk,
    TransmissionClosed,
    TransmissionOpened,
)
from airhilt.sensors.base import Publish
from airhilt.sensors.radio.backends import RadioBackend
from airhilt.sensors.radio.on_air import OnAir
from airhilt.sensors.radio.received_audio import Chunk, ReceivedAudio
from airhilt.sensors.radio.reception import Receptions
from airhilt.sensors.radio.stations import Stations
from airhilt.sim import Director, Priority
from airhilt.units import SECOND_NS

CHUNK_NS = SECOND_NS // 2
"""Period in ns at which the audio of a transmission is published while it lasts."""


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
        self._director = director
        self._stations = stations
        self._backend = backend
        self._publish = publish
        self._receptions = receptions
        self._streams: dict[OnAir, ReceivedAudio] = {}
        """Audio of the transmissions that are being streamed."""

    def mixed_with(self, on_air: OnAir) -> tuple[OnAir, ...]:
        """Return the other transmissions that are received at the same time as one."""
        return tuple(
            other
            for other in on_air.overlapping
            if self._stations.received(other.utterance.speaker)
        )

    def open(self, on_air: OnAir) -> None:
        """Begin to stream a transmission, if it is received."""
        if self._receives(on_air):
            self._streams[on_air] = self._audio_of(on_air)
            self._publish_audio(
                TransmissionOpened(
                    t_ns=on_air.t_tx_ns,
                    id=on_air.utterance.id,
                    frequency_khz=on_air.utterance.frequency_khz,
                    t_tx_ns=on_air.t_tx_ns,
                    keyed_by=self._stations.keyed_by(on_air.utterance.speaker),
                )
            )
            self._stream_later(on_air)

    def close(self, on_air: OnAir) -> bool:
        """Publish a transmission that has ended, and return whether it was received.

        One that could not be received when it began, but can be now, is published as a whole
        without having been streamed.
        """
        if not self._receives(on_air):
            if on_air in self._streams:
                self._close_stream(on_air, is_complete=False)
            return False
        audio = self._streams.get(on_air) or self._audio_of(on_air)
        rest = []
        if self._backend.has_sound:
            rest = audio.give_rest(self._director.now_ns, self.mixed_with(on_air))
        has_sound = self._backend.has_sound  # It may have been lost just now.
        if on_air in self._streams:
            self._publish_chunks(on_air, rest)
            self._close_stream(on_air, is_complete=has_sound or not audio.samples)
        self._publish_whole(on_air, audio.pcm if has_sound else b"")
        return True

    def _receives(self, on_air: OnAir) -> bool:
        said = on_air.utterance
        return self._receptions.opens_squelch(said) and self._stations.received(said.speaker)

    def _audio_of(self, on_air: OnAir) -> ReceivedAudio:
        background = self._stations.background_of(on_air.utterance.speaker)

        def receive(mixed_with: tuple[OnAir, ...], begin: int, now_ns: int) -> bytes:
            return self._backend.receive(on_air, mixed_with, background, begin, now_ns)

        return ReceivedAudio(on_air, receive)

    def _stream_later(self, on_air: OnAir) -> None:
        due_ns = self._director.now_ns + CHUNK_NS
        self._director.at(due_ns, partial(self._stream, on_air), Priority.SENSOR)

    def _stream(self, on_air: OnAir) -> None:
        """Publish what has been on the air since the last chunk."""
        audio = self._streams.get(on_air)
        if audio is None or not self._backend.has_sound:
            return
        if not self._receives(on_air):
            self._close_stream(on_air, is_complete=False)
            return
        chunks = audio.give_until(self._director.now_ns, self.mixed_with(on_air))
        self._publish_chunks(on_air, chunks)
        self._stream_later(on_air)

    def _publish_chunks(self, on_air: OnAir, chunks: Iterable[Chunk]) -> None:
        for chunk in chunks:
            header = TransmissionChunk(
                t_ns=self._director.now_ns,
                id=on_air.utterance.id,
                frequency_khz=on_air.utterance.frequency_khz,
                seq=chunk.seq,
                first_sample=chunk.first_sample,
                samples=len(chunk.pcm) // SAMPLE_BYTES,
                sha256=_sha256(chunk.pcm),
            )
            self._publish_audio(header, chunk.pcm)

    def _close_stream(self, on_air: OnAir, *, is_complete: bool) -> None:
        audio = self._streams.pop(on_air)
        self._publish_audio(
            TransmissionClosed(
                t_ns=self._director.now_ns,
                id=on_air.utterance.id,
                frequency_khz=on_air.utterance.frequency_khz,
                t_tx_ns=on_air.t_tx_ns,
                t_end_ns=self._director.now_ns,
                samples=audio.samples,
                sha256=_sha256(audio.pcm),
                snr_db=self._receptions.of(on_air.utterance).snr_db,
                is_complete=is_complete,
            )
        )

    def _publish_audio(
        self,
        header: TransmissionOpened | TransmissionChunk | TransmissionClosed,
        pcm: bytes = b"",
    ) -> None:
        self._publish(f"radio/{header.frequency_khz}/audio", header, raw=pcm)

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
            sha256=_sha256(pcm),
        )
        self._publish(f"radio/{transmission.frequency_khz}/tx", transmission, raw=pcm)


def _sha256(pcm: bytes) -> str:
    """Return the SHA-256 of samples; empty if there are none."""
    return hashlib.sha256(pcm).hexdigest() if pcm else ""
