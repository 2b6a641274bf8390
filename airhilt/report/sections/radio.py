"""The radio: each call as it was said, recognised, understood and heard."""

from __future__ import annotations

from typing import Any

from airhilt.audio.pcm import SAMPLE_RATE_HZ
from airhilt.host.text import readable
from airhilt.messages import AdvisoryAudio, SpokenTruth, Transcript
from airhilt.metrics.calls import CallRecord, CallRecords
from airhilt.metrics.words import align
from airhilt.record import Logged, RunFolder
from airhilt.report.data import RunData
from airhilt.report.sections import Content, Section
from airhilt.report.sounds import Sounds
from airhilt.units import SECOND_NS

Json = dict[str, Any]

MOST_CALLS = 500
"""Largest number of calls in the page, and of spoken advisories."""


class Radio(Content):
    """The calls of a run, and the advisories that the assistant spoke."""

    def __init__(self, folder: RunFolder) -> None:
        super().__init__(folder)
        self._calls = CallRecords()

    def take(self, logged: Logged) -> None:
        """Receive a message about a call, or the audio of an advisory."""
        self._calls.read(logged.key, logged.data)

    def as_json(self, run: RunData) -> Json:
        """Return calls and spoken advisories, each in the order in which they began."""
        sounds, spoken = Sounds(run), self._calls.spoken
        calls = [(call, said) for call in self._calls if (said := call.said) is not None]
        calls.sort(key=lambda call: (call[1].t_tx_ns, call[1].id))
        radio = {
            "calls": [_call(call, said, sounds) for call, said in calls[:MOST_CALLS]],
            "advisories": [_advisory(audio, sounds) for audio in spoken[:MOST_CALLS]],
        }
        left_out = sum(max(len(all_) - MOST_CALLS, 0) for all_ in (calls, spoken))
        if left_out:
            run.notes.append(
                f"The radio shows the first {MOST_CALLS} calls and spoken advisories; {left_out} "
                "later ones are in log.mcap only."
            )
        run.notes.extend(sounds.notes())
        return radio


def _call(call: CallRecord, said: SpokenTruth, sounds: Sounds) -> Json:
    return {
        "id": readable(said.id),
        "from": round(said.t_tx_ns / SECOND_NS, 3),
        "to": round(said.t_end_ns / SECOND_NS, 3),
        "frequency_khz": said.frequency_khz,
        "who": readable(said.speaker),
        "addressed": None if said.addressed is None else readable(said.addressed),
        "said": readable(said.text),
        "blocked_by": [readable(name) for name in said.blocked_by],
        "snr_db": said.snr_db,
        "received": call.received is not None,
        "transcripts": [_transcript(transcript, said) for transcript in call.recognised],
        "hearings": [
            {"who": readable(one.actor), "outcome": one.outcome, "text": readable(one.text)}
            for one in call.hearings
        ],
        "sound": None if call.received is None else sounds.of(call.received),
    }


def _transcript(transcript: Transcript, said: SpokenTruth) -> Json:
    return {
        "engine": readable(transcript.engine),
        "confidence": transcript.confidence,
        "after_end_s": (transcript.t_ns - said.t_end_ns) / SECOND_NS,
        "words": [
            {"kind": one.kind, "said": " ".join(one.said), "heard": " ".join(one.heard)}
            for one in align(readable(said.text), readable(transcript.text))
        ],
    }


def _advisory(audio: AdvisoryAudio, sounds: Sounds) -> Json:
    return {
        "id": readable(audio.id),
        "revision": audio.revision,
        "from": round(audio.t_ns / SECOND_NS, 3),
        "to": round(audio.t_ns / SECOND_NS + audio.samples / SAMPLE_RATE_HZ, 3),
        "recipient": readable(audio.recipient),
        "said": readable(audio.text),
        "engine": readable(audio.engine),
        "after_decision_s": (audio.t_ns - audio.t_dec_ns) / SECOND_NS,
        "sound": sounds.of(audio),
    }


SECTION = Section(
    "radio",
    order=40,
    module=__file__,
    content=Radio,
    keys=("radio/", "asr/", "tts/", "truth/radio/", "truth/hearing/"),
)
