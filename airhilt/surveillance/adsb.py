"""ADS-B: transponders squitter, receivers hear some of it and give out reports (RTCA DO-260B)."""

from __future__ import annotations

import bisect
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np

from airhilt.geodesy.relative_motion import Kinematics, relative
from airhilt.geodesy.wgs84 import SEMI_MAJOR_AXIS_M, displaced
from airhilt.messages import AdsbReport, EmitterCategory
from airhilt.surveillance import cpr
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS, bearing_degrees

POSITION_INTERVAL_S = (0.4, 0.6)
"""Position squitters come uniformly within this, airborne or moving on the surface (DO-260B,
2.2.3.3)."""
STATIONARY_POSITION_INTERVAL_S = (4.8, 5.2)
"""Surface position squitters of who stands (DO-260B, 2.2.3.3)."""
VELOCITY_INTERVAL_S = (0.4, 0.6)
"""Airborne velocity squitters; the surface format says the speed itself (DO-260B, 2.2.3.3)."""
IDENTIFICATION_INTERVAL_S = (4.8, 5.2)
"""Identification squitters, airborne or moving on the surface (DO-260B, 2.2.3.3)."""
STATIONARY_IDENTIFICATION_INTERVAL_S = (9.8, 10.2)
"""Identification squitters of who stands on the surface (DO-260B, 2.2.3.3)."""
STATIONARY_WITHIN_M = 10.0
STATIONARY_AFTER_NS = 30 * SECOND_NS
"""Who has not changed position by more than 10 m in 30 s squitters at the low rate until it has
(DO-260B, 2.2.3.3; ICAO Doc 9871, table A-2-7)."""
ALTITUDE_STEP_FT = 25.0
SPEED_STEP_KT = 1.0
VERTICAL_RATE_STEP_FPM = 64.0
SURFACE_TRACK_STEP_DEG = 360.0 / 128.0
MOVEMENT_STEPS_KT = (
    (0.0, 1, 0.125), (0.125, 6, 0.875 / 6), (1.0, 4, 0.25), (2.0, 26, 0.5), (15.0, 55, 1.0),
    (70.0, 15, 2.0), (100.0, 15, 5.0),
)  # fmt: skip
"""The surface format's movement field (DO-260B, 2.2.3.2.4.2): above which speed how many steps
of which size follow. The first code is that of a standstill, the last of more than 175 kt."""
GLOBAL_PAIR_NS = 10 * SECOND_NS
"""An even and an odd airborne position no further apart may be decoded together (A.1.7.7)."""
SURFACE_PAIR_NS = 25 * SECOND_NS
"""Likewise on the surface; 50 s up to 25 kt, which nobody here needs (A.1.7.8)."""
REFERENCE_AGE_NS = 60 * SECOND_NS
"""An older position is no reference for local decoding; a pair is needed again. No aircraft comes
near the limit of 180 NM in it, and none on the surface near 45 NM."""

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
STANDING_BELOW_M_S = 0.05
"""Less is a standstill to a navigation unit."""
LEAST_ANTENNA_HEIGHT_M = 2.0
"""Of a transponder's antenna above the ground, on the roof of a vehicle."""


def radio_horizon_m(*heights_m: float) -> float:
    """Return how far apart two antennas at these heights may be and still be in line of sight.

    With heights in feet this is 1.23 nautical miles times the sum of their square roots.
    """
    radius = EFFECTIVE_EARTH_RADIUS * SEMI_MAJOR_AXIS_M
    return sum(math.sqrt(2.0 * radius * height) for height in heights_m)


class Carrier(Kinematics, Protocol):
    """What a transponder needs of what carries it."""

    @property
    def velocity_down_m_s(self) -> float: ...  # noqa: D102
    @property
    def heading_rad(self) -> float: ...  # noqa: D102


class PositionSquitter(NamedTuple):
    """Airborne position."""

    position: cpr.CprPosition
    altitude_ft: float


class VelocitySquitter(NamedTuple):
    """Airborne velocity over ground."""

    ground_speed_kt: float
    track_deg: float
    vertical_rate_fpm: float


class SurfacePositionSquitter(NamedTuple):
    """Surface position, with movement and heading."""

    position: cpr.CprPosition
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
"""Of each code from 2 to 123: the speed above which it is sent, and the middle of its step."""
FASTEST_MOVEMENT_KT = 175.0


def movement_kt(speed_kt: float) -> float:
    """Return a speed as the movement field gives it: the middle of its step.

    0 for a standstill, 175 kt for all above.
    """
    if speed_kt > FASTEST_MOVEMENT_KT:
        return FASTEST_MOVEMENT_KT
    code = bisect.bisect_left(_MOVEMENTS_KT, (speed_kt,))
    return _MOVEMENTS_KT[code - 1][1] if code else 0.0


class SurfaceRate:
    """Tells who moves on the surface from who stands, by the rule for squitter rates.

    It goes by where the carrier really is: a receiver at rest keeps its position far better than
    its accuracy category has to promise.
    """

    def __init__(self) -> None:
        self._anchor: Kinematics | None = None
        self._since_ns = 0

    def is_stationary(self, state: Kinematics, t_ns: int) -> bool:
        """Return whether the low rate applies; call it at least every second."""
        anchor = self._anchor
        if anchor is None or relative(anchor, state).distance_m > STATIONARY_WITHIN_M:
            self._anchor, self._since_ns = state, t_ns
        return t_ns - self._since_ns >= STATIONARY_AFTER_NS


