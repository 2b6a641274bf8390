"""ADS-B receivers: they decode the squitters that reach them into reports (RTCA DO-260B)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from airhilt.geodesy.relative_motion import Kinematics, horizontal_distance_m
from airhilt.messages import AdsbReport, EmergencyState
from airhilt.surveillance import cpr
from airhilt.surveillance.horizon import LEAST_ANTENNA_HEIGHT_M, radio_horizon_m
from airhilt.surveillance.squitters import (
    IdentificationSquitter,
    Squitter,
    SurfacePositionSquitter,
    VelocitySquitter,
)
from airhilt.surveillance.transponders import Transponder
from airhilt.units import DEGREE, SECOND_NS

GLOBAL_PAIR_NS = 10 * SECOND_NS
"""Longest time between an even and an odd airborne position decoded together, in ns (A.1.7.7)."""
SURFACE_PAIR_NS = 25 * SECOND_NS
"""Longest time between an even and an odd surface position decoded together, in ns (A.1.7.8).

The standard allows 50 s up to 25 kt; nothing here needs that.
"""
REFERENCE_AGE_NS = 60 * SECOND_NS
"""Age after which a position is no reference for local decoding any more, in ns.

A pair is needed again then. In that time no aircraft comes near the limit of 180 NM, and nothing on
the surface comes near the limit of 45 NM.
"""


class Decoded(NamedTuple):
    """A state vector inside a receiver."""

    sender: Transponder
    identification: IdentificationSquitter | None
    position_deg: tuple[float, float]
    altitude_ft: float | None
    """Pressure altitude in ft; None in the surface format."""
    velocity: VelocitySquitter
    squawk: str | None
    emergency: EmergencyState
    receiver: str
    t_in_ns: int

    def report(self, t_out_ns: int) -> AdsbReport:
        """Return the report that leaves the receiver at a time."""
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
            squawk=self.squawk,
            emergency=self.emergency,
            nic=self.sender.nic,
            sil=self.sender.sil,
            nacp=self.sender.nacp,
            nacv=self.sender.nacv,
            receiver=self.receiver,
            t_adsb_in_ns=self.t_in_ns,
            t_adsb_out_ns=t_out_ns,
        )


@dataclass
class _Heard:
    """Data that a receiver has of one sender so far."""

    identification: IdentificationSquitter | None = None
    velocity: VelocitySquitter | None = None
    even: tuple[int, cpr.CprPosition] | None = None
    odd: tuple[int, cpr.CprPosition] | None = None
    position_deg: tuple[float, float] | None = None
    position_ns: int = 0


@dataclass
class Receiver:
    """Decodes squitters into reports.

    A report needs a velocity, which the surface format brings along, and a decoded position. The
    first position takes an even and an odd squitter of one format, later ones are decoded from the
    one before. Heights for the radio horizon count above ``ground_m``.
    """

    name: str
    site: Kinematics
    range_m: float
    ground_m: float = 0.0
    _heard: dict[str, _Heard] = field(default_factory=dict)

    def in_view(self, state: Kinematics) -> bool:
        """Return whether a sender is above the radio horizon and in range."""
        distance = horizontal_distance_m(self.site, state)
        return distance <= min(self.range_m, self._horizon_m(state.altitude_m))

    def _horizon_m(self, altitude_m: float) -> float:
        return radio_horizon_m(
            max(altitude_m - self.ground_m, LEAST_ANTENNA_HEIGHT_M),
            max(self.site.altitude_m - self.ground_m, 0.0),
        )

    def decode(self, sender: Transponder, squitter: Squitter, t_in_ns: int) -> Decoded | None:
        """Decode a squitter; return a state vector if it completes one."""
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
            heard.velocity, sender.squawk, sender.emergency, self.name, t_in_ns,
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
