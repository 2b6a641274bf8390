"""Parts of the time to first warning."""

from __future__ import annotations

from collections.abc import Callable

from airhilt.messages import Advisory, Transcript
from airhilt.metrics.calls import CallRecord
from airhilt.metrics.summary import WarningParts
from airhilt.units import SECOND_NS


def supporting_transcript(
    advisory: Advisory, beginning: str | None, call: Callable[[str], CallRecord | None]
) -> Transcript | None:
    """Return the transcript that completed what an advisory knows from the radio.

    The transcript is the last one, up to t_ready, of the calls that its evidence names. If the
    advisory rests on the radio and names none, it is that of the call that begins the conflict.
    """
    names: tuple[str, ...] = advisory.evidence.radio_ids
    if not names and beginning is not None and "radio" in advisory.evidence.sources:
        names = (beginning,)
    ready = [
        transcript
        for name in names
        if (record := call(name)) is not None
        for transcript in record.transcripts
        if transcript.t_ns <= advisory.t_ready_ns
    ]
    return max(ready, key=lambda transcript: transcript.t_ns, default=None)


def parts_of(
    begun_ns: int, warned_ns: int, advisory: Advisory, transcript: Transcript | None
) -> WarningParts:
    """Return the parts of the time from the begin of a conflict to the first warning.

    Without a transcript the warning rests on no call.
    """
    speech_ns = recognition_ns = 0
    if transcript is not None:
        said_ns = min(transcript.t_end_ns, transcript.t_ns)
        span = (begun_ns, advisory.t_ready_ns)
        speech_ns = _overlap_ns((transcript.t_tx_ns, said_ns), span)
        recognition_ns = _overlap_ns((said_ns, transcript.t_ns), span)
    evidence_ns = advisory.t_ready_ns - begun_ns - speech_ns - recognition_ns
    return WarningParts(
        speech_s=speech_ns / SECOND_NS,
        recognition_s=recognition_ns / SECOND_NS,
        evidence_s=evidence_ns / SECOND_NS,
        decision_s=(advisory.t_ns - advisory.t_ready_ns) / SECOND_NS,
        voice_s=(warned_ns - advisory.t_ns) / SECOND_NS,
    )


def _overlap_ns(one: tuple[int, int], other: tuple[int, int]) -> int:
    return max(min(one[1], other[1]) - max(one[0], other[0]), 0)
