"""Compact position reporting of airborne ADS-B positions (RTCA DO-260B, appendix A.1.7).

Latitude and longitude in degrees, as the standard writes them. 17 bits give steps of about 5 m.
"""

from __future__ import annotations

import math
from typing import NamedTuple

BITS = 2**17
LATITUDE_ZONES = 15
"""NZ, the number of latitude zones between the equator and a pole."""


class CprPosition(NamedTuple):
    """An encoded position: 17 bits each, in the even or the odd format."""

    latitude: int
    longitude: int
    odd: bool


def longitude_zones(latitude_deg: float) -> int:
    """Return NL, how many longitude zones there are at a latitude (A.1.7.2 d)."""
    if abs(latitude_deg) >= 87.0:
        return 1 if abs(latitude_deg) > 87.0 else 2
    a = 1.0 - math.cos(math.pi / (2 * LATITUDE_ZONES))
    b = math.cos(math.radians(abs(latitude_deg))) ** 2
    return math.floor(2.0 * math.pi / math.acos(1.0 - a / b))


def _zone_sizes(latitude_deg: float, odd: bool) -> tuple[float, float]:
    """Return the size in degrees of a latitude zone, and of a longitude zone at a latitude."""
    zones = max(longitude_zones(latitude_deg) - int(odd), 1)
    return 360.0 / (4 * LATITUDE_ZONES - int(odd)), 360.0 / zones


def encode(latitude_deg: float, longitude_deg: float, odd: bool) -> CprPosition:
    """Encode a position (A.1.7.3)."""
    d_lat, _ = _zone_sizes(latitude_deg, odd)
    zone = math.floor(latitude_deg / d_lat)
    yz = math.floor(BITS * (latitude_deg / d_lat - zone) + 0.5)
    rounded_lat = d_lat * (yz / BITS + zone)
    _, d_lon = _zone_sizes(rounded_lat, odd)
    xz = math.floor(BITS * (longitude_deg % d_lon) / d_lon + 0.5)
    return CprPosition(yz % BITS, xz % BITS, odd)


def decode_local(position: CprPosition, reference: tuple[float, float]) -> tuple[float, float]:
    """Decode with a reference position within 180 NM (A.1.7); latitude, longitude in degrees."""
    latitude = _near(position.latitude / BITS, _zone_sizes(0.0, position.odd)[0], reference[0])
    longitude = _near(
        position.longitude / BITS, _zone_sizes(latitude, position.odd)[1], reference[1]
    )
    return latitude, _wrap(longitude)


def _near(fraction: float, zone: float, reference: float) -> float:
    """Return the value of a fraction of a zone that lies nearest to a reference."""
    return zone * (math.floor(0.5 + reference / zone - fraction) + fraction)


def decode_global(
    even: CprPosition, odd: CprPosition, newest_is_odd: bool
) -> tuple[float, float] | None:
    """Decode a pair without a reference (A.1.7.7); latitude, longitude in degrees.

    Returns None when the two lie either side of a change of NL, which the standard calls for
    waiting on.
    """
    j = math.floor((59 * even.latitude - 60 * odd.latitude) / BITS + 0.5)
    lat_even = _signed(360.0 / 60 * (j % 60 + even.latitude / BITS))
    lat_odd = _signed(360.0 / 59 * (j % 59 + odd.latitude / BITS))
    zones = longitude_zones(lat_even)
    if zones != longitude_zones(lat_odd):
        return None
    latitude, newest = (lat_odd, odd) if newest_is_odd else (lat_even, even)
    if abs(latitude) > 90.0:
        return None
    count = max(zones - int(newest_is_odd), 1)
    m = math.floor((even.longitude * (zones - 1) - odd.longitude * zones) / BITS + 0.5)
    return latitude, _wrap(360.0 / count * (m % count + newest.longitude / BITS))


def _signed(latitude_deg: float) -> float:
    return latitude_deg - 360.0 if latitude_deg >= 270.0 else latitude_deg


def _wrap(longitude_deg: float) -> float:
    return (longitude_deg + 180.0) % 360.0 - 180.0
