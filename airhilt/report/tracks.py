"""The tracks of actors: read from a log, thinned out, and placed on a plane."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from airhilt.geodesy.wgs84 import Place, offset_m
from airhilt.host.text import readable
from airhilt.record import Logged
from airhilt.report.intervals import Intervals, seconds
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE, wrap_angle

Json = dict[str, Any]
Values = NDArray[np.float64]

PHASE = re.compile(rb'"phase":\s*("(?:[^"\\]|\\.)*")')
"""The phase in the bytes of a state: parsing each state only to see no change takes too long."""


class State(NamedTuple):
    """The true state of an actor, with the fields that `relative` needs."""

    t_ns: int
    latitude_rad: float
    longitude_rad: float
    altitude_m: float
    velocity_north_m_s: float
    velocity_east_m_s: float
    heading_deg: float
    on_ground: bool


def parse_state(data: bytes) -> State:
    """Return the state in an `ActorTruth` as it was logged."""
    truth = json.loads(data)
    return State(
        int(truth["t_ns"]),
        float(truth["latitude_deg"]) * DEGREE,
        float(truth["longitude_deg"]) * DEGREE,
        float(truth["altitude_m"]),
        float(truth["velocity_north_m_s"]),
        float(truth["velocity_east_m_s"]),
        float(truth["heading_deg"]),
        truth["on_ground"],
    )


class ThinnedStates:
    """Keeps a limited number of an actor's states, evenly spaced in time, and the last one.

    Messages are kept as logged: most are thrown away again, and parsing is what takes time.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._stride = 1
        self._seen = 0
        self._kept: list[Logged] = []
        self._last: Logged | None = None

    def add(self, logged: Logged) -> None:
        """Add the next state, as it was logged."""
        if self._seen % self._stride == 0:
            if len(self._kept) == self._most:
                self._kept = self._kept[::2]
                self._stride *= 2
            if self._seen % self._stride == 0:
                self._kept.append(logged)
        self._seen += 1
        self._last = logged

    def messages(self) -> list[Logged]:
        """Return the messages that were kept."""
        if self._last is None or self._kept[-1] is self._last:
            return self._kept
        return [*self._kept, self._last]


class Phases:
    """Finds the phases of one actor, such as ``taxi``, in its states."""

    def __init__(self) -> None:
        self._intervals: Intervals[str] = Intervals()
        self._phase = b""
        self._last_ns = 0

    def add(self, t_ns: int, data: bytes) -> None:
        """Add the next state, as it was logged."""
        self._last_ns = t_ns
        found = PHASE.search(data)
        if found is not None and found[1] != self._phase:
            self._phase = found[1]
            self._intervals.update(t_ns, [json.loads(self._phase)])

    def as_json(self) -> list[Json]:
        """Return the phases; the last one ends with the last state."""
        return [
            {"what": readable(phase.what), **phase.times_as_json()}
            for phase in self._intervals.until(self._last_ns)
        ]


Locate = Callable[[Place, float], tuple[float, float]]
"""Returns the distance of a place east and north of the plan's centre, in NM; the second argument
is the height of the place above WGS84, in m."""


class Projection(NamedTuple):
    """A plane that touches the ellipsoid in the middle of the traffic."""

    latitude_rad: float
    longitude_rad: float

    @classmethod
    def around(cls, states: Iterable[State]) -> Projection:
        """Return the projection whose centre is the middle of all states."""
        known = list(states)
        if not known:
            return cls(0.0, 0.0)
        latitudes = [state.latitude_rad for state in known]
        begin = known[0].longitude_rad
        turns = [wrap_angle(state.longitude_rad - begin) for state in known]
        return cls(
            (min(latitudes) + max(latitudes)) / 2.0,
            begin + (min(turns) + max(turns)) / 2.0,
        )

    def locate(self, place: Place, height_m: float) -> tuple[float, float]:
        """Return the distance of a place east and north of the centre at its height, in NM."""
        centre = self.latitude_rad, self.longitude_rad
        north_m, east_m = offset_m(centre, place, height_m)
        return east_m / NAUTICAL_MILE, north_m / NAUTICAL_MILE


class Track(NamedTuple):
    """The states of an actor, where they lie on the plan, and the actor's phases."""

    states: list[State]
    east_nm: list[float]
    north_nm: list[float]
    phases: list[Json]

    @classmethod
    def of(cls, states: list[State], phases: list[Json], locate: Locate) -> Track:
        """Return the track through some states."""
        positions = [
            locate((state.latitude_rad, state.longitude_rad), state.altitude_m) for state in states
        ]
        east_nm, north_nm = [east for east, _ in positions], [north for _, north in positions]
        return cls(states, east_nm, north_nm, phases)

    def positions_m(self, t_ns: Sequence[int]) -> tuple[Values, Values, Values]:
        """Return the distances east, north and up at some times, between two states, in m."""
        times = [state.t_ns for state in self.states]
        heights_m = [state.altitude_m for state in self.states]
        return (
            np.interp(t_ns, times, self.east_nm) * NAUTICAL_MILE,
            np.interp(t_ns, times, self.north_nm) * NAUTICAL_MILE,
            np.interp(t_ns, times, heights_m),
        )

    def as_json(self, callsign: str, at_airport: bool) -> Json:
        """Return what is drawn; at an airport to metres, and with headings."""
        digits = 5 if at_airport else 3
        track: Json = {
            "callsign": callsign,
            "t": [seconds(state.t_ns) for state in self.states],
            "east_nm": [round(east, digits) for east in self.east_nm],
            "north_nm": [round(north, digits) for north in self.north_nm],
            "altitude_ft": [round(state.altitude_m / FOOT) for state in self.states],
            "on_ground": self._on_ground_s(),
            "phases": self.phases,
        }
        if at_airport:
            track["heading_deg"] = [round(state.heading_deg) for state in self.states]
        return track

    def _on_ground_s(self) -> list[tuple[float, float]]:
        intervals: Intervals[bool] = Intervals()
        for state in self.states:
            intervals.update(state.t_ns, [True] if state.on_ground else [])
        return [
            (seconds(interval.from_ns), seconds(interval.to_ns))
            for interval in intervals.until(self.states[-1].t_ns)
        ]
