"""The latencies of the stages as the page shows them: a bar from input to result for each step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from airhilt.messages import AdsbReport, Advisory, AdvisoryAudio, Detections, Transcript
from airhilt.record import Logged, RunFolder
from airhilt.report.sections import Content
from airhilt.text import readable
from airhilt.units import SECOND_NS

if TYPE_CHECKING:
    from airhilt.report.data import RunData

Json = list[Any]
KEYS = ("asr/", "vision/", "adsb/", "advisory/", "tts/")
"""Beginnings of the keys of the messages that have latencies."""
LEAST_GAP_NS = SECOND_NS // 2
"""Least time between two bars of what comes often, in ns."""
OFTEN = ("vision", "adsb")
"""Stages of which not every step has a bar."""


def _of_call(data: bytes) -> Json:
    call = Transcript.model_validate_json(data)
    return [call.t_tx_ns, call.t_ns, readable(call.engine), call.t_end_ns]


def _of_picture(data: bytes) -> Json | None:
    seen = Detections.model_validate_json(data)
    return None if seen.missed else [seen.t_frame_ns, seen.t_ns, readable(seen.camera)]


def _of_report(data: bytes) -> Json:
    report = AdsbReport.model_validate_json(data)
    return [report.t_adsb_in_ns, report.t_adsb_out_ns, readable(report.callsign or report.icao24)]


def _of_advisory(data: bytes) -> Json:
    advisory = Advisory.model_validate_json(data)
    return [advisory.t_ready_ns, advisory.t_ns, f"{advisory.severity} {readable(advisory.id)}"]


def _of_voice(data: bytes) -> Json:
    audio = AdvisoryAudio.model_validate_json(data)
    return [audio.t_dec_ns, audio.t_ns, readable(audio.id)]


STAGES: Mapping[str, tuple[str, Callable[[bytes], Json | None]]] = {
    "asr": ("asr", _of_call),
    "vision": ("vision", _of_picture),
    "adsb": ("adsb", _of_report),
    "advisory": ("decision", _of_advisory),
    "tts": ("tts", _of_voice),
}
"""Stage and bar of a message, by the first part of its key."""


class LatencyBars:
    """Makes bars of messages: stage, begin and end in s, what it is; for a call its end in s too.

    The latency of a call counts from the beginning of its transmission, as in the paper.
    """

    def __init__(self) -> None:
        self._last_ns: dict[str, int] = {}
        self._told: set[tuple[str, int, str]] = set()

    def bar(self, logged: Logged) -> Json | None:
        """Return the bar of a message, None if it has none of its own."""
        family, _, rest = logged.key.partition("/")
        if family not in STAGES or "/" in rest:
            return None
        stage, make = STAGES[family]
        if stage in OFTEN:
            if logged.t_ns - self._last_ns.get(stage, -LEAST_GAP_NS) < LEAST_GAP_NS:
                return None
            self._last_ns[stage] = logged.t_ns
        found = make(logged.data)
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


class Latencies(Content):
    """The bars of a recorded run."""

    def __init__(self, folder: RunFolder) -> None:
        super().__init__(folder)
        self._bars = LatencyBars()
        self._found: list[Json] = []

    def take(self, logged: Logged) -> None:
        """Receive a message."""
        if (bar := self._bars.bar(logged)) is not None:
            self._found.append(bar)

    def as_json(self, run: RunData) -> list[Json]:  # noqa: ARG002
        """Return the bars in the order of their ends."""
        return self._found
