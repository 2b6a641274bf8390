"""Input that cannot be right: what of it is believed, and what alerts say of it.

Nothing here ends a run. What is not believed is left out, and each alert that rests on the same
aircraft or the same modality says so in its evidence for a while.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from airhilt.assistant.decision.adsb_consistency import AdsbConsistency
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.call_order import CallOrder
from airhilt.messages import AdsbReport, CameraInfo, Detections, Transcript
from airhilt.units import SECOND_NS

TOLD_NS = 60 * SECOND_NS
"""Time for which alerts tell of something that was wrong, in ns."""


class InputChecks:
    """Checks what arrives at an engine, and marks alerts with what was wrong."""

    def __init__(self) -> None:
        self._adsb = AdsbConsistency()
        self._calls = CallOrder()
        self._cameras: set[str] = set()
        self._frames: dict[str, int] = {}
        """Time of the last picture of each camera, in ns."""
        self._wrong: dict[tuple[str, str], int] = {}
        """Time at which something was last wrong, by its subject and by what it is."""

    def take_camera(self, info: CameraInfo) -> None:
        """Note that there is a camera."""
        self._cameras.add(info.camera)

    def believes_report(self, report: AdsbReport, t_ns: int) -> bool:
        """Return whether a report can be of the aircraft that its address is known of."""
        names = self._adsb.contradiction(report, t_ns)
        for name in names:
            self._note(name, f"ADS-B of {report.callsign or report.icao24} inconsistent", t_ns)
        shared = self._adsb.shared_callsign(report, t_ns)
        if shared is not None:
            self._note(shared, f"callsign {shared} sent by two addresses", t_ns)
        return not names

    def in_order(self, transcript: Transcript, t_ns: int) -> Sequence[Transcript]:
        """Return the transcripts to act on now: none for one that came twice.

        With a late one those of later calls come again, so that the last word counts.
        """
        earlier = self._calls.earlier(transcript)
        if earlier is not None:
            if earlier.text != transcript.text:
                self._note("radio", f"two transcripts of call {transcript.id} differ", t_ns)
            return ()
        calls = self._calls.take(transcript)
        if len(calls) != 1:
            self._note("radio", f"call {transcript.id} came out of order", t_ns)
        return calls

    def believes_detections(self, detections: Detections, t_ns: int) -> bool:
        """Return whether detections are of a known camera, and of a newer picture than the last.

        While no camera has been announced, all are believed: an engine may have joined late.
        """
        camera = detections.camera
        if self._cameras and camera not in self._cameras:
            self._note("vision", f"detections of unknown camera {camera} not used", t_ns)
            return False
        if detections.t_frame_ns <= self._frames.get(camera, -1):
            self._note("vision", f"a picture of camera {camera} came out of order", t_ns)
            return False
        self._frames[camera] = detections.t_frame_ns
        return True

    def marked(self, alert: Alert, t_ns: int) -> Alert:
        """Return an alert whose evidence says what was wrong lately with what it rests on."""
        subjects = {*alert.traffic, *alert.recipients, *alert.evidence.sources}
        wrong = tuple(
            dict.fromkeys(
                text
                for (subject, text), since_ns in self._wrong.items()
                if subject in subjects and t_ns - since_ns <= TOLD_NS
            )
        )
        if not wrong:
            return alert
        evidence = alert.evidence.model_copy(update={"inconsistencies": wrong})
        return replace(alert, evidence=evidence)

    def _note(self, subject: str, text: str, t_ns: int) -> None:
        self._wrong = {
            key: since_ns for key, since_ns in self._wrong.items() if t_ns - since_ns <= TOLD_NS
        }
        self._wrong[subject, text] = t_ns
