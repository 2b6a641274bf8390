"""ADS-B: transponders squitter, receivers hear some of it and give out reports (RTCA DO-260B)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np

from airhilt.messages import AdsbReport
from airhilt.surveillance import cpr
from airhilt.surveillance.kinematics import (
    WGS84_SEMI_MAJOR_M,
    Kinematics,
    curvature_radii_m,
    relative,
)
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS, bearing_degrees

POSITION_INTERVAL_S = (0.4, 0.6)
"""Airborne position squitters come uniformly within this (DO-260B, 2.2.3.3)."""
VELOCITY_INTERVAL_S = (0.4, 0.6)
"""Airborne velocity squitters (DO-260B, 2.2.3.3)."""
IDENTIFICATION_INTERVAL_S = (4.8, 5.2)
"""Aircraft identification squitters, airborne (DO-260B, 2.2.3.3)."""
ALTITUDE_STEP_FT = 25.0
SPEED_STEP_KT = 1.0
VERTICAL_RATE_STEP_FPM = 64.0
GLOBAL_PAIR_NS = 10 * SECOND_NS
"""An even and an odd position no further apart than this may be decoded together (A.1.7.7)."""
REFERENCE_AGE_NS = 60 * SECOND_NS
"""An older position is no reference for local decoding; a pair is needed again. No aircraft comes
near the limit of 180 NM in it."""

NACP_95_PERCENT_M = (
    37_040.0, 18_520.0, 7_408.0, 3_704.0, 1_852.0, 926.0, 555.6, 185.2, 92.6, 30.0, 10.0, 3.0,
)  # fmt: skip
"""95 % horizontal position error by NACp (DO-260B); 0, unknown, as twice that of 1."""
NACV_95_PERCENT_M_S = (20.0, 10.0, 3.0, 1.0, 0.3)
"""95 % horizontal velocity error by NACv (DO-260B); 0, unknown, as twice that of 1."""
SIGMA_PER_95_PERCENT = 1.0 / 2.4477
"""Standard deviation an axis for a 95 % radius, sqrt(-2 ln 0.05), of a circular normal error."""
POSITION_CORRELATION_S = 60.0
"""Time constant of the position error, a first-order Gauss-Markov process as satellite
navigation errors are; DO-260B gives no value."""
EFFECTIVE_EARTH_RADIUS = 4.0 / 3.0
"""Factor for the radio horizon in a standard atmosphere (ITU-R P.310)."""


class FlownState(Kinematics, Protocol):
    """What a transponder needs of its aircraft."""

    @property
    def velocity_down_m_s(self) -> float: ...  # noqa: D102


class PositionSquitter(NamedTuple):
    """Airborne position."""

    position: cpr.CprPosition
    altitude_ft: float


class VelocitySquitter(NamedTuple):
    """Airborne velocity over ground."""

    ground_speed_kt: float
    track_deg: float
    vertical_rate_fpm: float


class IdentificationSquitter(NamedTuple):
    """Callsign."""

    callsign: str


Squitter = PositionSquitter | VelocitySquitter | IdentificationSquitter


def quantise(value: float, step: float) -> float:
    """Return ``value`` rounded to a multiple of ``step``."""
    return step * math.floor(value / step + 0.5)


class Transponder:
    """Encodes what its aircraft's navigation says, errors included."""

    def __init__(
        self, icao24: str, callsign: str, nacp: int, nacv: int, generator: np.random.Generator
    ) -> None:
        self.icao24 = icao24
        self.callsign = callsign
        self.nacp = nacp
        self.nacv = nacv
        self.generator = generator
        self._sigma_m = NACP_95_PERCENT_M[nacp] * SIGMA_PER_95_PERCENT
        self._sigma_m_s = NACV_95_PERCENT_M_S[nacv] * SIGMA_PER_95_PERCENT
        self._error_north_m = generator.normal(0.0, self._sigma_m)
        self._error_east_m = generator.normal(0.0, self._sigma_m)
        self._error_at_ns = 0
        self._odd = False

    def position(self, state: FlownState, t_ns: int) -> PositionSquitter:
        """Return the next position squitter; even and odd take turns."""
        north_m, east_m = self._position_error(t_ns)
        meridional, prime_vertical = curvature_radii_m(state.latitude_rad)
        latitude = state.latitude_rad + north_m / (meridional + state.altitude_m)
        longitude = state.longitude_rad + east_m / (
            (prime_vertical + state.altitude_m) * math.cos(state.latitude_rad)
        )
        encoded = cpr.encode(latitude / DEGREE, longitude / DEGREE, self._odd)
        self._odd = not self._odd
        return PositionSquitter(encoded, quantise(state.altitude_m / FOOT, ALTITUDE_STEP_FT))

    def velocity(self, state: FlownState) -> VelocitySquitter:
        """Return the next velocity squitter."""
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

    def _position_error(self, t_ns: int) -> tuple[float, float]:
        memory = math.exp(-(t_ns - self._error_at_ns) / SECOND_NS / POSITION_CORRELATION_S)
        fresh = self._sigma_m * math.sqrt(1.0 - memory * memory)
        draw = self.generator.standard_normal
        self._error_north_m = memory * self._error_north_m + fresh * draw()
        self._error_east_m = memory * self._error_east_m + fresh * draw()
        self._error_at_ns = t_ns
        return self._error_north_m, self._error_east_m


