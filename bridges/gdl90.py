"""Sends the traffic of a run to electronic flight bags as GDL 90 datagrams.

    python bridges/gdl90.py --connect tcp/127.0.0.1:7447 --to 192.168.1.20 --ownship a1b2c3

Once a second it sends a heartbeat, the ownship report of the aircraft with the address given by
``--ownship``, and a traffic report of every other sender that was heard since. The ownship has no
valid position once nothing has come of it for five seconds. The bridge ends with the run.

The format is that of the GDL 90 Data Interface Specification (Garmin 560-1058-00, revision A), to
whose sections the functions refer.
"""

from __future__ import annotations

import binascii
import threading
from collections.abc import Iterator
from datetime import UTC, datetime

from airhilt.bus.bridge import datagrams, exiting_on_error, options, relay
from airhilt.errors import BusError
from airhilt.messages import EMERGENCY_STATES, AdsbReport
from airhilt.world.tracks.record import ADDRESS

FLAG, ESCAPE = b"\x7e", b"\x7d"
HEARTBEAT, OWNSHIP, TRAFFIC = 0, 10, 20
"""Identifiers of messages (3, table 2)."""
PERIOD_S = 1.0
"""Period of all messages, in s (3.1, 3.4, 3.5)."""
VALID_S = 5.0
"""Time after its last report for which the position of the ownship is valid, in s."""
ANGLE_STEP_DEG = 180.0 / 2**23
NO_ALTITUDE = 0xFFF
FASTEST_KT = 0xFFE
GREATEST_RATE = 510
"""Greatest vertical rate, in steps of 64 ft/min (3.5.1.7)."""
SURFACE_VEHICLE = 4
"""Address type of a vehicle (3.5.1.2)."""
NO_POSITION = {"latitude_deg": 0.0, "longitude_deg": 0.0, "nic": 0}
"""Fields of an ownship report without a valid position (3.4)."""
TRUE_TRACK, TRUE_HEADING, AIRBORNE = 1, 3, 8
"""Bits of the miscellaneous field (3.5.1.5)."""


def framed(message: bytes) -> bytes:
    """Return a message with its check sequence, byte stuffing and flags (2.2).

    The check sequence is the remainder of the message itself, not of the message and 16 zeros.
    """
    check = binascii.crc_hqx(message[:-2], 0) ^ int.from_bytes(message[-2:])
    content = message + check.to_bytes(2, "little")
    for special in (ESCAPE, FLAG):
        content = content.replace(special, ESCAPE + bytes([special[0] ^ 0x20]))
    return FLAG + content + FLAG


def heartbeat(when: datetime, reports: int, has_position: bool) -> bytes:
    """Return a heartbeat with a time of day and the number of reports since the last one (3.1)."""
    seconds = (when.hour * 60 + when.minute) * 60 + when.second
    return (
        bytes([HEARTBEAT, has_position << 7 | 1, seconds >> 16 << 7 | 1])
        + (seconds & 0xFFFF).to_bytes(2, "little")
        + min(reports, 0x3FF).to_bytes(2)
    )


def report_message(identifier: int, report: AdsbReport) -> bytes:
    """Return an ownship or traffic report (3.4, 3.5.1)."""
    category = report.emitter_category or "A0"
    altitude = NO_ALTITUDE
    if report.altitude_ft is not None:
        altitude = min(max(round((report.altitude_ft + 1000.0) / 25.0), 0), NO_ALTITUDE - 1)
    direction = TRUE_HEADING if report.on_ground else TRUE_TRACK | AIRBORNE
    speed = min(round(report.ground_speed_kt), FASTEST_KT)
    rate = min(max(round(report.vertical_rate_fpm / 64.0), -GREATEST_RATE), GREATEST_RATE)
    return (
        bytes([identifier, SURFACE_VEHICLE if category[0] == "C" else 0])
        + bytes.fromhex(report.icao24)
        + _angle(report.latitude_deg)
        + _angle(report.longitude_deg)
        + (altitude << 4 | direction).to_bytes(2)
        + bytes([report.nic << 4 | report.nacp])
        + (speed << 12 | rate & 0xFFF).to_bytes(3)
        + bytes([round(report.track_deg * 256.0 / 360.0) % 256])
        + bytes([8 * "ABC".index(category[0]) + int(category[1])])
        + f"{report.callsign or '':8.8}".encode()
        + bytes([EMERGENCY_STATES.index(report.emergency) << 4])
    )


def _angle(degrees: float) -> bytes:
    """Return a latitude or longitude in 24 bits, cut as in the example of 3.5.2.

    180 degrees east are 180 degrees west.
    """
    return (int(degrees / ANGLE_STEP_DEG) % 2**24).to_bytes(3)


class Traffic:
    """The latest report of each sender since the last second; for two threads."""

    def __init__(self, ownship: str | None) -> None:
        self._ownship = ownship
        self._own: AdsbReport | None = None
        self._silent_s = 0.0
        """Time since the last report of the ownship."""
        self._others: dict[str, AdsbReport] = {}
        self._lock = threading.Lock()

    def hear(self, report: AdsbReport) -> None:
        """Take a report."""
        if report.icao24 == self._ownship:
            self._own, self._silent_s = report, 0.0
        else:
            with self._lock:
                self._others[report.icao24] = report

    def missing(self) -> str | None:
        """Return a line on the ownship if no report of it has come."""
        if self._ownship is None or self._own is not None:
            return None
        return f"no report of {self._ownship} yet; expected the address of an aircraft of the run"

    def messages(self, when: datetime) -> Iterator[bytes]:
        """Yield the messages of a second."""
        with self._lock:
            others, self._others = self._others, {}
        own, is_valid = self._own, self._silent_s < VALID_S
        self._silent_s += PERIOD_S
        yield heartbeat(when, len(others), has_position=own is not None and is_valid)
        if own is not None:
            yield report_message(OWNSHIP, own if is_valid else own.model_copy(update=NO_POSITION))
        for report in others.values():
            yield report_message(TRAFFIC, report)


def main() -> None:
    """Run the bridge until the run is over."""
    parser = options(__doc__, 4000)
    parser.add_argument("--to", default="127.0.0.1", metavar="HOST", help="default: 127.0.0.1")
    parser.add_argument("--ownship", metavar="ICAO24", help="address of the own aircraft")
    given = parser.parse_args()
    ownship = given.ownship and given.ownship.lower()
    traffic = Traffic(ownship)
    is_over = threading.Event()
    with exiting_on_error():
        if ownship and not ADDRESS.fullmatch(ownship):
            raise BusError(
                f"--ownship {given.ownship}: expected the address of an aircraft, six hexadecimal "
                "digits"
            )
        send = datagrams(given.to, given.port)

        def tell() -> None:
            while not is_over.wait(PERIOD_S):
                for message in traffic.messages(datetime.now(UTC)):
                    send(framed(message))

        threading.Thread(target=tell, daemon=True).start()
        relay(
            given,
            {"adsb/*": lambda data: traffic.hear(AdsbReport.model_validate_json(data))},
            missing=traffic.missing,
        )
    is_over.set()


if __name__ == "__main__":
    main()
