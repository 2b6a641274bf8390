"""Perception of an agent, and its observation of that."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.messages import AdsbReport, CockpitInstruments, Message, Transcript
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS

TRAFFIC: Mapping[str, tuple[float, float]] = {
    "known": (0.0, 1.0),
    "east_m": (-2e6, 2e6),
    "north_m": (-2e6, 2e6),
    "altitude_m": (-1000.0, 30_000.0),
    "east_m_s": (-1000.0, 1000.0),
    "north_m_s": (-1000.0, 1000.0),
    "climb_m_s": (-200.0, 200.0),
    "age_s": (0.0, 86_400.0),
}
"""Columns of the traffic, with their least and greatest value: 1 if a report has come, then what
the last report says, from the centre of the scenario, and its age. All are 0 without a report."""
OWN: Mapping[str, tuple[float, float]] = {
    "airspeed_m_s": (0.0, 1000.0),
    "altitude_m": (-1000.0, 30_000.0),
    "climb_m_s": (-200.0, 200.0),
    "track_rad": (0.0, 2.0 * math.pi),
    "ground_speed_m_s": (0.0, 1000.0),
    "roll_rad": (-math.pi, math.pi),
    "selected_altitude_m": (-1000.0, 30_000.0),
    "selected_airspeed_m_s": (0.0, 1000.0),
}
"""Values of the own instruments, with the least and greatest of each."""
LONGEST_CALLS = 2000
"""Greatest number of characters of the calls of a step."""


class Perception:
    """Newest report of each callsign, own instruments, and calls since the last observation.

    Parameters
    ----------
    callsigns
        Rows of the traffic, in this order.
    has_instruments
        True for an agent in an aircraft.
    """

    def __init__(
        self, callsigns: Sequence[str], frame: LocalFrame, *, has_instruments: bool
    ) -> None:
        self.reports: dict[str, AdsbReport] = {}
        self.heard_ns = 0
        """Time of the newest message."""
        self._callsigns = callsigns
        self._frame = frame
        self._has_instruments = has_instruments
        self._instruments: CockpitInstruments | None = None
        self._messages: list[tuple[str, Message]] = []

    def take(self, key: str, message: Message) -> None:
        """Take in a message that the agent perceives."""
        self.heard_ns = message.t_ns
        self._messages.append((key, message))
        match message:
            case AdsbReport(callsign=str(callsign)):
                self.reports[callsign] = message
            case CockpitInstruments():
                self._instruments = message

    def messages(self) -> tuple[tuple[str, Message], ...]:
        """Return the messages since the last call, with their keys."""
        messages, self._messages = tuple(self._messages), []
        return messages

    def observation(self, now_ns: int, messages: Sequence[tuple[str, Message]]) -> dict[str, Any]:
        """Return the observation at a time, with the calls among some messages."""
        traffic = np.zeros((len(self._callsigns), len(TRAFFIC)), np.float32)
        for row, callsign in zip(traffic, self._callsigns, strict=True):
            if (report := self.reports.get(callsign)) is not None:
                row[:] = self._row(report, now_ns)
        calls = "\n".join(each.text for _, each in messages if isinstance(each, Transcript))
        seen = {"traffic": _within(traffic, TRAFFIC), "calls": _printable(calls)}
        return seen | ({"own": self._own()} if self._has_instruments else {})

    def _row(self, report: AdsbReport, now_ns: int) -> tuple[float, ...]:
        place = (report.latitude_deg * DEGREE, report.longitude_deg * DEGREE)
        east_m, north_m = self._frame.to_local(place)
        speed_m_s, track_rad = report.ground_speed_kt * KNOT, report.track_deg * DEGREE
        return (
            1.0,
            east_m,
            north_m,
            (report.altitude_ft or 0.0) * FOOT,
            speed_m_s * math.sin(track_rad),
            speed_m_s * math.cos(track_rad),
            report.vertical_rate_fpm * FOOT_PER_MINUTE,
            (now_ns - report.t_adsb_in_ns) / SECOND_NS,
        )

    def _own(self) -> NDArray[np.float32]:
        shown = self._instruments
        if shown is None:
            return np.zeros(len(OWN), np.float32)
        values = (
            shown.airspeed_kt * KNOT,
            shown.altitude_ft * FOOT,
            shown.vertical_speed_fpm * FOOT_PER_MINUTE,
            shown.track_deg * DEGREE,
            shown.ground_speed_kt * KNOT,
            shown.roll_deg * DEGREE,
            shown.selected_altitude_ft * FOOT,
            shown.selected_airspeed_kt * KNOT,
        )
        return _within(np.array(values, np.float32), OWN)


def _within(
    values: NDArray[np.float32], columns: Mapping[str, tuple[float, float]]
) -> NDArray[np.float32]:
    """Return values within the limits of their columns."""
    least, greatest = bounds(columns)
    return np.minimum(np.maximum(values, least), greatest)


def bounds(
    columns: Mapping[str, tuple[float, float]],
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return the least and the greatest values of columns."""
    least, greatest = np.array(tuple(columns.values()), np.float32).T
    return least, greatest


def _printable(calls: str) -> str:
    """Return the end of the calls in ASCII."""
    return calls.encode("ascii", "replace").decode()[-LONGEST_CALLS:]
