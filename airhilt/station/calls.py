"""The calls on the radio as the page shows them: said, recognised with confidence, understood."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from airhilt.audio.pcm import SAMPLE_RATE_HZ
from airhilt.host.text import readable
from airhilt.messages import AdvisoryAudio, Transcript, Word
from airhilt.metrics.calls import CallRecord, CallRecords
from airhilt.record import Logged, RunFolder
from airhilt.report.sections import Content
from airhilt.units import SECOND_NS

if TYPE_CHECKING:
    from airhilt.report.data import RunData

Json = dict[str, Any]
KEYS = ("radio/", "asr/", "tts/", "truth/radio/", "truth/hearing/")
"""Beginnings of the keys of the messages about calls."""
MOST_TRANSCRIPTS = 8
"""Number of transcripts of a call that are shown, the newest: each recogniser makes one."""
MOST_LETTERS = 1_500
"""Number of characters of the words of a transcript that are shown: a minute of quick speech."""


class Calls(Content):
    """The calls of a run, and the advisories that the assistant spoke."""

    def __init__(self, folder: RunFolder) -> None:
        super().__init__(folder)
        self._calls = CallRecords()

    @property
    def frequencies_khz(self) -> tuple[int, ...]:
        """Frequencies on which something was heard."""
        received = (call.received for call in self._calls)
        return tuple(sorted({one.frequency_khz for one in received if one and one.samples}))

    @property
    def spoken(self) -> tuple[AdvisoryAudio, ...]:
        """The advisories that were spoken, in the order of their beginnings."""
        return tuple(self._calls.spoken)

    def take(self, logged: Logged) -> None:
        """Receive a message about a call, or the audio of an advisory."""
        self._calls.read(logged.key, logged.data)

    def as_json(self, run: RunData) -> Json:  # noqa: ARG002
        """Return calls and spoken advisories, each in the order in which they began."""
        calls = [call_as_json(call) for call in self._calls]
        return {
            "calls": sorted(
                (call for call in calls if call is not None), key=lambda call: call["from"]
            ),
            "spoken": [spoken_as_json(audio) for audio in self._calls.spoken],
        }


def call_as_json(call: CallRecord, *, names_engines: bool = True) -> Json | None:
    """Return a call, None if only its recognition is known.

    The engine of a transcript is null unless engines are named.
    What was really said, and by whom, is null where the truth is not known.
    """
    on_air = call.said or call.received
    if on_air is None:
        return None
    said = call.said
    return {
        "id": readable(on_air.id),
        "from": round(on_air.t_tx_ns / SECOND_NS, 3),
        "to": round(on_air.t_end_ns / SECOND_NS, 3),
        "frequency_khz": on_air.frequency_khz,
        "snr_db": on_air.snr_db,
        "speaker": None if said is None else readable(said.speaker),
        "addressed": None if said is None or said.addressed is None else readable(said.addressed),
        "said": None if said is None else readable(said.text),
        "blocked_by": [] if said is None else [readable(name) for name in said.blocked_by],
        "transcripts": [
            _transcript(one, names_engine=names_engines)
            for one in call.transcripts[-MOST_TRANSCRIPTS:]
        ],
        "hearings": [
            {"who": readable(one.actor), "outcome": one.outcome, "text": readable(one.text)}
            for one in call.hearings
        ],
    }


def _transcript(transcript: Transcript, *, names_engine: bool) -> Json:
    return {
        "t": round(transcript.t_ns / SECOND_NS, 3),
        "engine": readable(transcript.engine) if names_engine else None,
        "speaker": None if transcript.speaker is None else readable(transcript.speaker),
        "addressee": None if transcript.addressee is None else readable(transcript.addressee),
        "confidence": transcript.confidence,
        "text": readable(transcript.text),
        "words": [
            {"text": text, "confidence": word.confidence} for word, text in _first_words(transcript)
        ],
    }


def _first_words(transcript: Transcript) -> Iterator[tuple[Word, str]]:
    """Yield the words of a transcript for which there is room, each with its text as shown."""
    letters = 0
    for word in transcript.words:
        text = readable(word.text)
        letters += len(text) + 1
        if letters > MOST_LETTERS:
            return
        yield word, text


def spoken_as_json(audio: AdvisoryAudio) -> Json:
    """Return an advisory that the assistant speaks."""
    return {
        "id": readable(audio.id),
        "revision": audio.revision,
        "recipient": readable(audio.recipient),
        "from": round(audio.t_ns / SECOND_NS, 3),
        "to": round(audio.t_ns / SECOND_NS + audio.samples / SAMPLE_RATE_HZ, 3),
        "text": readable(audio.text),
    }
