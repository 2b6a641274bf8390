"""ADS-B transponders: what they squitter, how often, and with which errors (RTCA DO-260B)."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from airhilt.geodesy.relative_motion import Kinematics, horizontal_distance_m
from airhilt.geodesy.wgs84 import displaced
from airhilt.messages import EmergencyState, EmitterCategory
from airhilt.surveillance import cpr
from airhilt.surveillance.squitters import (
    ALTITUDE_STEP_FT,
    NACP_95_PERCENT_M,
    NACV_95_PERCENT_M_S,
    SPEED_STEP_KT,
    SURFACE_TRACK_STEP_DEG,
    VERTICAL_RATE_STEP_FPM,
    IdentificationSquitter,
    PositionSquitter,
    SurfacePositionSquitter,
    VelocitySquitter,
    movement_kt,
    quantise,
)
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS, bearing_degrees

POSITION_INTERVAL_S = (0.4, 0.6)
"""Interval of position squitters, airborne or moving on the surface, in s (DO-260B, 2.2.3.3).

This interval and the next ones are drawn uniformly.
"""
STATIONARY_POSITION_INTERVAL_S = (4.8, 5.2)
"""Interval of surface position squitters at a standstill, in s (DO-260B, 2.2.3.3)."""
VELOCITY_INTERVAL_S = (0.4, 0.6)
"""Interval of airborne velocity squitters, in s (DO-260B, 2.2.3.3).

The surface format has the speed in its position squitter.
"""
IDENTIFICATION_INTERVAL_S = (4.8, 5.2)
"""Interval of identification squitters, airborne or moving on the surface, in s (2.2.3.3)."""
STATIONARY_IDENTIFICATION_INTERVAL_S = (9.8, 10.2)
"""Interval of identification squitters at a standstill on the surface, in s (2.2.3.3)."""
STATIONARY_WITHIN_M = 10.0
"""Movement up to which a carrier on the surface counts as standing, in m (as below)."""
STATIONARY_AFTER_NS = 30 * SECOND_NS
"""Time without such a movement after which the low squitter rates apply, in ns (DO-260B, 2.2.3.3;
ICAO Doc 9871, table A-2-7)."""

SIGMA_PER_95_PERCENT = 1.0 / 2.4477
"""Standard deviation of each axis of a circular normal error, for a 95 % radius of 1: the radius is
sqrt(-2 ln 0.05) standard deviations."""
POSITION_CORRELATION_S = 60.0
"""Time constant of the position error, in s.

