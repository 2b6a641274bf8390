"""Downlink formats of Mode S, bit for bit: extended squitters and replies to interrogations.

Sources
-------
ICAO
    Annex 10, volume IV, 3.1.2: downlink formats, their fields, and the parity of 24 bits.
MOPS
    RTCA DO-260B, 2.2.3.2: the messages (field ME) of extended squitters, ADS-B version 2.
DOC
    ICAO Doc 9871, table A-2-32: aircraft identification in a Comm-B reply.

What the fields carry is in the units of their standards: feet, knots, degrees, feet per minute.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from airhilt.messages import EMERGENCY_STATES, EmergencyState, EmitterCategory
from airhilt.surveillance.cpr import CprPosition
from airhilt.surveillance.squitters import (
    ALTITUDE_STEP_FT,
    SURFACE_TRACK_STEP_DEG,
    VERTICAL_RATE_STEP_FPM,
    movement_code,
)
from airhilt.units import DEGREE

GENERATOR = 0x1FFF409
"""Generator polynomial of the parity field (ICAO, 3.1.2.3.3)."""
LOWEST_ALTITUDE_FT = -1000.0
"""Altitude at which the codes in steps of 25 ft begin (ICAO, 3.1.2.6.5.4)."""
ALTITUDE_CODES = 2**11
"""Number of altitude codes in steps of 25 ft."""
CHARACTERS = "#ABCDEFGHIJKLMNOPQRSTUVWXYZ##### ###############0123456789######"
"""Characters of a flight identification by their codes of 6 bits (ICAO, table 3-8)."""
VERSION = 2
"""ADS-B version of DO-260B (MOPS, 2.2.3.2.7.2.5)."""
SYSTEM_DESIGN_ASSURANCE = 2
"""Probability of a fault of 1e-5 or less an hour, the least that 14 CFR 91.227 allows."""
GEOMETRIC_VERTICAL_ACCURACY = 2
"""Error of the geometric altitude of 45 m or less (MOPS, 2.2.3.2.7.2.8)."""


class _Integrity(NamedTuple):
    """Form of a NIC in the air: type code of positions, and two supplements (MOPS, table 2-70)."""

    type_code: int
    supplement_a: int = 0
    """In the operational status."""
    supplement: int = 0
    """Supplement B of airborne positions, or C in the operational status on the surface."""


_AIRBORNE = tuple(
    _Integrity(*how)
    for how in ((18,), (17,), (16,), (16, 1, 1), (15,), (14,), (13,), (12,), (11,), (11, 1, 1),
                (10,), (9,))
)  # fmt: skip
"""Forms of the NICs from 0 to 11 of airborne positions."""
_SURFACE = tuple(
    _Integrity(*how)
    for how in (*[(8,)] * 6, (8, 0, 1), (8, 1, 1), (7,), (7, 1), (6,), (5,))
)  # fmt: skip
"""Forms of the NICs from 0 to 11 of surface positions; 1 to 5 are sent as 0, unknown."""


def parity(data: bytes) -> int:
    """Return the remainder of data by the generator polynomial, 24 bits.

    The remainder of a whole extended squitter is 0, that of a reply is the address of its sender.
    """
    register = int.from_bytes(data)
    for bit in range(8 * len(data) - 1, 23, -1):
        if register >> bit & 1:
            register ^= GENERATOR << bit - 24
    return register


def _packed(fields: Iterable[tuple[int, int]]) -> int:
    """Return fields, each a value and its number of bits, as one number."""
    number = 0
    for value, bits in fields:
        number = number << bits | value
    return number


def _frame(*fields: tuple[int, int], address: int = 0) -> bytes:
    """Return a frame of fields, with its parity overlaid by an address."""
    bits = sum(width for _, width in fields) + 24
    data = (_packed(fields) << 24).to_bytes(bits // 8)
    return data[:-3] + (parity(data) ^ address).to_bytes(3)


# --- codes ------------------------------------------------------------------------------------


def altitude_code(altitude_ft: float | None) -> int:
    """Return the altitude code of 12 bits, in steps of 25 ft (MOPS, 2.2.3.2.3.4).

    It is 0, no altitude, for None and above 50,175 ft.
    """
    if altitude_ft is None:
        return 0
    code = round((altitude_ft - LOWEST_ALTITUDE_FT) / ALTITUDE_STEP_FT)
    if not 0 <= code < ALTITUDE_CODES:
        return 0
    return code >> 4 << 5 | 0x10 | code & 0xF


def _altitude_code_13(altitude_ft: float | None) -> int:
    """Return the altitude code of 13 bits: that of 12 bits with the bit M, 0 for feet."""
    code = altitude_code(altitude_ft)
    return code >> 6 << 7 | code & 0x3F


def identity_code(squawk: str | None) -> int:
    """Return the identity code of 13 bits of a squawk (ICAO, 3.1.2.6.7.1); 0 for None.

    Its bits are C1 A1 C2 A2 C4 A4 0 B1 D1 B2 D2 B4 D4.
    """
    a, b, c, d = (int(digit) for digit in squawk or "0000")
    first = [(digit >> bit & 1, 1) for bit in range(3) for digit in (c, a)]
    second = [(digit >> bit & 1, 1) for bit in range(3) for digit in (b, d)]
    return _packed([*first, (0, 1), *second])


def identification_code(callsign: str) -> int:
    """Return a flight identification of eight characters as 48 bits (ICAO, 3.1.2.9.1.2)."""
    return _packed((CHARACTERS.index(character), 6) for character in f"{callsign[:8]:8}")


# --- messages of extended squitters, 56 bits ----------------------------------------------------


def _position_fields(position: CprPosition) -> tuple[tuple[int, int], ...]:
    return (int(position.odd), 1), (position.latitude, 17), (position.longitude, 17)


def airborne_position(
    position: CprPosition, altitude_ft: float | None, nic: int, has_alert: bool = False
) -> int:
    """Return the message of an airborne position (MOPS, 2.2.3.2.3).

    Its surveillance status is 1, permanent alert, during one.
    """
    how = _AIRBORNE[nic]
    return _packed(
        [(how.type_code, 5), (int(has_alert), 2), (how.supplement, 1),
         (altitude_code(altitude_ft), 12), (0, 1), *_position_fields(position)]
    )  # fmt: skip


def airborne_integrity(type_code: int, supplement_a: int, supplement: int) -> int:
    """Return the NIC of an airborne position with a type code and the two NIC supplements.

    It is 0, unknown, for positions with a GNSS height.
    """
    forms = (type_code, supplement_a, supplement), (type_code, 0, 0)
    return next((_AIRBORNE.index(form) for form in forms if form in _AIRBORNE), 0)


def surface_position(
    position: CprPosition, ground_speed_kt: float, track_deg: float, nic: int
) -> int:
    """Return the message of a surface position (MOPS, 2.2.3.2.4)."""
    track = round(track_deg / SURFACE_TRACK_STEP_DEG) % 128
    return _packed(
        [(_SURFACE[nic].type_code, 5), (movement_code(ground_speed_kt), 7), (1, 1), (track, 7),
         (0, 1), *_position_fields(position)]
    )  # fmt: skip


def airborne_velocity(
    ground_speed_kt: float, track_deg: float, vertical_rate_fpm: float, nacv: int
) -> int:
    """Return the message of an airborne velocity over ground (MOPS, 2.2.3.2.6.1).

    Speeds of 1,022 kt or more along an axis are sent in steps of 4 kt, up to 4,086 kt.
    """
    east = ground_speed_kt * math.sin(track_deg * DEGREE)
    north = ground_speed_kt * math.cos(track_deg * DEGREE)
    step = 4 if max(abs(round(east)), abs(round(north))) > 1021 else 1
    rate = round(vertical_rate_fpm / VERTICAL_RATE_STEP_FPM)
    return _packed(
        [(19, 5), (2 if step == 4 else 1, 3), (0, 2), (nacv, 3), *_signed(round(east / step), 10),
         *_signed(round(north / step), 10), (1, 1), *_signed(rate, 9), (0, 10)]
    )  # fmt: skip


def _signed(value: int, bits: int) -> tuple[tuple[int, int], tuple[int, int]]:
    """Return a sign, and a magnitude from which 0 is left out: that would be no information."""
    return (int(value < 0), 1), (min(abs(value) + 1, 2**bits - 1), bits)


def identification(callsign: str, category: EmitterCategory) -> int:
    """Return the message of callsign and emitter category (MOPS, 2.2.3.2.5)."""
    type_code = 4 - "ABCD".index(category[0])
    return _packed([(type_code, 5), (int(category[1]), 3), (identification_code(callsign), 48)])


def aircraft_status(emergency: EmergencyState, squawk: str | None) -> int:
    """Return the message of emergency and Mode A code (MOPS, 2.2.3.2.7.8.1)."""
    return _packed(
        [(28, 5), (1, 3), (EMERGENCY_STATES.index(emergency), 3), (identity_code(squawk), 13),
         (0, 32)]
    )  # fmt: skip


def operational_status(on_ground: bool, nic: int, nacp: int, nacv: int, sil: int) -> int:
    """Return the message of the operational status (MOPS, 2.2.3.2.7.2).

    The barometric altitude counts as checked, and headings as true.
    """
    how = (_SURFACE if on_ground else _AIRBORNE)[nic]
    operational_mode = ((0, 6), (SYSTEM_DESIGN_ASSURANCE, 2), (0, 8))
    integrity = (VERSION, 3), (how.supplement_a, 1), (nacp, 4)
    if on_ground:
        capability = ((0, 8), (nacv, 3), (how.supplement, 1), (0, 4))
        return _packed(
            [(31, 5), (1, 3), *capability, *operational_mode, *integrity, (0, 2), (sil, 2), (0, 4)]
        )
    return _packed(
        [(31, 5), (0, 3), (0, 16), *operational_mode, *integrity,
         (GEOMETRIC_VERTICAL_ACCURACY, 2), (sil, 2), (1, 1), (0, 3)]
    )  # fmt: skip


# --- frames -------------------------------------------------------------------------------------


def extended_squitter(
    address: int, message: int, on_ground: bool, has_alert: bool = False
) -> bytes:
    """Return a message in downlink format 17, of an aircraft's transponder."""
    return _frame((17, 5), (_capability(on_ground, has_alert), 3), (address, 24), (message, 56))


