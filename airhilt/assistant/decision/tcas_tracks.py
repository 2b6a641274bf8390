"""Tracks of intruders by TCAS, from the replies of transponders.

Range and altitude are each followed by an alpha-beta tracker. The gains of DO-185B are not public:
those here are assumptions. The gains in altitude follow from those of position by the relation of
Benedict and Bordner (1962), beta = alpha^2 / (2 - alpha), and are lower for the coarse steps of
Mode C. A parabolic tracker estimates the acceleration of the range, from which the miss distance
follows: of two that fly straight on, r r'' is the square of the speed across the line of sight.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

from airhilt.messages import TcasReply
from airhilt.surveillance.tcas import RangeMotion
from airhilt.surveillance.tcas_resolution import Vertical
from airhilt.units import FOOT, SECOND_NS

RANGE_GAINS = (0.67, 0.25)
PARABOLIC_GAINS = (0.40, 0.10, 0.01)
ALTITUDE_ALPHA = {"S": 0.5, "C": 0.3}
RANGE_JITTER_M = 50.0 * FOOT
"""Standard deviation of the range of a reply, in m."""
ACCELERATION_NOISE = 0.0142
"""Standard deviation of the tracked acceleration in a steady state, in 1/s^2 for each metre of
jitter, with `PARABOLIC_GAINS` and a reply a second."""
CONFIDENCE = 1.645
"""Standard deviations below the tracked acceleration that the miss distance assumes: 95 %."""
COAST_NS = 6 * SECOND_NS
"""Time without a reply after which a track is dropped, in ns."""
SETTLED_REPLIES = 4
"""Replies after which the rate of a track is used."""
FASTEST_CLOSURE_M_S = 620.0
"""Closing speed for which TCAS II is designed, in m/s: 1,200 kt (FAA, Introduction to TCAS II)."""
RANGE_GATE_M = 200.0
ALTITUDE_GATE_M = 200.0 * FOOT
FASTEST_CLIMB_M_S = 10_000 * FOOT / 60.0
"""Vertical rate above which TCAS II takes nobody for a threat, in m/s (as above)."""


@dataclass(slots=True, eq=False)
class IntruderTrack:
    """One transponder as the TCAS of one aircraft follows it, as of its last reply."""

    icao24: str | None
    t_ns: int
    range_m: float
    altitude_m: float
    has_tcas: bool
    on_ground: bool
    mode: str
    replies: int = 1
    rate_m_s: float = 0.0
    climb_m_s: float = 0.0
    _parabola: tuple[float, float, float] = field(default=(0.0, 0.0, 0.0))

    @classmethod
    def of(cls, reply: TcasReply) -> IntruderTrack:
        """Return the track of a first reply."""
        altitude_m = reply.altitude_ft * FOOT
        track = cls(
            reply.icao24, reply.t_ns, reply.range_m, altitude_m, reply.has_tcas, reply.on_ground,
            reply.mode,
        )  # fmt: skip
        track._parabola = (reply.range_m, 0.0, 0.0)
        return track

    def misfit(self, reply: TcasReply) -> float | None:
        """Return how far a reply is from where this track is expected; None if too far."""
        elapsed_s = (reply.t_ns - self.t_ns) / SECOND_NS
        if reply.icao24 != self.icao24 or elapsed_s <= 0.0:
            return None
        is_new = self.replies == 1
        by_range = abs(reply.range_m - self.motion(reply.t_ns).range_m) / (
            RANGE_GATE_M + (FASTEST_CLOSURE_M_S * elapsed_s if is_new else 0.0)
        )
        by_altitude = abs(reply.altitude_ft * FOOT - self.vertical(reply.t_ns).altitude_m) / (
            ALTITUDE_GATE_M + (FASTEST_CLIMB_M_S * elapsed_s if is_new else 0.0)
        )
        return by_range + by_altitude if max(by_range, by_altitude) <= 1.0 else None

    def update(self, reply: TcasReply) -> None:
        """Update with a newer reply."""
        elapsed_s = (reply.t_ns - self.t_ns) / SECOND_NS
        altitude_m = reply.altitude_ft * FOOT
        self.replies += 1
        if self.replies == 2:
            self.rate_m_s = (reply.range_m - self.range_m) / elapsed_s
            self._parabola = (reply.range_m, self.rate_m_s, 0.0)
            self.range_m, self.altitude_m = reply.range_m, altitude_m
        else:
            self._filter(reply.range_m, altitude_m, elapsed_s)
        self.t_ns, self.on_ground, self.has_tcas = reply.t_ns, reply.on_ground, reply.has_tcas

    def _filter(self, range_m: float, altitude_m: float, elapsed_s: float) -> None:
        alpha, beta = RANGE_GAINS
        expected_m = self.range_m + self.rate_m_s * elapsed_s
        self.range_m = expected_m + alpha * (range_m - expected_m)
        self.rate_m_s += beta * (range_m - expected_m) / elapsed_s
        alpha = ALTITUDE_ALPHA[self.mode]
        expected_m = self.altitude_m + self.climb_m_s * elapsed_s
        self.altitude_m = expected_m + alpha * (altitude_m - expected_m)
        self.climb_m_s += alpha**2 / (2.0 - alpha) * (altitude_m - expected_m) / elapsed_s
        place, rate, acceleration = self._parabola
        expected_m = place + rate * elapsed_s + 0.5 * acceleration * elapsed_s**2
        alpha, beta, gamma = PARABOLIC_GAINS
        error_m = range_m - expected_m
        self._parabola = (
            expected_m + alpha * error_m,
            rate + acceleration * elapsed_s + beta * error_m / elapsed_s,
            acceleration + gamma * error_m / elapsed_s**2,
        )

    @property
    def is_settled(self) -> bool:
        """True if its rates can be used."""
        return self.replies >= SETTLED_REPLIES

    def motion(self, t_ns: int) -> RangeMotion:
        """Return range and range rate at a time."""
        elapsed_s = (t_ns - self.t_ns) / SECOND_NS
        return RangeMotion(max(self.range_m + self.rate_m_s * elapsed_s, 0.0), self.rate_m_s)

    def vertical(self, t_ns: int) -> Vertical:
        """Return altitude and vertical rate at a time."""
        elapsed_s = (t_ns - self.t_ns) / SECOND_NS
        return Vertical(self.altitude_m + self.climb_m_s * elapsed_s, self.climb_m_s)

    def miss_distance_m(self) -> float:
        """Return the miss distance that is exceeded with `CONFIDENCE`, if both fly straight on.

        In three dimensions, as ranges are.
        """
        range_m, rate, acceleration = self._parabola
        least = acceleration - CONFIDENCE * ACCELERATION_NOISE * RANGE_JITTER_M
        across = range_m * max(least, 0.0)
        return range_m * math.sqrt(across / (rate**2 + across)) if across > 0.0 else 0.0


class IntruderTracks:
    """The tracks of one aircraft's TCAS.

    Replies are connected by address, range and altitude, so that two transponders with one address,
    or without any, have a track each.
    """

    def __init__(self) -> None:
        self._tracks: list[IntruderTrack] = []

    def __iter__(self) -> Iterator[IntruderTrack]:
        yield from self._tracks

    def take_reply(self, reply: TcasReply) -> None:
        """Update the track that a reply fits best, or begin one."""
        fitting = [
            (misfit, index)
            for index, track in enumerate(self._tracks)
            if (misfit := track.misfit(reply)) is not None
        ]
        if fitting:
            self._tracks[min(fitting)[1]].update(reply)
        else:
            self._tracks.append(IntruderTrack.of(reply))

    def forget(self, t_ns: int) -> list[IntruderTrack]:
        """Drop the tracks without replies for long, and return these."""
        lost = [track for track in self._tracks if t_ns - track.t_ns > COAST_NS]
        self._tracks = [track for track in self._tracks if t_ns - track.t_ns <= COAST_NS]
        return lost
