"""Compact position reporting of ADS-B positions (RTCA DO-260B, appendix A.1.7).

Latitude and longitude in degrees, as the standard writes them. 17 bits give steps of about 5 m in
the airborne format. In the surface format the zones, and so the steps, are a quarter of that, and
a position is known only to within a multiple of 90 degrees.
"""

from __future__ import annotations

import math
from typing import NamedTuple

BITS = 2**17
LATITUDE_ZONES = 15
"""Number of latitude zones between the equator and a pole, NZ in the standard."""
_ZONE_TERM = 1.0 - math.cos(math.pi / (2 * LATITUDE_ZONES))
"""Numerator of the standard's formula for NL."""


class CprPosition(NamedTuple):
    """An encoded position: 17 bits for latitude and longitude each, in the even or odd format."""

    latitude: int
    longitude: int
    odd: bool
    surface: bool = False


def _span_deg(surface: bool) -> float:
    """Return the angle that the zones of a format divide, in degrees."""
    return 90.0 if surface else 360.0


def longitude_zones(latitude_deg: float) -> int:
    """Return the number of longitude zones at a latitude, NL in the standard (A.1.7.2 d)."""
    if abs(latitude_deg) >= 87.0:
        return 1 if abs(latitude_deg) > 87.0 else 2
    b = math.cos(math.radians(abs(latitude_deg))) ** 2
    return math.floor(2.0 * math.pi / math.acos(1.0 - _ZONE_TERM / b))


def _latitude_zone_deg(odd: bool, span_deg: float) -> float:
    """Return the size of a latitude zone in degrees."""
    return span_deg / (4 * LATITUDE_ZONES - int(odd))


def _longitude_zone_deg(latitude_deg: float, odd: bool, span_deg: float) -> float:
    """Return the size of a longitude zone at a latitude in degrees."""
    return span_deg / max(longitude_zones(latitude_deg) - int(odd), 1)


def encode(
    latitude_deg: float, longitude_deg: float, odd: bool, surface: bool = False
) -> CprPosition:
    """Return a position encoded in one of the formats (A.1.7.3).

    The surface format has 19 bits and sends the lower 17. That is the same as 17 bits of zones a
    quarter the size.
    """
    span_deg = _span_deg(surface)
    d_lat = _latitude_zone_deg(odd, span_deg)
    zone = math.floor(latitude_deg / d_lat)
    yz = math.floor(BITS * (latitude_deg / d_lat - zone) + 0.5)
    rounded_lat = d_lat * (yz / BITS + zone)
    d_lon = _longitude_zone_deg(rounded_lat, odd, span_deg)
    xz = math.floor(BITS * (longitude_deg % d_lon) / d_lon + 0.5)
    return CprPosition(yz % BITS, xz % BITS, odd, surface)


def decode_local(position: CprPosition, reference: tuple[float, float]) -> tuple[float, float]:
    """Return latitude and longitude in degrees, decoded with a reference position.

    The reference must lie within 180 NM of the position, in the surface format within 45 NM
    (A.1.7).
    """
    span_deg, odd = _span_deg(position.surface), position.odd
    d_lat = _latitude_zone_deg(odd, span_deg)
    latitude = _near(position.latitude / BITS, d_lat, reference[0])
    d_lon = _longitude_zone_deg(latitude, odd, span_deg)
    return latitude, _wrap(_near(position.longitude / BITS, d_lon, reference[1]))


def _near(fraction: float, zone: float, reference: float) -> float:
    """Return the angle at a fraction of a zone, in the zone that puts it nearest to a reference."""
    return zone * (math.floor(0.5 + reference / zone - fraction) + fraction)


def decode_global(
    even: CprPosition,
    odd: CprPosition,
    newest_is_odd: bool,
    receiver: tuple[float, float] = (0.0, 0.0),
) -> tuple[float, float] | None:
    """Return latitude and longitude in degrees, decoded from a pair of one format.

    The surface format has eight solutions; the one nearest to the receiver is returned. None means
    that the two positions lie on different sides of a change of NL, and that another pair is needed
    (A.1.7.7, A.1.7.8).
    """
    span_deg = _span_deg(even.surface)
    j = math.floor((59 * even.latitude - 60 * odd.latitude) / BITS + 0.5)
    lat_even, lat_odd = (
        _solution(span_deg / count * (j % count + position.latitude / BITS), span_deg, receiver[0])
        for count, position in ((60, even), (59, odd))
    )
    zones = longitude_zones(lat_even)
    if zones != longitude_zones(lat_odd):
        return None
    latitude, newest = (lat_odd, odd) if newest_is_odd else (lat_even, even)
    if abs(latitude) > 90.0:
        return None
    count = max(zones - int(newest_is_odd), 1)
    m = math.floor((even.longitude * (zones - 1) - odd.longitude * zones) / BITS + 0.5)
    longitude = span_deg / count * (m % count + newest.longitude / BITS)
    return latitude, _wrap(_solution(longitude, span_deg, receiver[1]))


def _solution(angle_deg: float, span_deg: float, reference_deg: float) -> float:
    """Return the angle nearest to a reference among those that differ by multiples of a span."""
    return angle_deg + span_deg * round((reference_deg - angle_deg) / span_deg)


def _wrap(longitude_deg: float) -> float:
    return (longitude_deg + 180.0) % 360.0 - 180.0
