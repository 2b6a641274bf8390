"""Consistency of ADS-B reports: no jumps, and one place for one address.

Reports that contradict each other mean a fault, or somebody who sends false ones (spoofing). Which
of two places is the false one cannot be told. The one that was known first is kept while reports
of it arrive.
"""

from __future__ import annotations

from dataclasses import dataclass

from airhilt.geodesy.wgs84 import Place, are_within_m
from airhilt.messages import AdsbReport
from airhilt.surveillance.squitters import NACP_95_PERCENT_M
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS

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


@dataclass(slots=True)
class _Known:
    """The last report of an address that was believed, and when it arrived."""

    report: AdsbReport
    heard_ns: int


class AdsbConsistency:
    """Compares each report with the last believed one of its address."""

    def __init__(self) -> None:
        self._known: dict[str, _Known] = {}
        self._senders: dict[str, dict[str, int]] = {}
        """Addresses that send each callsign, with the time of their last report, in ns."""

    def contradiction(self, report: AdsbReport, t_ns: int) -> tuple[str, ...]:
        """Return the names whose reports contradict a report; none if it can be believed.

        A report that is believed becomes the one that others are compared with.
        """
        known = self._known.get(report.icao24)
        if known is not None and t_ns - known.heard_ns <= KEPT_NS:
            if not is_possible(known.report, report):
                return _names(known.report, report)
            if report.t_adsb_in_ns < known.report.t_adsb_in_ns:
                return ()
        self._known[report.icao24] = _Known(report, t_ns)
        return ()

    def shared_callsign(self, report: AdsbReport, t_ns: int) -> str | None:
        """Return the callsign of a report if another address has it too; None if it is its own."""
        if report.callsign is None:
            return None
        senders = self._senders.setdefault(report.callsign, {})
        senders[report.icao24] = t_ns
        lately = [icao24 for icao24, heard_ns in senders.items() if t_ns - heard_ns <= KEPT_NS]
        return report.callsign if len(lately) > 1 else None


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


def _names(*reports: AdsbReport) -> tuple[str, ...]:
    """Return callsigns and addresses of some reports, each once."""
    names = [report.icao24 for report in reports] + [report.callsign or "" for report in reports]
    return tuple(dict.fromkeys(name for name in names if name))