The error is a first-order Gauss-Markov process, as errors of satellite navigation are. The value is
an estimate: DO-260B gives none.
"""
GENERAL_EMERGENCY = "7700"
"""Mode A code of an emergency (ICAO Annex 10, volume IV, 2.1.4.2.2)."""
EMERGENCY_CODES: dict[str, EmergencyState] = {
    "7500": "unlawful_interference",
    "7600": "no_communications",
    GENERAL_EMERGENCY: "general",
}
"""Emergency or priority status that a transponder sends with a Mode A code (DO-260B,
2.2.3.2.7.8.1.1)."""
STANDING_BELOW_M_S = 0.05
"""Speed below which a navigation unit reports a standstill, in m/s."""


class Carrier(Kinematics, Protocol):
    """The state of whatever carries a transponder."""

    @property
    def velocity_down_m_s(self) -> float: ...  # noqa: D102
    @property
    def heading_rad(self) -> float: ...  # noqa: D102


class SurfaceRate:
    """Decides which squitter rate applies on the surface.

    It looks at the true position: a navigation receiver at rest keeps its position far better than
    its accuracy category has to promise.
    """

    def __init__(self) -> None:
        self._anchor: Kinematics | None = None
        self._since_ns = 0

    def is_stationary(self, state: Kinematics, t_ns: int) -> bool:
        """Return whether the low rate applies; call it at least once a second."""
        anchor = self._anchor
        if anchor is None or horizontal_distance_m(anchor, state) > STATIONARY_WITHIN_M:
            self._anchor, self._since_ns = state, t_ns
        return t_ns - self._since_ns >= STATIONARY_AFTER_NS


class Transponder:
    """Encodes position and velocity with the errors of the carrier's navigation.

    The errors are drawn from its generator, by the accuracy categories NACp and NACv.

    Attributes
    ----------
    squawk, emergency
        What it sends now, apart from position and velocity; squawk None: it has no Mode A code.
    """

    def __init__(
        self,
        icao24: str,
        callsign: str,
        nacp: int,
        nacv: int,
        generator: np.random.Generator,
        category: EmitterCategory = "A0",
        nic: int = 8,
        sil: int = 3,
    ) -> None:
        self.icao24 = icao24
        self.callsign = callsign
        self.category = category
        self.nacp = nacp
        self.nacv = nacv
        self.nic = nic
        self.sil = sil
        self.squawk: str | None = None
        self.emergency: EmergencyState = "none"
        self.generator = generator
        self._sigma_m = NACP_95_PERCENT_M[nacp] * SIGMA_PER_95_PERCENT
        self._sigma_m_s = NACV_95_PERCENT_M_S[nacv] * SIGMA_PER_95_PERCENT
        self._error_north_m = generator.normal(0.0, self._sigma_m)
        self._error_east_m = generator.normal(0.0, self._sigma_m)
        self._error_at_ns = 0
        self._odd = False

    def position(self, state: Carrier, t_ns: int) -> PositionSquitter:
        """Return the next airborne position squitter; even and odd formats alternate."""
        return PositionSquitter(
            self._encoded(state, t_ns, surface=False),
            quantise(state.altitude_m / FOOT, ALTITUDE_STEP_FT),
        )

    def surface_position(self, state: Carrier, t_ns: int) -> SurfacePositionSquitter:
        """Return the next surface position squitter; even and odd formats alternate.

        A standstill is reported as such, however inaccurate the velocity is.
        """
        position = self._encoded(state, t_ns, surface=True)
        speed_m_s = math.hypot(state.velocity_north_m_s, state.velocity_east_m_s)
        error_m_s = self.generator.standard_normal() * self._sigma_m_s
        heard_m_s = max(speed_m_s + error_m_s, 0.0) if speed_m_s > STANDING_BELOW_M_S else 0.0
        track_deg = quantise(bearing_degrees(state.heading_rad), SURFACE_TRACK_STEP_DEG) % 360.0
        return SurfacePositionSquitter(
            position, VelocitySquitter(movement_kt(heard_m_s / KNOT), track_deg, 0.0)
        )

    def identification(self) -> IdentificationSquitter:
        """Return the identification squitter."""
        return IdentificationSquitter(self.callsign, self.category)

    def velocity(self, state: Carrier) -> VelocitySquitter:
        """Return the next airborne velocity squitter."""
        error = self.generator.standard_normal
        north_m_s = state.velocity_north_m_s + error() * self._sigma_m_s
        east_m_s = state.velocity_east_m_s + error() * self._sigma_m_s
        north = quantise(north_m_s / KNOT, SPEED_STEP_KT)
        east = quantise(east_m_s / KNOT, SPEED_STEP_KT)
        return VelocitySquitter(
            math.hypot(north, east),
            bearing_degrees(math.atan2(east, north)),
            quantise(-state.velocity_down_m_s / FOOT_PER_MINUTE, VERTICAL_RATE_STEP_FPM),
        )

    def _encoded(self, state: Carrier, t_ns: int, surface: bool) -> cpr.CprPosition:
        north_m, east_m = self._position_error(t_ns)
        place = (state.latitude_rad, state.longitude_rad)
        latitude, longitude = displaced(place, north_m, east_m, state.altitude_m)
        odd, self._odd = self._odd, not self._odd
        return cpr.encode(latitude / DEGREE, longitude / DEGREE, odd, surface)

    def _position_error(self, t_ns: int) -> tuple[float, float]:
        memory = math.exp(-(t_ns - self._error_at_ns) / SECOND_NS / POSITION_CORRELATION_S)
        fresh = self._sigma_m * math.sqrt(1.0 - memory * memory)
        draw = self.generator.standard_normal
        self._error_north_m = memory * self._error_north_m + fresh * draw()
        self._error_east_m = memory * self._error_east_m + fresh * draw()
        self._error_at_ns = t_ns
        return self._error_north_m, self._error_east_m
