"""The receivers of a run: the one at the units' site, and those of seats that have their own."""

from __future__ import annotations

import hashlib
from functools import partial

from airhilt.audio.pcm import SAMPLE_BYTES, SAMPLE_RATE_HZ
from airhilt.messages import (
    SeatAudioChunk,
    SeatAudioClosed,
    SeatAudioOpened,
    TransmissionChunk,
    TransmissionClosed,
    TransmissionOpened,
    key_chunk,
)
from airhilt.sensors.radio.backends import SoundRequest
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.on_air import OnAir
from airhilt.sim import Priority
from airhilt.units import SECOND_NS

CHUNK_NS = SECOND_NS // 2
"""Period in ns at which the audio of a transmission is published while it lasts."""
CHUNK_SAMPLES = SAMPLE_RATE_HZ // 2
"""Most samples in a chunk: 0.5 s."""

AudioHeader = TransmissionOpened | TransmissionChunk | TransmissionClosed
AT_SEAT: dict[type[AudioHeader], type[SeatAudioOpened | SeatAudioChunk | SeatAudioClosed]] = {
    TransmissionOpened: SeatAudioOpened,
    TransmissionChunk: SeatAudioChunk,
    TransmissionClosed: SeatAudioClosed,
}
"""Messages of the receiver of a seat, by those of the one at the units' site."""


class RadioReceiver:
    """Streams what one receiver gets: a call opens, comes in chunks while it lasts, and closes.

    It is the receiver of the units' site, or that of a seat on the frequencies of the seat.
    """

    def __init__(self, context: RadioContext, seat: str | None = None) -> None:
        self._context = context
        self._seat = seat
        self._streams: dict[OnAir, _ReceivedAudio] = {}
        """Audio of the transmissions that are being streamed."""

    def mixed_with(self, on_air: OnAir) -> tuple[OnAir, ...]:
        """Return the other transmissions that are received at the same time as one."""
        return tuple(
            other for other in on_air.overlapping if self._is_in_reach(other.utterance.speaker)
        )

    def open(self, on_air: OnAir) -> None:
        """Begin to stream a transmission, if it is received."""
        said, seat, stations = on_air.utterance, self._seat, self._context.stations
        is_tuned = seat is None or said.frequency_khz in stations.selectable(seat)
        if is_tuned and self._receives(on_air):
            self._streams[on_air] = _ReceivedAudio(on_air, self._context, seat)
            opened = TransmissionOpened(
                t_ns=on_air.t_tx_ns,
                id=said.id,
                frequency_khz=said.frequency_khz,
                t_tx_ns=on_air.t_tx_ns,
                keyed_by=stations.keyed_by(said.speaker) if seat is None else None,
            )
            self._publish(opened)
            self._stream_later(on_air)

    def close(self, on_air: OnAir) -> bytes | None:
        """End a transmission, and return all of it as PCM; None if it is not received.

        One that could not be received when it began, but can be now, is returned as a whole
        without having been streamed; a seat gets nothing of it.
        """
        if self._seat is not None and on_air not in self._streams:
            return None
        if not self._receives(on_air):
            if on_air in self._streams:
                self._close_stream(on_air, is_complete=False)
            return None
        backend = self._context.backend
        audio = self._streams.get(on_air) or _ReceivedAudio(on_air, self._context, self._seat)
        rest = []
        if backend.has_sound:
            rest = audio.give_rest(self._context.director.now_ns, self.mixed_with(on_air))
        has_sound = backend.has_sound  # It may have been lost just now.
        if on_air in self._streams:
            for header, pcm in rest:
                self._publish(header, pcm)
            self._close_stream(on_air, is_complete=has_sound or not audio.samples)
        return audio.pcm if has_sound else b""

    def _receives(self, on_air: OnAir) -> bool:
        said = on_air.utterance
        is_loud = self._context.receptions.opens_squelch(said, self._seat)
        return is_loud and self._is_in_reach(said.speaker)

    def _is_in_reach(self, speaker: str) -> bool:
        return self._context.stations.audible(speaker, self._seat or "")

    def _stream_later(self, on_air: OnAir) -> None:
        director = self._context.director
        director.at(director.now_ns + CHUNK_NS, partial(self._stream, on_air), Priority.SENSOR)

    def _stream(self, on_air: OnAir) -> None:
        """Publish what has been on the air since the last chunk."""
        audio = self._streams.get(on_air)
        if audio is None or not self._context.backend.has_sound:
            return
        if not self._receives(on_air):
            self._close_stream(on_air, is_complete=False)
            return
        now_ns = self._context.director.now_ns
        for header, pcm in audio.give_until(now_ns, self.mixed_with(on_air)):
            self._publish(header, pcm)
        self._stream_later(on_air)

    def _close_stream(self, on_air: OnAir, *, is_complete: bool) -> None:
        audio, now_ns = self._streams.pop(on_air), self._context.director.now_ns
        closed = TransmissionClosed(
            t_ns=now_ns,
            id=on_air.utterance.id,
            frequency_khz=on_air.utterance.frequency_khz,
            t_tx_ns=on_air.t_tx_ns,
            t_end_ns=now_ns,
            samples=audio.samples,
            sha256=sha256_of(audio.pcm),
            snr_db=self._context.receptions.of(on_air.utterance, self._seat).snr_db,
            is_complete=is_complete,
        )
        self._publish(closed)

    def _publish(self, header: AudioHeader, pcm: bytes = b"") -> None:
        publish = self._context.publish
        if self._seat is None:
            publish(f"radio/{header.frequency_khz}/audio", header, raw=pcm)
        else:
            message = AT_SEAT[type(header)](seat=self._seat, **dict(header))
            publish(f"seat/{key_chunk(self._seat)}/audio", message, raw=pcm)


