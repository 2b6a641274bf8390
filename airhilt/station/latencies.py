"""The latencies of the stages as the page shows them: a bar from input to result for each step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from airhilt.host.text import readable
from airhilt.messages import (
    AdsbReport,
    Advisory,
    AdvisoryAudio,
    Detections,
    Message,
    Transcript,
)
from airhilt.units import SECOND_NS

Json = list[Any]
LEAST_GAP_NS = SECOND_NS // 2
"""Least time between two bars of what comes often, in ns."""
OFTEN = ("vision", "adsb")
"""Stages of which not every step has a bar."""


def _of_call(call: Transcript) -> Json:
    return [call.t_tx_ns, call.t_ns, readable(call.engine), call.t_end_ns]


def _of_picture(seen: Detections) -> Json | None:
    return None if seen.missed else [seen.t_frame_ns, seen.t_ns, readable(seen.camera)]


def _of_report(report: AdsbReport) -> Json:
    return [report.t_adsb_in_ns, report.t_adsb_out_ns, readable(report.callsign or report.icao24)]


def _of_advisory(advisory: Advisory) -> Json:
    return [advisory.t_ready_ns, advisory.t_ns, f"{advisory.severity} {readable(advisory.id)}"]


def _of_voice(audio: AdvisoryAudio) -> Json:
    return [audio.t_dec_ns, audio.t_ns, readable(audio.id)]


STAGES: Mapping[type[Message], tuple[str, Callable[[Any], Json | None]]] = {
    Transcript: ("asr", _of_call),
    Detections: ("vision", _of_picture),
    AdsbReport: ("adsb", _of_report),
    Advisory: ("decision", _of_advisory),
    AdvisoryAudio: ("tts", _of_voice),
}
"""Stage and bar of a message, by its class."""


class LatencyBars:
    """Makes bars of messages: stage, begin and end in s, what it is; for a call its end in s too.

    The latency of a call counts from the beginning of its transmission, as in the paper.
    """

    def __init__(self) -> None:
        self._last_ns: dict[str, int] = {}
        self._told: set[tuple[str, int, str]] = set()

    def bar(self, message: Message) -> Json | None:
        """Return the bar of a message, None if it has none of its own."""
        if type(message) not in STAGES:
            return None
        stage, make = STAGES[type(message)]
        if stage in OFTEN:
            if message.t_ns - self._last_ns.get(stage, -LEAST_GAP_NS) < LEAST_GAP_NS:
                return None
            self._last_ns[stage] = message.t_ns
        found = make(message)
        if found is None:
            return None
        begin_ns, end_ns, what, *more = found
        if (stage, begin_ns, what) in self._told:
            return None  # The same for another recipient.
        if stage not in OFTEN:
            self._told.add((stage, begin_ns, what))
        times = (begin_ns, end_ns, *more)
        begin_s, end_s, *others = (round(t_ns / SECOND_NS, 3) for t_ns in times)
        return [stage, begin_s, end_s, what, *others]
