"""The use of each runway over time: occupants of its protected area, and approaches."""

from __future__ import annotations

from typing import Any

import numpy as np

from airhilt.host.text import readable
from airhilt.messages import RunwayTruth
from airhilt.record import Logged, RunFolder
from airhilt.report.data import RunData
from airhilt.report.events import runway_name
from airhilt.report.intervals import Interval, Intervals
from airhilt.report.sections import Content, Section
from airhilt.units import NAUTICAL_MILE, SECOND_NS

Json = dict[str, Any]


Approach = tuple[str, str]
"""An aircraft, and the runway that it is about to land on, by the direction of landing."""


class RunwayTimeline:
    """Occupants of one runway's protected area, and aircraft about to land on it, over time."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._occupants: Intervals[str] = Intervals()
        self._approaches: Intervals[Approach] = Intervals()

    def update(self, t_ns: int, truth: RunwayTruth) -> None:
        """Add the next state of the runway."""
        self._occupants.update(t_ns, truth.occupants)
        self._approaches.update(
            t_ns, ((arrival.actor, arrival.runway) for arrival in truth.arrivals)
        )

    def as_json(self, run: RunData) -> Json:
        """Return intervals; an approach ends when it is down or has gone around."""
        return {
            "runway": self._name,
            "occupants": [
                {"what": readable(interval.what), **interval.times_as_json()}
                for interval in self._occupants.until(run.end_ns)
            ],
            "approaches": [
                {
                    "what": interval.what[0],
                    "runway": interval.what[1],
                    "threshold": _threshold_s(interval, run),
                    **interval.times_as_json(),
                }
                for interval in self._approaches.until(run.end_ns)
            ],
        }


class Runways(Content):
    """The timelines of all runways."""

    def __init__(self, folder: RunFolder) -> None:
        super().__init__(folder)
        self._timelines: dict[str, RunwayTimeline] = {}

    def take(self, logged: Logged) -> None:
        """Receive a `RunwayTruth`."""
        truth = RunwayTruth.model_validate_json(logged.data)
        name = runway_name(truth.runway)
        self._timelines.setdefault(name, RunwayTimeline(name)).update(logged.t_ns, truth)

    def as_json(self, run: RunData) -> list[Json]:
        """Return one object for each runway."""
        return [timeline.as_json(run) for timeline in self._timelines.values()]


def _threshold_s(approach: Interval[Approach], run: RunData) -> float | None:
    actor, runway = approach.what
    track = run.tracks.get(actor)
    if run.airport is None or track is None:
        return None
    times_s = [state.t_ns / SECOND_NS for state in track.states]
    first, last = np.searchsorted(
        times_s, (approach.from_ns / SECOND_NS, approach.to_ns / SECOND_NS)
    )
    part = slice(max(first - 1, 0), last + 1)
    east_m = [value * NAUTICAL_MILE for value in track.east_nm[part]]
    north_m = [value * NAUTICAL_MILE for value in track.north_nm[part]]
    crossed_s = run.airport.threshold_crossed_s(runway, times_s[part], east_m, north_m)
    return None if crossed_s is None else round(crossed_s, 2)


SECTION = Section(
    "runways", order=50, module=__file__, content=Runways, keys=("truth/runway/",), within="flight"
)
