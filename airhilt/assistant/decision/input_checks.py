"""Checks of what arrives at an engine: what is believed, and what alerts say of the rest.

Nothing here ends a run. What is not believed is left out, and each alert that rests on the same
aircraft or the same modality says so in its evidence for a while.

Two ADS-B places of one address mean a fault, or somebody who sends false reports (spoofing). Which
of them is false cannot be told: the place known first is kept while reports of it arrive.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import replace

from airhilt.assistant.decision.alerts import Alert
from airhilt.geodesy.wgs84 import Place, are_within_m
from airhilt.messages import AdsbReport, CameraInfo, Detections, Transcript
from airhilt.surveillance.squitters import NACP_95_PERCENT_M
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS

TOLD_NS = 60 * SECOND_NS
"""Time for which alerts tell of something that was wrong, in ns."""
REMEMBERED_NS = 60 * SECOND_NS
"""Time for which calls are remembered, so that a late one is put back into its place, in ns."""
FASTEST_M_S = 1022.0 * KNOT
"""Greatest speed in the air, in m/s: the range of the subsonic velocity squitter (DO-260B,
2.2.3.2.6)."""
FASTEST_ON_GROUND_M_S = 200.0 * KNOT
"""Greatest speed on the ground, in m/s: above all speeds of take-off and landing."""
STEEPEST_M_S = 32_576.0 * FOOT_PER_MINUTE
"""Greatest vertical rate, in m/s: the range of the velocity squitter (DO-260B, 2.2.3.2.6)."""
ALTITUDE_ROOM_M = 100.0 * FOOT
"""Difference of two altitudes, in m, that needs no climb: steps of 25 ft, and their filters."""
PLACE_ROOM_M = 100.0
"""Distance of two positions, in m, beyond their 95 % errors, that needs no flight."""
KEPT_NS = 12 * SECOND_NS
"""Time without a report, in ns, after which another place is believed: more than twice the longest
interval of position squitters, 5.2 s (DO-260B, 2.2.3.3)."""


class InputChecks:
    """Checks what arrives at an engine, and marks alerts with what was wrong."""

    def __init__(self) -> None:
        self._reports: dict[str, tuple[AdsbReport, int]] = {}
        """Last believed report of each address, and its time of arrival in ns."""
        self._senders: dict[str, dict[str, int]] = {}
        """Addresses that send each callsign, with the time of their last report, in ns."""
        self._calls: list[Transcript] = []
        """Recent calls in the order of their beginnings."""
        self._cameras: set[str] = set()
        self._frames: dict[str, int] = {}
        """Time of the last picture of each camera, in ns."""
        self._wrong: dict[tuple[str, str], int] = {}
        """Time at which something was last wrong, by its subject and by what it is."""

    def take_camera(self, info: CameraInfo) -> None:
        """Note that there is a camera."""
        self._cameras.add(info.camera)

    def believes_report(self, report: AdsbReport, t_ns: int) -> bool:
        """Return whether a report agrees with what is known of its address."""
        known, heard_ns = self._reports.get(report.icao24, (report, t_ns))
        is_kept = t_ns - heard_ns <= KEPT_NS
        is_believed = not is_kept or is_possible(known, report)
        if not is_believed:
            callsigns = (known.callsign, report.callsign)
            for name in dict.fromkeys((report.icao24, *filter(None, callsigns))):
                self._note(name, f"ADS-B of {report.callsign or report.icao24} inconsistent", t_ns)
        elif not is_kept or report.t_adsb_in_ns >= known.t_adsb_in_ns:
            self._reports[report.icao24] = (report, t_ns)
        if report.callsign is not None:
            senders = self._senders.setdefault(report.callsign, {})
            senders[report.icao24] = t_ns
            if sum(t_ns - each_ns <= KEPT_NS for each_ns in senders.values()) > 1:
                text = f"callsign {report.callsign} sent by two addresses"
                self._note(report.callsign, text, t_ns)
        return is_believed

    def in_order(self, transcript: Transcript, t_ns: int) -> Sequence[Transcript]:
        """Return the transcripts to act on now: none for one that came twice.

        With a late one those of later calls come again, so that the last word counts. One that is
        more than `REMEMBERED_NS` late is left out.
        """
        for each in self._calls:
            if (each.frequency_khz, each.id) == (transcript.frequency_khz, transcript.id):
                if each.text != transcript.text:
                    self._note("radio", f"two transcripts of call {transcript.id} differ", t_ns)
                return ()
        place = bisect_right(self._calls, transcript.t_tx_ns, key=lambda call: call.t_tx_ns)
        later = self._calls[place:]
        if later:
            self._note("radio", f"call {transcript.id} came out of order", t_ns)
        self._calls.insert(place, transcript)
        oldest_ns = self._calls[-1].t_tx_ns - REMEMBERED_NS
        self._calls = [each for each in self._calls if each.t_tx_ns >= oldest_ns]
        return (transcript, *later) if transcript.t_tx_ns >= oldest_ns else ()

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
        wrong = dict.fromkeys(
            text
            for (subject, text), since_ns in self._wrong.items()
            if subject in subjects and t_ns - since_ns <= TOLD_NS
        )
        if not wrong:
            return alert
        evidence = alert.evidence.model_copy(update={"inconsistencies": tuple(wrong)})
        return replace(alert, evidence=evidence)

    def _note(self, subject: str, text: str, t_ns: int) -> None:
        self._wrong = {
            key: since_ns for key, since_ns in self._wrong.items() if t_ns - since_ns <= TOLD_NS
        }
        self._wrong[subject, text] = t_ns


def is_possible(one: AdsbReport, other: AdsbReport) -> bool:
    """Return whether two reports can be of one aircraft, or of one vehicle."""
    apart_s = abs(other.t_adsb_in_ns - one.t_adsb_in_ns) / SECOND_NS
    on_ground = one.on_ground and other.on_ground
    fastest_m_s = FASTEST_ON_GROUND_M_S if on_ground else FASTEST_M_S
    room_m = PLACE_ROOM_M + NACP_95_PERCENT_M[one.nacp] + NACP_95_PERCENT_M[other.nacp]
    if not are_within_m(room_m + fastest_m_s * apart_s, _place(one), _place(other)):
        return False
    if one.altitude_ft is None or other.altitude_ft is None:
        return True
    climbed_m = abs(other.altitude_ft - one.altitude_ft) * FOOT
    return climbed_m <= ALTITUDE_ROOM_M + STEEPEST_M_S * apart_s


def _place(report: AdsbReport) -> Place:
    return report.latitude_deg * DEGREE, report.longitude_deg * DEGREE
