"""State of an aircraft, how it begins, and the air that it flies in. SI and radians."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from airhilt.geodesy.wgs84 import Place


class AircraftState(NamedTuple):
    """The true state of an aircraft at one instant.

    A tuple, because one is made at every control tick: it is built in a fifth of the time that a
    frozen dataclass takes.
    """

    latitude_rad: float
    """Geodetic latitude, WGS84."""
    longitude_rad: float
    altitude_m: float
    """Geodetic height above WGS84, which in the standard atmosphere is the pressure altitude."""
    height_agl_m: float
    """Height of the wheels above the ground."""
    velocity_north_m_s: float
    """Velocity over the ground, like the next two."""
    velocity_east_m_s: float
    velocity_down_m_s: float
    roll_rad: float
    pitch_rad: float
    heading_rad: float
    """True heading, in [0, 2 pi)."""
    true_airspeed_m_s: float
    calibrated_airspeed_m_s: float
    mach: float
    ecef_x_m: float
    ecef_y_m: float
    ecef_z_m: float

    @property
    def place(self) -> Place:
        """Latitude and longitude."""
        return self.latitude_rad, self.longitude_rad

    @property
    def ground_speed_m_s(self) -> float:
        """Horizontal speed over the ground."""
        return math.hypot(self.velocity_north_m_s, self.velocity_east_m_s)

    @property
    def track_rad(self) -> float:
        """True track over the ground, in (-pi, pi]."""
        return math.atan2(self.velocity_east_m_s, self.velocity_north_m_s)

    @property
    def vertical_rate_m_s(self) -> float:
        """Rate of climb, negative in a descent."""
        return -self.velocity_down_m_s


@dataclass(frozen=True, slots=True)
class InitialCondition:
    """Place of an aircraft that begins in the air, and its flight there.

    On approach its gear is down and its flaps are set for landing; otherwise it is clean.
    """

    latitude_rad: float
    longitude_rad: float
    altitude_m: float
    track_rad: float
    calibrated_airspeed_m_s: float
    vertical_rate_m_s: float = 0.0
    on_approach: bool = False
    bank_rad: float = 0.0


@dataclass(frozen=True, slots=True)
class OnGround:
    """Place of an aircraft that begins on its wheels, brakes set, engines idling.

    It may stand lined up on a runway, or anywhere else.
    """

    latitude_rad: float
    longitude_rad: float
    heading_rad: float
    lined_up: bool = False


@dataclass(frozen=True, slots=True)
class Atmosphere:
    """Wind and turbulence in the standard atmosphere.

    The wind components say where the air moves *to*. Turbulence is JSBSim's MIL-F-8785C model:
    the wind at 20 ft sets it near the ground, the severity (0 none, 3 moderate, 7 extreme, its
    probability of exceedance index) above 2,000 ft.
    """

    wind_north_m_s: float = 0.0
    wind_east_m_s: float = 0.0
    turbulence_wind_at_20ft_m_s: float = 0.0
    turbulence_severity: int = 0