class Decoded(NamedTuple):
    """A state vector inside a receiver."""

    sender: Transponder
    callsign: str | None
    position_deg: tuple[float, float]
    altitude_ft: float
    velocity: VelocitySquitter
    receiver: str
    t_in_ns: int

    def report(self, t_out_ns: int) -> AdsbReport:
        """Return it as it leaves the receiver."""
        return AdsbReport(
            t_ns=t_out_ns,
            icao24=self.sender.icao24,
            callsign=self.callsign,
            latitude_deg=self.position_deg[0],
            longitude_deg=self.position_deg[1],
            altitude_ft=self.altitude_ft,
            ground_speed_kt=self.velocity.ground_speed_kt,
            track_deg=self.velocity.track_deg,
            vertical_rate_fpm=self.velocity.vertical_rate_fpm,
            nacp=self.sender.nacp,
            nacv=self.sender.nacv,
            receiver=self.receiver,
            t_adsb_in_ns=self.t_in_ns,
            t_adsb_out_ns=t_out_ns,
        )


@dataclass
class _Heard:
    """What a receiver has of one aircraft so far."""

    callsign: str | None = None
    velocity: VelocitySquitter | None = None
    even: tuple[int, cpr.CprPosition] | None = None
    odd: tuple[int, cpr.CprPosition] | None = None
    position_deg: tuple[float, float] | None = None
    position_ns: int = 0


@dataclass
class Receiver:
    """Decodes squitters into reports.

    A report needs a velocity and a decoded position: the first position takes an even and an odd
    squitter, later ones are decoded from the last.
    """

    name: str
    site: Kinematics
    range_m: float
    _heard: dict[str, _Heard] = field(default_factory=dict)

    def in_view(self, state: Kinematics) -> bool:
        """Return whether an aircraft is above the radio horizon and in range."""
        distance = relative(self.site, state).distance_m
        return distance <= min(self.range_m, self._horizon_m(state.altitude_m))

    def _horizon_m(self, altitude_m: float) -> float:
        radius = EFFECTIVE_EARTH_RADIUS * WGS84_SEMI_MAJOR_M
        heights = (max(altitude_m, 0.0), max(self.site.altitude_m, 0.0))
        return sum(math.sqrt(2.0 * radius * height) for height in heights)

    def decode(self, sender: Transponder, squitter: Squitter, t_in_ns: int) -> Decoded | None:
        """Take in a squitter; return a state vector if it completes one."""
        heard = self._heard.setdefault(sender.icao24, _Heard())
        match squitter:
            case IdentificationSquitter():
                heard.callsign = squitter.callsign
                return None
            case VelocitySquitter():
                heard.velocity = squitter
                return None
        self._decode_position(heard, squitter.position, t_in_ns)
        if heard.position_deg is None or heard.velocity is None:
            return None
        return Decoded(
            sender, heard.callsign, heard.position_deg, squitter.altitude_ft, heard.velocity,
            self.name, t_in_ns,
        )  # fmt: skip

    @staticmethod
    def _decode_position(heard: _Heard, position: cpr.CprPosition, t_in_ns: int) -> None:
        if position.odd:
            heard.odd = (t_in_ns, position)
        else:
            heard.even = (t_in_ns, position)
        if heard.position_deg is not None and t_in_ns - heard.position_ns <= REFERENCE_AGE_NS:
            heard.position_deg = cpr.decode_local(position, heard.position_deg)
            heard.position_ns = t_in_ns
            return
        heard.position_deg = None
        if (
            heard.even is not None
            and heard.odd is not None
            and abs(heard.even[0] - heard.odd[0]) <= GLOBAL_PAIR_NS
        ):
            heard.position_deg = cpr.decode_global(heard.even[1], heard.odd[1], position.odd)
            heard.position_ns = t_in_ns


class Reception:
    """What the receivers together hear: losses, outages, range, and who hears it first."""

    def __init__(
        self,
        receivers: Sequence[Receiver],
        loss_probability: float,
        outages_ns: Sequence[tuple[int, int]],
    ) -> None:
        self._receivers = receivers
        self._loss_probability = loss_probability
        self._outages_ns = outages_ns

    def receive(
        self,
        sender: Transponder,
        squitter: Squitter,
        state: Kinematics,
        t_ns: int,
    ) -> Decoded | None:
        """Return the state vector that the first receiver to hear the squitter completes.

        The draws do not depend on what is heard, so an outage changes nothing after it.
        """
        lost = sender.generator.random() < self._loss_probability
        if lost or any(begin <= t_ns < end for begin, end in self._outages_ns):
            return None
        for receiver in self._receivers:
            if receiver.in_view(state):
                return receiver.decode(sender, squitter, t_ns)
        return None
