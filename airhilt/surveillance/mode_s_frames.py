"""Turns ADS-B reports back into the Mode S frames that a receiver at 1090 MHz hears."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.messages import AdsbReport
from airhilt.surveillance import cpr, mode_s
from airhilt.surveillance.transponders import EMERGENCY_CODES
from airhilt.units import seconds_to_ns

STATUS_S = 5.0
"""Period of identification and aircraft status, in s (DO-260B, 2.2.3.3)."""
EMERGENCY_S = 0.8
"""Period of the aircraft status during an emergency, in s (DO-260B, 2.2.3.3.2.6.3)."""
OPERATIONAL_STATUS_S = 2.5
"""Period of the operational status, in s (DO-260B, 2.2.3.3.2.6.4)."""
ACQUISITION_S = 1.0
"""Period of acquisition squitters, in s (ICAO Annex 10, volume IV, 3.1.2.8.5.1)."""
INTERROGATION_S = 5.0
"""Period of replies to interrogations, in s: that of a turn of a terminal radar."""


class FrameSource:
    """Makes Mode S frames of ADS-B reports.

    Each report gives a position, in the even and the odd format by turns, and a velocity if it is
    in the air. The other frames follow at their periods, in the time of the reports. A ground
    vehicle sends downlink format 18, as a device that is no transponder, and replies to nothing.
    """

    def __init__(self) -> None:
        self._is_odd: dict[str, bool] = {}
        self._due_ns: dict[tuple[str, str], int] = {}
        """Time from which a sender's frame of a kind is due again."""

    def frames(self, report: AdsbReport) -> Iterator[bytes]:
        """Yield the frames of a report."""
        address = int(report.icao24, 16)
        if (report.emitter_category or "").startswith("C"):
            for message in self._messages(report):
                yield mode_s.non_transponder_squitter(address, message)
            return
        if self._is_due(report, "acquisition", ACQUISITION_S):
            yield mode_s.all_call_reply(address, report.on_ground, _has_alert(report))
        for message in self._messages(report):
            yield mode_s.extended_squitter(address, message, report.on_ground, _has_alert(report))
        if self._is_due(report, "replies", INTERROGATION_S):
            yield from self._replies(report, address)

    def _messages(self, report: AdsbReport) -> Iterator[int]:
        """Yield the messages of extended squitters."""
        is_odd = self._is_odd[report.icao24] = not self._is_odd.get(report.icao24, True)
        position = cpr.encode(
            report.latitude_deg, report.longitude_deg, is_odd, surface=report.on_ground
        )
        motion = report.ground_speed_kt, report.track_deg
        if report.on_ground:
            yield mode_s.surface_position(position, *motion, report.nic)
        else:
            yield mode_s.airborne_position(
                position, report.altitude_ft, report.nic, _has_alert(report)
            )
            yield mode_s.airborne_velocity(*motion, report.vertical_rate_fpm, report.nacv)
        if report.callsign is not None and self._is_due(report, "identification", STATUS_S):
            yield mode_s.identification(report.callsign, report.emitter_category or "A0")
        if self._is_due(report, "operational status", OPERATIONAL_STATUS_S):
            yield mode_s.operational_status(
                report.on_ground, report.nic, report.nacp, report.nacv, report.sil
            )
        period_s = STATUS_S if report.emergency == "none" else EMERGENCY_S
        if self._is_due(report, f"status {report.emergency}", period_s):
            yield mode_s.aircraft_status(report.emergency, report.squawk)

    def _replies(self, report: AdsbReport, address: int) -> Iterator[bytes]:
        """Yield the replies to a radar that asks for everything."""
        transponder = mode_s.Surveillance(
            address, report.altitude_ft, report.squawk, report.callsign or "", report.on_ground,
            _has_alert(report),
        )  # fmt: skip
        yield transponder.altitude_reply()
        if report.callsign is not None:
            yield transponder.comm_b_altitude_reply()
        if report.squawk is not None:
            yield transponder.identity_reply()
            yield transponder.comm_b_identity_reply()

    def _is_due(self, report: AdsbReport, kind: str, period_s: float) -> bool:
        """Return whether a frame is due, and if so when the next one is."""
        t_ns = report.t_adsb_in_ns
        if t_ns < self._due_ns.get((report.icao24, kind), 0):
            return False
        self._due_ns[report.icao24, kind] = t_ns + seconds_to_ns(period_s)
        return True


def _has_alert(report: AdsbReport) -> bool:
    """Return whether the Mode A code is that of an emergency (ICAO Annex 10, IV, 3.1.2.6.10.1)."""
    return report.squawk in EMERGENCY_CODES
