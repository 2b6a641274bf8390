"""The protocol of speech recognisers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol, runtime_checkable

from airhilt.audio.pcm import Audio


@dataclass(frozen=True, slots=True)
class Recognised:
    """The words of one transmission."""

    text: str
    """The words; empty when nothing was said."""
    words: tuple[tuple[str, float], ...]
    """The words of `text` one by one with their confidences; empty if the engine has none."""
    confidence: float
    """Confidence in the whole, in [0, 1]; where it is empty, that nothing was said."""


@runtime_checkable
class AsrEngine(Protocol):
    """Turns the audio of one transmission into words."""

    @property
    def name(self) -> str:
        """Short name, in transcripts and tables."""

    def recognise(self, audio: Audio, callsigns: Sequence[str]) -> Recognised:
        """Return what was said.

        Parameters
        ----------
        audio
            One transmission, 16 kHz.
        callsigns
            Callsigns of the roster, which may be on the frequency.

        Raises
        ------
        airhilt.errors.SpeechError
            The engine has failed.
        """


class Call(NamedTuple):
    """A transmission as a receiver knows it besides its sound."""

    id: str
    frequency_khz: int
    t_tx_ns: int
    """Start of the transmission."""
    speaker: str | None
    """Unit whose transmitter was keyed; None: it came over the air."""
    callsigns: tuple[str, ...]
    """Callsigns of the roster."""


@runtime_checkable
class RecognisesCalls(Protocol):
    """Part that a recogniser may have besides: it is told which call it hears."""

    def recognise_call(self, audio: Audio, call: Call) -> Recognised:
        """Return what was said; it raises what `AsrEngine.recognise` does."""


def recognised(engine: AsrEngine, audio: Audio, call: Call) -> Recognised:
    """Return what an engine makes of a call."""
    if isinstance(engine, RecognisesCalls):
        return engine.recognise_call(audio, call)
    return engine.recognise(audio, call.callsigns)
