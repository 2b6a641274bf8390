"""The audio of the transmissions that one receiver gets, given out while they last."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from functools import partial

from airhilt.audio.pcm import SAMPLE_BYTES
from airhilt.messages import TransmissionChunk, TransmissionClosed, TransmissionOpened
from airhilt.sensors.radio.backends import RadioBackend
from airhilt.sensors.radio.on_air import OnAir
from airhilt.sensors.radio.received_audio import Chunk, ReceivedAudio
from airhilt.sensors.radio.reception import Receptions
from airhilt.sensors.radio.stations import Stations
from airhilt.sim import Director, Priority
from airhilt.units import SECOND_NS

CHUNK_NS = SECOND_NS // 2
"""Period in ns at which the audio of a transmission is published while it lasts."""

AudioHeader = TransmissionOpened | TransmissionChunk | TransmissionClosed
PublishAudio = Callable[[AudioHeader, bytes], None]
"""Called with a header and its PCM."""


class AudioStreams:
    """Streams what one receiver gets: it opens, chunks while it lasts, and it closes.

    Parameters
    ----------
    listener
        Owner of the receiver; None: it is the one at the units' site.
    """

    def __init__(
        self,
        listener: str | None,
        director: Director,
        receptions: Receptions,
        stations: Stations,
        backend: RadioBackend,
        publish: PublishAudio,
    ) -> None:
        self._listener = listener
        self._director = director
        self._receptions = receptions
        self._stations = stations
        self._backend = backend
        self._publish = publish
        self._streams: dict[OnAir, ReceivedAudio] = {}
        """Audio of the transmissions that are being streamed."""

    def mixed_with(self, on_air: OnAir) -> tuple[OnAir, ...]:
        """Return the other transmissions that are received at the same time as one."""
        return tuple(
            other for other in on_air.overlapping if self._is_in_reach(other.utterance.speaker)
        )

    def open(self, on_air: OnAir) -> None:
        """Begin to stream a transmission, if it is received."""
        if self._receives(on_air):
            self._streams[on_air] = self._audio_of(on_air)
            self._publish(
                TransmissionOpened(
                    t_ns=on_air.t_tx_ns,
                    id=on_air.utterance.id,
                    frequency_khz=on_air.utterance.frequency_khz,
                    t_tx_ns=on_air.t_tx_ns,
                    keyed_by=self._keyed_by(on_air.utterance.speaker),
                ),
                b"",
            )
            self._stream_later(on_air)

    def has_open(self, on_air: OnAir) -> bool:
        """Return whether a transmission is being streamed."""
        return on_air in self._streams

    def close(self, on_air: OnAir) -> bytes | None:
        """End a transmission, and return all of it as PCM; None if it is not received.

        One that could not be received when it began, but can be now, is returned as a whole
        without having been streamed.
        """
        if not self._receives(on_air):
            if on_air in self._streams:
                self._close_stream(on_air, is_complete=False)
            return None
        audio = self._streams.get(on_air) or self._audio_of(on_air)
        rest = []
        if self._backend.has_sound:
            rest = audio.give_rest(self._director.now_ns, self.mixed_with(on_air))
        has_sound = self._backend.has_sound  # It may have been lost just now.
        if on_air in self._streams:
            self._publish_chunks(on_air, rest)
            self._close_stream(on_air, is_complete=has_sound or not audio.samples)
        return audio.pcm if has_sound else b""

    def _receives(self, on_air: OnAir) -> bool:
        said = on_air.utterance
        is_loud = self._receptions.opens_squelch(said, self._listener)
        return is_loud and self._is_in_reach(said.speaker)

    def _is_in_reach(self, speaker: str) -> bool:
        if self._listener is None:
            return self._stations.received(speaker)
        return self._stations.audible(speaker, self._listener)

    def _keyed_by(self, speaker: str) -> str | None:
        """Return the unit that is seen to have keyed: only at the units' site."""
        return self._stations.keyed_by(speaker) if self._listener is None else None

    def _audio_of(self, on_air: OnAir) -> ReceivedAudio:
        background = self._stations.background_of(on_air.utterance.speaker)
        return ReceivedAudio(on_air, self._backend, background, self._listener)

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
                sha256=sha256_of(chunk.pcm),
            )
            self._publish(header, chunk.pcm)

    def _close_stream(self, on_air: OnAir, *, is_complete: bool) -> None:
        audio = self._streams.pop(on_air)
        self._publish(
            TransmissionClosed(
                t_ns=self._director.now_ns,
                id=on_air.utterance.id,
                frequency_khz=on_air.utterance.frequency_khz,
                t_tx_ns=on_air.t_tx_ns,
                t_end_ns=self._director.now_ns,
                samples=audio.samples,
                sha256=sha256_of(audio.pcm),
                snr_db=self._receptions.of(on_air.utterance, self._listener).snr_db,
                is_complete=is_complete,
            ),
            b"",
        )


def sha256_of(pcm: bytes) -> str:
    """Return the SHA-256 of samples; empty if there are none."""
    return hashlib.sha256(pcm).hexdigest() if pcm else ""
