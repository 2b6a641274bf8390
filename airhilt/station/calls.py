"""The calls on the radio as the page shows them: said, recognised with confidence, understood."""

from __future__ import annotations

from typing import Any

from airhilt.audio.pcm import SAMPLE_RATE_HZ
from airhilt.host.text import readable
from airhilt.messages import AdvisoryAudio, Transcript
from airhilt.metrics.calls import CallRecord
from airhilt.units import SECOND_NS

Json = dict[str, Any]
MOST_TRANSCRIPTS = 8
"""Number of transcripts of a call that are shown, the newest: each recogniser makes one."""


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
            {"text": readable(word.text), "confidence": word.confidence}
            for word in transcript.words
        ],
    }


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
