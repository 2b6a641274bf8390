"""Parts of the time to first warning, and their means over many runs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from airhilt.messages import Advisory, Transcript
from airhilt.metrics.calls import CallRecord
from airhilt.metrics.summary import Summary, WarningParts
from airhilt.units import SECOND_NS

RADIO = "radio"
"""Source of evidence that names the radio."""


def supporting_transcript(
    advisory: Advisory, beginning: str | None, call: Callable[[str], CallRecord | None]
) -> Transcript | None:
    """Return the transcript that completed what an advisory knows from the radio.

    The transcript is the last one, up to t_ready, of the calls that its evidence names. If the
    advisory rests on the radio and names none, it is that of the call that begins the conflict.

    Parameters
    ----------
    beginning
        Id of the call that begins the conflict, None if none does.
    call
        Returns what is known of a call by its id.
    """
    names: tuple[str, ...] = advisory.evidence.radio_ids
    if not names and beginning is not None and RADIO in advisory.evidence.sources:
        names = (beginning,)
    known = [record for name in names if (record := call(name)) is not None]
    ready = [
        transcript
        for record in known
        for transcript in record.transcripts
        if transcript.t_ns <= advisory.t_ready_ns
    ]
    return max(ready, key=lambda transcript: transcript.t_ns, default=None)


def parts_of(
    begun_ns: int, warned_ns: int, advisory: Advisory, transcript: Transcript | None
) -> WarningParts:
    """Return the parts of the time from the begin of a conflict to the first warning.

    Parameters
    ----------
    transcript
        The transcript that the warning rests on, None if it rests on no call.
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


class WarningStatistics(BaseModel):
    """The time to first warning over some runs, in s; null if nobody was warned in any."""

    model_config = ConfigDict(frozen=True)
    runs: int
    warned: int = Field(description="runs with a warning of the conflict")
    mean_s: float | None
    median_s: float | None
    share_before: float | None = Field(
        description="share of the warnings that came before the conflict began: those below 0, "
        "and those of a conflict that then never began"
    )
    mean_after_call_s: float | None = Field(
        description="mean from the end of the call that begins the conflict, where one does"
    )
    parts: WarningParts | None = Field(description="mean of each part")

    @classmethod
    def of(cls, summaries: Sequence[Summary]) -> WarningStatistics:
        """Return the statistics of runs; a run that nobody was warned in counts in `runs` only.

        A warning of a conflict that then never began has no time: it counts in `warned` and in
        `share_before`.
        """
        warned = [summary for summary in summaries if summary.t_first_warning_s is not None]
        times = _known(summary.time_to_first_warning_s for summary in summaries)
        parts = [one for summary in summaries if (one := summary.first_warning_parts) is not None]
        return cls(
            runs=len(summaries),
            warned=len(warned),
            mean_s=_mean(times),
            median_s=float(np.median(times)) if times else None,
            share_before=_mean(
                [
                    summary.time_to_first_warning_s is None or summary.time_to_first_warning_s < 0.0
                    for summary in warned
                ]
            ),
            mean_after_call_s=_mean(
                _known(summary.time_to_first_warning_after_call_s for summary in summaries)
            ),
            parts=_mean_parts(parts),
        )


def _known(values: Iterable[float | None]) -> list[float]:
    return [value for value in values if value is not None]


def _mean(values: Sequence[float]) -> float | None:
    return float(np.mean(values)) if values else None


def _mean_parts(parts: Sequence[WarningParts]) -> WarningParts | None:
    if not parts:
        return None
    return WarningParts(
        **{
            name: float(np.mean([getattr(one, name) for one in parts]))
            for name in WarningParts.model_fields
        }
    )
