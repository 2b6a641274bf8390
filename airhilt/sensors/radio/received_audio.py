"""The samples of one transmission, given out while it lasts."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from airhilt.audio.pcm import SAMPLE_BYTES, SAMPLE_RATE_HZ
from airhilt.sensors.radio.backends import RadioBackend
from airhilt.sensors.radio.on_air import OnAir
from airhilt.units import SECOND_NS

if TYPE_CHECKING:
    from airhilt.sensors.radio.channel import BackgroundNoise

CHUNK_SAMPLES = SAMPLE_RATE_HZ // 2
"""Most samples in a chunk: 0.5 s."""


class Chunk(NamedTuple):
    """Some consecutive samples of a transmission."""

    seq: int
    first_sample: int
    pcm: bytes


class ReceivedAudio:
    """Samples of one transmission, as the receiver gives them out.

    Samples that have been given out stay as they are. Those after them are received anew
    whenever more becomes known: another transmission begins, or a person goes on speaking.
    """

    def __init__(
        self,
        on_air: OnAir,
        backend: RadioBackend,
        background: BackgroundNoise,
        listener: str | None,
    ) -> None:
        self._on_air = on_air
        self._backend = backend
        self._background = background
        self._listener = listener
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

    def give_until(self, now_ns: int, mixed_with: tuple[OnAir, ...]) -> list[Chunk]:
        """Give out the samples that have been on the air by now and were not given out yet."""
        on_the_air = (now_ns - self._on_air.t_tx_ns) * SAMPLE_RATE_HZ // SECOND_NS
        self._look_ahead(now_ns, mixed_with)
        return self._give((on_the_air - self.samples) * SAMPLE_BYTES)

    def give_rest(self, now_ns: int, mixed_with: tuple[OnAir, ...]) -> list[Chunk]:
        """Give out all other samples of a transmission that has ended."""
        self._look_ahead(now_ns, mixed_with)
        return self._give(len(self._ahead))

    def _look_ahead(self, now_ns: int, mixed_with: tuple[OnAir, ...]) -> None:
        """Receive the samples that come next, if more is known than when that was done last."""
        on_air = self._on_air
        is_over = not on_air.is_open_ended or on_air.has_ended(now_ns)
        others = [(other, other.end_ns or other.known_until_ns(now_ns)) for other in mixed_with]
        known = (is_over, on_air.known_until_ns(now_ns), others)
        if known != self._ahead_of:
            self._ahead = self._backend.receive(
                on_air, mixed_with, self._background, self.samples, now_ns, self._listener
            )
            self._ahead_of = known

    def _give(self, size: int) -> list[Chunk]:
        """Give out that many bytes, or as many as there are."""
        given, self._ahead = self._ahead[:size], self._ahead[size:]
        chunks = []
        for begin in range(0, len(given), CHUNK_SAMPLES * SAMPLE_BYTES):
            pcm = given[begin : begin + CHUNK_SAMPLES * SAMPLE_BYTES]
            chunks.append(Chunk(self._chunks, self.samples, pcm))
            self._chunks += 1
            self._given += pcm
        return chunks