class Transponder:
    """Encodes what its carrier's navigation says, errors included."""

    def __init__(
        self,
        icao24: str,
        callsign: str,
        nacp: int,
        nacv: int,
        generator: np.random.Generator,
        category: EmitterCategory = "A0",
    ) -> None:
        self.icao24 = icao24
        self.callsign = callsign
        self.category = category
        self.nacp = nacp
        self.nacv = nacv
        self.generator = generator
        self._sigma_m = NACP_95_PERCENT_M[nacp] * SIGMA_PER_95_PERCENT
        self._sigma_m_s = NACV_95_PERCENT_M_S[nacv] * SIGMA_PER_95_PERCENT
        self._error_north_m = generator.normal(0.0, self._sigma_m)
        self._error_east_m = generator.normal(0.0, self._sigma_m)
        self._error_at_ns = 0
        self._odd = False

    def position(self, state: Carrier, t_ns: int) -> PositionSquitter:
        """Return the next airborne position squitter; even and odd take turns."""
        return PositionSquitter(
            self._encoded(state, t_ns, surface=False),
            quantise(state.altitude_m / FOOT, ALTITUDE_STEP_FT),
        )

    def surface_position(self, state: Carrier, t_ns: int) -> SurfacePositionSquitter:
        """Return the next surface position squitter; even and odd take turns.

        Who stands knows that it does, however inaccurate its velocity.
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

    def _encoded(self, state: Carrier, t_ns: int, surface: bool) -> cpr.CprPosition:
        north_m, east_m = self._position_error(t_ns)
        place = (state.latitude_rad, state.longitude_rad)
        latitude, longitude = displaced(place, north_m, east_m, state.altitude_m)
        odd, self._odd = self._odd, not self._odd
        return cpr.encode(latitude / DEGREE, longitude / DEGREE, odd, surface)

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
    identification: IdentificationSquitter | None
    position_deg: tuple[float, float]
    altitude_ft: float | None
    """None in the surface format."""
    velocity: VelocitySquitter
    receiver: str
    t_in_ns: int

    def report(self, t_out_ns: int) -> AdsbReport:
        """Return it as it leaves the receiver."""
        named = self.identification
        return AdsbReport(
            t_ns=t_out_ns,
            icao24=self.sender.icao24,
            callsign=named.callsign if named else None,
            emitter_category=named.category if named else None,
            latitude_deg=self.position_deg[0],
            longitude_deg=self.position_deg[1],
            altitude_ft=self.altitude_ft,
            on_ground=self.altitude_ft is None,
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
    """What a receiver has of one sender so far."""

    identification: IdentificationSquitter | None = None
    velocity: VelocitySquitter | None = None
    even: tuple[int, cpr.CprPosition] | None = None
    odd: tuple[int, cpr.CprPosition] | None = None
    position_deg: tuple[float, float] | None = None
    position_ns: int = 0


@dataclass
class Receiver:
    """Decodes squitters into reports.

    A report needs a velocity, which the surface format brings along, and a decoded position: the
    first position takes an even and an odd squitter of one format, later ones are decoded from
    the last. Heights for the radio horizon are those above ``ground_m``.
    """

    name: str
    site: Kinematics
    range_m: float
    ground_m: float = 0.0
    _heard: dict[str, _Heard] = field(default_factory=dict)

    def in_view(self, state: Kinematics) -> bool:
        """Return whether a sender is above the radio horizon and in range."""
        distance = relative(self.site, state).distance_m
        return distance <= min(self.range_m, self._horizon_m(state.altitude_m))

    def _horizon_m(self, altitude_m: float) -> float:
        return radio_horizon_m(
            max(altitude_m - self.ground_m, LEAST_ANTENNA_HEIGHT_M),
            max(self.site.altitude_m - self.ground_m, 0.0),
        )

    def decode(self, sender: Transponder, squitter: Squitter, t_in_ns: int) -> Decoded | None:
        """Take in a squitter; return a state vector if it completes one."""
        heard = self._heard.setdefault(sender.icao24, _Heard())
        match squitter:
            case IdentificationSquitter():
                heard.identification = squitter
                return None
            case VelocitySquitter():
                heard.velocity = squitter
                return None
            case SurfacePositionSquitter():
                heard.velocity = squitter.movement
        self._decode_position(heard, squitter.position, t_in_ns)
        if heard.position_deg is None or heard.velocity is None:
            return None
        return Decoded(
            sender, heard.identification, heard.position_deg, squitter.altitude_ft,
            heard.velocity, self.name, t_in_ns,
        )  # fmt: skip

    def _decode_position(self, heard: _Heard, position: cpr.CprPosition, t_in_ns: int) -> None:
        if position.odd:
            heard.odd = (t_in_ns, position)
        else:
            heard.even = (t_in_ns, position)
        if heard.position_deg is not None and t_in_ns - heard.position_ns <= REFERENCE_AGE_NS:
            heard.position_deg = cpr.decode_local(position, heard.position_deg)
            heard.position_ns = t_in_ns
            return
        heard.position_deg = None
        if heard.even is None or heard.odd is None:
            return
        (even_ns, even), (odd_ns, odd) = heard.even, heard.odd
        apart_ns = SURFACE_PAIR_NS if position.surface else GLOBAL_PAIR_NS
        if even.surface == odd.surface and abs(even_ns - odd_ns) <= apart_ns:
            site = (self.site.latitude_rad / DEGREE, self.site.longitude_rad / DEGREE)
            heard.position_deg = cpr.decode_global(even, odd, position.odd, site)
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