class _ReceivedAudio:
    """Samples of one transmission, as a receiver gives them out.

    Samples that have been given out stay as they are. Those after them are received anew
    whenever more becomes known: another transmission begins, or a person goes on speaking.
    """

    def __init__(self, on_air: OnAir, context: RadioContext, seat: str | None) -> None:
        self._on_air = on_air
        self._context = context
        self._seat = seat
        self._given = bytearray()
        self._chunks = 0
        self._ahead = b""
        """PCM that has been received and not given out yet."""
        self._ahead_of: object = None
        """State of knowledge when it was received, for comparison."""

    @property
    def pcm(self) -> bytes:
        """All samples that have been given out, as PCM."""
        return bytes(self._given)

    @property
    def samples(self) -> int:
        """Number of samples that have been given out."""
        return len(self._given) // SAMPLE_BYTES

    def give_until(
        self, now_ns: int, mixed_with: tuple[OnAir, ...]
    ) -> list[tuple[TransmissionChunk, bytes]]:
        """Give out the samples that have been on the air by now and were not given out yet."""
        on_the_air = (now_ns - self._on_air.t_tx_ns) * SAMPLE_RATE_HZ // SECOND_NS
        self._look_ahead(now_ns, mixed_with)
        return self._give((on_the_air - self.samples) * SAMPLE_BYTES, now_ns)

    def give_rest(
        self, now_ns: int, mixed_with: tuple[OnAir, ...]
    ) -> list[tuple[TransmissionChunk, bytes]]:
        """Give out all other samples of a transmission that has ended."""
        self._look_ahead(now_ns, mixed_with)
        return self._give(len(self._ahead), now_ns)

    def _look_ahead(self, now_ns: int, mixed_with: tuple[OnAir, ...]) -> None:
        """Receive the samples that come next, if more is known than when that was done last."""
        on_air, context = self._on_air, self._context
        is_over = not on_air.is_open_ended or on_air.has_ended(now_ns)
        others = [(other, other.end_ns or other.known_until_ns(now_ns)) for other in mixed_with]
        known = (is_over, on_air.known_until_ns(now_ns), others)
        if known != self._ahead_of:
            background = context.stations.background_of(on_air.utterance.speaker)
            request = SoundRequest(on_air, mixed_with, background, self.samples, now_ns, self._seat)
            self._ahead = context.backend.receive(request)
            self._ahead_of = known

    def _give(self, size: int, now_ns: int) -> list[tuple[TransmissionChunk, bytes]]:
        """Give out that many bytes, or as many as there are."""
        given, self._ahead = self._ahead[:size], self._ahead[size:]
        chunks = []
        for begin in range(0, len(given), CHUNK_SAMPLES * SAMPLE_BYTES):
            pcm = given[begin : begin + CHUNK_SAMPLES * SAMPLE_BYTES]
            header = TransmissionChunk(
                t_ns=now_ns,
                id=self._on_air.utterance.id,
                frequency_khz=self._on_air.utterance.frequency_khz,
                seq=self._chunks,
                first_sample=self.samples,
                samples=len(pcm) // SAMPLE_BYTES,
                sha256=sha256_of(pcm),
            )
            chunks.append((header, pcm))
            self._chunks += 1
            self._given += pcm
        return chunks


def sha256_of(pcm: bytes) -> str:
    """Return the SHA-256 of samples; empty if there are none."""
    return hashlib.sha256(pcm).hexdigest() if pcm else ""
