"""ADS-B squitters: their fields, their resolution and their accuracy categories (RTCA DO-260B)."""

from __future__ import annotations

import bisect
import math
from typing import NamedTuple

from airhilt.messages import EmitterCategory
from airhilt.surveillance.cpr import CprPosition

ALTITUDE_STEP_FT = 25.0
SPEED_STEP_KT = 1.0
VERTICAL_RATE_STEP_FPM = 64.0
SURFACE_TRACK_STEP_DEG = 360.0 / 128.0
MOVEMENT_STEPS_KT = (
    (0.0, 1, 0.125), (0.125, 6, 0.875 / 6), (1.0, 4, 0.25), (2.0, 26, 0.5), (15.0, 55, 1.0),
    (70.0, 15, 2.0), (100.0, 15, 5.0),
)  # fmt: skip
"""Steps of the surface format's movement field: speed above which they follow, count, size, in kt.

The first code is a standstill, the last one is 175 kt or more (DO-260B, 2.2.3.2.4.2).
"""
FASTEST_MOVEMENT_KT = 175.0
"""Speed from which on the movement field has one code only, in kt."""

NACP_95_PERCENT_M = (
    37_040.0, 18_520.0, 7_408.0, 3_704.0, 1_852.0, 926.0, 555.6, 185.2, 92.6, 30.0, 10.0, 3.0,
)  # fmt: skip
"""95 % horizontal position error by NACp, in m (DO-260B); 0, unknown, is twice that of 1."""
NACV_95_PERCENT_M_S = (20.0, 10.0, 3.0, 1.0, 0.3)
"""95 % horizontal velocity error by NACv, in m/s (DO-260B); 0, unknown, is twice that of 1."""


class PositionSquitter(NamedTuple):
    """Airborne position and pressure altitude."""

    position: CprPosition
    altitude_ft: float


class VelocitySquitter(NamedTuple):
    """Airborne velocity over ground."""

    ground_speed_kt: float
    track_deg: float
    vertical_rate_fpm: float


class SurfacePositionSquitter(NamedTuple):
    """Surface position, with movement and heading."""

    position: CprPosition
    movement: VelocitySquitter
    altitude_ft: None = None


class IdentificationSquitter(NamedTuple):
    """Callsign and emitter category."""

    callsign: str
    category: EmitterCategory


Squitter = PositionSquitter | VelocitySquitter | SurfacePositionSquitter | IdentificationSquitter


def quantise(value: float, step: float) -> float:
    """Return ``value`` rounded to a multiple of ``step``."""
    return step * math.floor(value / step + 0.5)


_MOVEMENTS_KT = tuple(
    (lowest + step * index, lowest + step * (index + 0.5))
    for lowest, count, step in MOVEMENT_STEPS_KT
    for index in range(count)
)
"""Lower limit and middle of the step of each movement code from 2 to 123, in kt."""
_SPEEDS_KT = (0.0, *(middle for _, middle in _MOVEMENTS_KT), FASTEST_MOVEMENT_KT)
"""Speed that each movement code from 1 to 124 tells, in kt."""


def movement_code(speed_kt: float) -> int:
    """Return the code of a speed in the movement field: 1 for a standstill, 124 from 175 kt on."""
    if speed_kt >= FASTEST_MOVEMENT_KT:
        return 2 + len(_MOVEMENTS_KT)
    return 1 + bisect.bisect_left(_MOVEMENTS_KT, (speed_kt,))


def movement_kt(speed_kt: float) -> float:
    """Return the speed that the movement field tells: the middle of the step of a speed, in kt.

    It is 0 for a standstill and 175 from that speed on.
    """
    return _SPEEDS_KT[movement_code(speed_kt) - 1]