def non_transponder_squitter(address: int, message: int) -> bytes:
    """Return a message in downlink format 18, of a device that is no transponder."""
    return _frame((18, 5), (0, 3), (address, 24), (message, 56))


def all_call_reply(address: int, on_ground: bool, has_alert: bool = False) -> bytes:
    """Return an acquisition squitter, downlink format 11."""
    return _frame((11, 5), (_capability(on_ground, has_alert), 3), (address, 24))


def _capability(on_ground: bool, has_alert: bool) -> int:
    """Return the field CA of a transponder of level 2 or above (ICAO, 3.1.2.5.2.2.1).

    It is 7 while the flight status says that there is an alert.
    """
    if has_alert:
        return 7
    return 4 if on_ground else 5


class Surveillance(NamedTuple):
    """Contents of a transponder's replies to interrogations."""

    address: int
    altitude_ft: float | None
    squawk: str | None
    callsign: str
    on_ground: bool = False
    has_alert: bool = False
    """The Mode A code is that of an emergency."""

    def altitude_reply(self) -> bytes:
        """Return the altitude, downlink format 4."""
        return self._reply(4, _altitude_code_13(self.altitude_ft))

    def identity_reply(self) -> bytes:
        """Return the Mode A code, downlink format 5."""
        return self._reply(5, identity_code(self.squawk))

    def comm_b_altitude_reply(self) -> bytes:
        """Return the altitude with the aircraft identification (DOC), downlink format 20."""
        return self._reply(20, _altitude_code_13(self.altitude_ft), self._register())

    def comm_b_identity_reply(self) -> bytes:
        """Return the Mode A code with the aircraft identification (DOC), downlink format 21."""
        return self._reply(21, identity_code(self.squawk), self._register())

    def _reply(self, downlink_format: int, code: int, *register: tuple[int, int]) -> bytes:
        flight_status = 2 * int(self.has_alert) + int(self.on_ground)
        return _frame(
            (downlink_format, 5), (flight_status, 3), (0, 11), (code, 13), *register,
            address=self.address,
        )  # fmt: skip

    def _register(self) -> tuple[int, int]:
        """Return register 2,0 of the transponder, the aircraft identification."""
        return 0x20 << 48 | identification_code(self.callsign), 56
