"""Belief about everything on and near an airport, from the tracks of surface surveillance."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

from airhilt.assistant.decision.aerodrome import Aerodrome, Vector
from airhilt.assistant.decision.mobiles import ACCELERATING_FROM_M_S, GAIN_M_S, ROLLING_M_S
from airhilt.assistant.decision.velocity_checks import MOVING_M_S, VelocityChecks
from airhilt.messages import SurfaceTrack
from airhilt.units import DEGREE, FOOT, KNOT, SECOND_NS

FORGOTTEN_NS = 5 * SECOND_NS
"""Time after which a track that is not renewed is forgotten, in ns."""
GAIN_NS = 4 * SECOND_NS
"""Time over which a gain of speed is looked at, in ns."""
CLIMBED_M = 100.0 * FOOT
"""Height above its lowest point, in m, from which an aircraft in the air climbs away."""


@dataclass
class Target:
    """One track of surface surveillance, as of ``t_ns``."""

    number: int
    point: Vector
    t_ns: int = 0
    icao24: str | None = None
    callsign: str | None = None
    speed_m_s: float = 0.0
    heading_rad: float | None = None
    """Direction in which it moved last; None if it has not moved yet."""
    altitude_m: float | None = None
    """Pressure altitude; None on the ground."""
    has_landed: bool = False
    """True if it is on the ground and was in the air before."""
    has_taken_off: bool = False
    """True if it is in the air and was on the ground before."""
    _lowest_m: float = math.inf
    _speeds: deque[tuple[int, float]] = field(default_factory=deque)

    def update(self, track: SurfaceTrack, point: Vector) -> None:
        """Update with a newer track."""
        was_aloft, is_new = self.altitude_m is not None, not self._speeds
        self.icao24 = track.icao24 or self.icao24
        self.callsign = track.callsign or self.callsign
        self.t_ns, self.point = track.t_track_ns, point
        self.speed_m_s = track.ground_speed_kt * KNOT
        if track.track_deg is not None and self.speed_m_s >= MOVING_M_S:
            self.heading_rad = track.track_deg * DEGREE
        self.altitude_m = None if track.altitude_ft is None else track.altitude_ft * FOOT
        if self.altitude_m is None:
            self.has_landed, self._lowest_m = self.has_landed or was_aloft, math.inf
            self.has_taken_off = False
        else:
            self.has_taken_off = self.has_taken_off or not (was_aloft or is_new)
            self.has_landed = False
            self._lowest_m = min(self._lowest_m, self.altitude_m)
        self._speeds.append((self.t_ns, self.speed_m_s))
        while self._speeds[0][0] < self.t_ns - GAIN_NS:
            self._speeds.popleft()

    @property
    def is_aloft(self) -> bool:
        """True if its transponder says that it is in the air."""
        return self.altitude_m is not None

    @property
    def climbs(self) -> bool:
        """True if it is in the air and has climbed since it was lowest."""
        return self.altitude_m is not None and self.altitude_m > self._lowest_m + CLIMBED_M

    @property
    def is_rolling(self) -> bool:
        """True if it is faster, or gains more speed, than in taxiing."""
        gain_m_s = self.speed_m_s - self._speeds[0][1]
        gathers = self.speed_m_s >= ACCELERATING_FROM_M_S and gain_m_s >= GAIN_M_S
        return self.speed_m_s >= ROLLING_M_S or (gathers and not self.has_landed)

    def point_at(self, t_ns: int) -> Vector:
        """Return where it is at a time, if it goes straight on."""
        if self.heading_rad is None:
            return self.point
        ahead_m = self.speed_m_s * (t_ns - self.t_ns) / SECOND_NS
        return self.point.moved(ahead_m, self.heading_rad)


class SurfaceTraffic:
    """All targets of an airport."""

    def __init__(self, aerodrome: Aerodrome) -> None:
        self._aerodrome = aerodrome
        self._targets: dict[int, Target] = {}
        self._velocities = VelocityChecks()

    def __iter__(self) -> Iterator[Target]:
        return iter(self._targets.values())

    def take(self, track: SurfaceTrack) -> None:
        """Update a target; an older track than the last one is ignored."""
        point = self._aerodrome.locate(track.latitude_deg, track.longitude_deg)
        target = self._targets.setdefault(track.track, Target(track.track, point))
        if track.t_track_ns >= target.t_ns:
            target.update(self._velocities.checked(track), point)

    def forget(self, t_ns: int) -> None:
        """Forget the targets that have not been renewed for a while."""
        self._targets = {
            number: target
            for number, target in self._targets.items()
            if t_ns - target.t_ns <= FORGOTTEN_NS
        }
