"""Relative motion of two aircraft over the ellipsoid.

Horizontal distances are along the surface at the aircraft's height, not slant ranges.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple, Protocol

from airhilt.geodesy.wgs84 import offset_m, wrapped_turn


class Kinematics(Protocol):
    """A position and a velocity over ground, SI and radians."""

    @property
    def latitude_rad(self) -> float: ...  # noqa: D102
    @property
    def longitude_rad(self) -> float: ...  # noqa: D102
    @property
    def altitude_m(self) -> float: ...  # noqa: D102
    @property
    def velocity_north_m_s(self) -> float: ...  # noqa: D102
    @property
    def velocity_east_m_s(self) -> float: ...  # noqa: D102


class Relative(NamedTuple):
    """The other aircraft as seen from one's own, horizontally (m, m/s)."""

    north_m: float
    east_m: float
    velocity_north_m_s: float
    velocity_east_m_s: float

    @property
    def distance_m(self) -> float:
        """Horizontal distance."""
        return math.hypot(self.north_m, self.east_m)

    @property
    def speed_m_s(self) -> float:
        """Horizontal speed against each other."""
        return math.hypot(self.velocity_north_m_s, self.velocity_east_m_s)

    def at(self, time_s: float) -> Relative:
        """Return the relative state ``time_s`` later, both flying straight on."""
        return Relative(
            self.north_m + self.velocity_north_m_s * time_s,
            self.east_m + self.velocity_east_m_s * time_s,
            self.velocity_north_m_s,
            self.velocity_east_m_s,
        )

    def time_to_closest_approach_s(self) -> float:
        """Return when the horizontal distance is least; negative once it is past.

        0 if the two do not move against each other.
        """
        speed_squared = self.velocity_north_m_s**2 + self.velocity_east_m_s**2
        if speed_squared < 1e-12:
            return 0.0
        closing = self.north_m * self.velocity_north_m_s + self.east_m * self.velocity_east_m_s
        return -closing / speed_squared

    def interval_within(self, distance_m: float) -> tuple[float, float] | None:
        """Return from when to when (s, may be negative) the two are closer than a distance.

        None if they never are; infinite bounds if they always are.
        """
        a = self.velocity_north_m_s**2 + self.velocity_east_m_s**2
        c = self.north_m**2 + self.east_m**2 - distance_m**2
        if a < 1e-12:
            return (-math.inf, math.inf) if c < 0.0 else None
        half_b = self.north_m * self.velocity_north_m_s + self.east_m * self.velocity_east_m_s
        discriminant = half_b * half_b - a * c
        if discriminant <= 0.0:
            return None
        root = math.sqrt(discriminant)
        return (-half_b - root) / a, (-half_b + root) / a


def relative(own: Kinematics, other: Kinematics) -> Relative:
    """Return ``other`` as seen from ``own`` by the mid-latitude formula.

    Both velocities are turned by half the convergence of the meridians, so that they are
    resolved along the north of the point midway. Within 0.1 % of the geodesic up to 200 km
    below 70 degrees of latitude.
    """
    middle = 0.5 * (own.latitude_rad + other.latitude_rad)
    turn = wrapped_turn(other.longitude_rad - own.longitude_rad)
    north_m, east_m = _offset_m(own, other)
    half_convergence = 0.5 * turn * math.sin(middle)
    # North at `other` lies clockwise of north midway by half the convergence, at `own` against it.
    sin_c, cos_c = math.sin(half_convergence), math.cos(half_convergence)
    own_n, own_e = own.velocity_north_m_s, own.velocity_east_m_s
    oth_n, oth_e = other.velocity_north_m_s, other.velocity_east_m_s
    return Relative(
        north_m,
        east_m,
        (oth_n * cos_c + oth_e * sin_c) - (own_n * cos_c - own_e * sin_c),
        (oth_e * cos_c - oth_n * sin_c) - (own_e * cos_c + own_n * sin_c),
    )


def horizontal_distance_m(own: Kinematics, other: Kinematics) -> float:
    """Return the horizontal distance of two, in m: that of `relative` without their motion."""
    return math.hypot(*_offset_m(own, other))


def _offset_m(own: Kinematics, other: Kinematics) -> tuple[float, float]:
    return offset_m(
        (own.latitude_rad, own.longitude_rad),
        (other.latitude_rad, other.longitude_rad),
        0.5 * (own.altitude_m + other.altitude_m),
    )


class VerticalProfile(NamedTuple):
    """Altitude against time: at a steady rate, then level at a target if there is one."""

    altitude_m: float
    rate_m_s: float
    target_m: float | None = None

    def level_off_s(self) -> float:
        """Return when it levels off; infinite without a target ahead."""
        if self.target_m is None or self.rate_m_s == 0.0:
            return math.inf
        time_s = (self.target_m - self.altitude_m) / self.rate_m_s
        return time_s if time_s >= 0.0 else math.inf

    def at(self, time_s: float) -> float:
        """Return the altitude ``time_s`` from now."""
        return self.altitude_m + self.rate_m_s * min(time_s, self.level_off_s())


class Minima(NamedTuple):
    """Separation is lost when both distances fall below these."""

    horizontal_m: float
    vertical_m: float


def time_to_loss_s(
    relative_motion: Relative,
    own: VerticalProfile,
    other: VerticalProfile,
    minima: Minima,
) -> float | None:
    """Return how long until separation is lost, 0 if it is already, None if it will not be.

    Both fly straight on horizontally and by their profiles vertically.
    """
    interval = relative_motion.interval_within(minima.horizontal_m)
    if interval is None or interval[1] <= 0.0:
        return None
    begin, end = max(interval[0], 0.0), interval[1]
    knots = [t for t in (own.level_off_s(), other.level_off_s()) if begin < t < end]
    edges = [begin, *sorted(knots), end]
    for left, right in itertools.pairwise(edges):
        found = _first_below(left, right, own, other, minima.vertical_m)
        if found is not None:
            return found
    return None


def _first_below(
    left: float, right: float, own: VerticalProfile, other: VerticalProfile, limit_m: float
) -> float | None:
    """Return when |difference of altitude| first falls below a limit in a linear stretch."""
    gap = other.at(left) - own.at(left)
    if abs(gap) < limit_m:
        return left
    middle = left + 1.0 if math.isinf(right) else 0.5 * (left + right)
    rate = (other.at(middle) - own.at(middle) - gap) / (middle - left)
    if gap * rate >= 0.0:
        return None
    crossing = left + (abs(gap) - limit_m) / abs(rate)
    return crossing if crossing < right else None
