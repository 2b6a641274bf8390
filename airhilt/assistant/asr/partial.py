"""Partial transcripts: the words of a call so far, while it lasts.

All audio up to the newest chunk is recognised anew. A word of the last half second may change with
what follows. Words are stable if the recognition before, of 0.5 s less audio, had the same ones
(local agreement of two hypotheses: Liu, Spanakis and Niehues, Interspeech 2020).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import takewhile

from airhilt.assistant.asr.engine import AsrEngine, Call, recognised
from airhilt.audio.pcm import SAMPLE_BYTES, SAMPLE_RATE_HZ, from_pcm
from airhilt.messages import (
    PartialTranscript,
    TransmissionChunk,
    TransmissionClosed,
    TransmissionOpened,
    Word,
)
from airhilt.sim.worker import Input
from airhilt.units import SECOND_NS


@dataclass(slots=True)
class _OnAir:
    """A transmission that goes on, as far as it was received."""

    opened: TransmissionOpened
    pcm: bytearray = field(default_factory=bytearray)
    is_news: bool = False
    """True if samples have come since its last partial transcript."""
    words: tuple[str, ...] = ()
    """Words of its last partial transcript."""


class PartialRecogniser:
    """Recognises the transmissions that are on the air, each as far as it was received."""

    def __init__(self, engine: AsrEngine) -> None:
        self._engine = engine
        self._on_air: dict[str, _OnAir] = {}

    def take(self, item: Input) -> None:
        """Add what has come of a transmission; forget one that has ended."""
        attachment = item.attachment or {}
        match attachment.get("phase"):
            case "opened":
                opened = TransmissionOpened.model_validate(attachment)
                self._on_air[opened.id] = _OnAir(opened)
            case "chunk":
                chunk = TransmissionChunk.model_validate(attachment)
                if (on_air := self._on_air.get(chunk.id)) is not None:
                    on_air.pcm += item.payload
                    on_air.is_news = True
            case "closed":
                self._on_air.pop(TransmissionClosed.model_validate(attachment).id, None)

    def partials(self, callsigns: Sequence[str]) -> Iterator[PartialTranscript]:
        """Yield a partial transcript of each transmission of which more has come."""
        for on_air in self._on_air.values():
            if on_air.is_news:
                on_air.is_news = False
                yield self._partial(on_air, callsigns)

    def _partial(self, on_air: _OnAir, callsigns: Sequence[str]) -> PartialTranscript:
        opened = on_air.opened
        call = Call(
            opened.id, opened.frequency_khz, opened.t_tx_ns, opened.keyed_by, tuple(callsigns)
        )
        heard = recognised(self._engine, from_pcm(bytes(on_air.pcm)), call)
        words, before = tuple(heard.text.split()), on_air.words
        on_air.words = words
        samples = len(on_air.pcm) // SAMPLE_BYTES
        return PartialTranscript(
            id=opened.id,
            frequency_khz=opened.frequency_khz,
            t_tx_ns=opened.t_tx_ns,
            t_heard_ns=opened.t_tx_ns + samples * SECOND_NS // SAMPLE_RATE_HZ,
            text=heard.text,
            words=tuple(Word(text=text, confidence=trust) for text, trust in heard.words),
            confidence=heard.confidence,
            stable_words=_agreed(before, words),
            engine=self._engine.name,
        )


def _agreed(before: Sequence[str], now: Sequence[str]) -> int:
    """Return the number of words at the beginning that two recognitions share."""
    return sum(
        1 for _ in takewhile(lambda both: both[0] == both[1], zip(before, now, strict=False))
    )
