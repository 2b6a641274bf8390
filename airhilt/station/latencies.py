"""The latencies of the stages as the page shows them: a bar from input to result for each step."""

from __future__ import annotations

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


class LatencyBars:
    """Makes bars of messages: stage, begin and end in s, what it is; for a call its end in s too.

    The latency of a call counts from the beginning of its transmission, as in the paper.
    """

    def __init__(self) -> None:
        self._last_ns: dict[str, int] = {}
        self._told: set[tuple[str, int, str]] = set()

    def bar(self, message: Message) -> Json | None:
        """Return the bar of a message, None if it has none of its own."""
        match message:
            case Transcript():
                what = readable(message.engine)
                return self._once("asr", message.t_tx_ns, message.t_ns, what, message.t_end_ns)
            case Detections() if not message.missed:
                what = readable(message.camera)
                return self._seldom("vision", message.t_frame_ns, message.t_ns, what)
            case AdsbReport():
                what = readable(message.callsign or message.icao24)
                return self._seldom("adsb", message.t_adsb_in_ns, message.t_adsb_out_ns, what)
            case Advisory():
                what = f"{message.severity} {readable(message.id)}"
                return self._once("decision", message.t_ready_ns, message.t_ns, what)
            case AdvisoryAudio():
                return self._once("tts", message.t_dec_ns, message.t_ns, readable(message.id))
        return None

    def _once(self, stage: str, begin_ns: int, end_ns: int, what: str, *more: int) -> Json | None:
        """Return a bar, None for the same one to another recipient."""
        if (stage, begin_ns, what) in self._told:
            return None
        self._told.add((stage, begin_ns, what))
        return [stage, _seconds(begin_ns), _seconds(end_ns), what, *map(_seconds, more)]

    def _seldom(self, stage: str, begin_ns: int, end_ns: int, what: str) -> Json | None:
        """Return a bar of what comes often, None too soon after the last one."""
        if end_ns - self._last_ns.get(stage, -LEAST_GAP_NS) < LEAST_GAP_NS:
            return None
        self._last_ns[stage] = end_ns
        return [stage, _seconds(begin_ns), _seconds(end_ns), what]


def _seconds(t_ns: int) -> float:
    return round(t_ns / SECOND_NS, 3)
