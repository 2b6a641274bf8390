"""Conversion factors between SI and the units of aviation, for use at the edges only.

Multiply to enter SI (``350 * KNOT`` is in m/s), divide to leave it.
"""

from __future__ import annotations

import math

FOOT = 0.3048
"""Metres in an international foot (exact; ICAO Annex 5)."""
INCH = FOOT / 12.0
"""Metres in an inch."""
NAUTICAL_MILE = 1852.0
"""Metres in a nautical mile (exact; ICAO Annex 5)."""
KNOT = NAUTICAL_MILE / 3600.0
"""Metres per second in a knot."""
POUND = 0.45359237
"""Kilograms in a pound (exact; ICAO Annex 5)."""
FOOT_PER_MINUTE = FOOT / 60.0
"""Metres per second in a foot per minute."""
DEGREE = math.pi / 180.0
"""Radians in a degree."""
SECOND_NS = 1_000_000_000
"""Nanoseconds in a second."""
MILLISECOND_NS = 1_000_000
"""Nanoseconds in a millisecond."""
STANDARD_GRAVITY = 9.80665
"""m/s2 (ICAO Doc 7488/3)."""


def seconds_to_ns(seconds: float) -> int:
    """Return ``seconds`` as a whole number of nanoseconds, rounded to the nearest."""
    return round(seconds * SECOND_NS)


def ns_to_seconds(t_ns: int | None) -> float | None:
    """Return a time in seconds, None if it is not known."""
    return None if t_ns is None else t_ns / SECOND_NS


def wrap_angle(angle: float) -> float:
    """Return ``angle`` (rad) brought into [-pi, pi)."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def bearing_degrees(angle: float) -> float:
    """Return an angle in radians as a bearing in [0, 360) degrees."""
    degrees = math.degrees(angle) % 360.0
    return 0.0 if degrees >= 360.0 else degrees
