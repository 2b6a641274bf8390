"""Sends the surveillance of a run to air traffic displays as ASTERIX datagrams.

    python bridges/asterix.py --connect tcp/127.0.0.1:7447 --to 127.0.0.1 --port 8600

ADS-B reports go out in category 021 and, as tracks, in category 062; plots of surveillance radars
in category 048. ``--categories`` chooses some of them. All are marked as simulated. The data source
of the system area code 0 is 1 for ADS-B, 2 for tracks, and 3 and up for radars in the order of
their names; a line for each says where its antenna is. The bridge ends with the run.

The categories are those of EUROCONTROL-SPEC-0149, part 12 (021, edition 2.6), part 4 (048, edition
1.21) and part 9 (062, edition 1.18). Items are given by their field reference numbers.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from datetime import datetime

from airhilt.bus.bridge import WallClock, datagrams, exiting_on_error, options, relay, tell
from airhilt.messages import (
    EMERGENCY_STATES,
    AdsbReport,
    EmitterCategory,
    PlotKind,
    RadarInfo,
    RadarPlot,
)
from airhilt.surveillance.mode_s import (
    GEOMETRIC_VERTICAL_ACCURACY,
    SYSTEM_DESIGN_ASSURANCE,
    VERSION,
    identification_code,
)
from airhilt.surveillance.transponders import EMERGENCY_CODES
from airhilt.units import DEGREE, KNOT, NAUTICAL_MILE

CATEGORIES = (21, 48, 62)
ADSB_SOURCE, TRACK_SOURCE = 1, 2
MORE = 1
"""Bit that says that an item goes on in the next octet."""
SIMULATED_PLOT = 0x10
SIMULATED = 0x20
GROUND = 0x40
"""Bits of the target report descriptors (I048/020, I021/040)."""
MONOSENSOR, SIMULATED_TRACK = 0x80, 0x80
"""Bits of the track status (I062/080)."""
NO_LNAV = 0x40
"""Bit of the target status that says that LNAV is not engaged (I021/200)."""
EXTENDED_SQUITTER = 2
"""Technology of the link (I021/210)."""
PLOT_TYPES: dict[PlotKind, int] = {"primary": 1, "secondary": 2, "combined": 3}
"""Type of detection (I048/020)."""
EMITTER_CATEGORIES: dict[EmitterCategory, int] = {
    "A1": 1, "A2": 2, "A3": 3, "A4": 4, "A5": 5, "A6": 6, "A7": 10, "B1": 11, "B2": 12, "B3": 16,
    "B4": 15, "B6": 13, "B7": 14, "C1": 20, "C2": 21, "C3": 22, "C4": 23, "C5": 24,
}  # fmt: skip
"""Code of each emitter category (I021/020); 0, no information, for the others."""
TRACK_CATEGORIES = {
    category: code for category, code in EMITTER_CATEGORIES.items() if category not in ("C4", "C5")
} | {"A2": 3, "A4": 3}
"""Code of each emitter category (I062/380, EMC), which has one of 7,000 to 136,000 kg; none for the
others."""


def block(category: int, items: Mapping[int, bytes]) -> bytes:
    """Return a data block of one record, with items by their field reference numbers."""
    octets = bytearray((max(items) + 6) // 7)
    for number in items:
        octets[(number - 1) // 7] |= 0x80 >> (number - 1) % 7
    for index in range(len(octets) - 1):
        octets[index] |= MORE
    record = bytes(octets) + b"".join(items[number] for number in sorted(items))
    return bytes([category]) + (len(record) + 3).to_bytes(2) + record


def report_block(report: AdsbReport, received: datetime, sent: datetime) -> bytes:
    """Return the data block of category 021 for a report."""
    alert = int(report.squawk in EMERGENCY_CODES)
    items = {
        1: _source(ADSB_SOURCE),
        2: bytes([MORE, SIMULATED | (GROUND if report.on_ground else 0)]),
        7: _angles(report, 180.0 / 2**30),
        11: bytes.fromhex(report.icao24),
        12: _time(received),
        17: bytes(
            [
                report.nacv << 5 | report.nic << 1 | MORE,
                0x80 | report.sil << 5 | report.nacp << 1 | MORE,
                SYSTEM_DESIGN_ASSURANCE << 3 | GEOMETRIC_VERTICAL_ACCURACY << 1,
            ]
        ),
        18: bytes([VERSION << 3 | EXTENDED_SQUITTER]),
        23: bytes([NO_LNAV | EMERGENCY_STATES.index(report.emergency) << 2 | alert]),
        26: _ground_vector(report),
        28: _time(sent),
    }
    if report.squawk is not None:
        items[19] = int(report.squawk, 8).to_bytes(2)
    if report.altitude_ft is not None:
        items[21] = _signed(report.altitude_ft / 25.0, 2)
        items[24] = (round(report.vertical_rate_fpm / 6.25) & 0x7FFF).to_bytes(2)
    if report.callsign is not None:
        items[29] = identification_code(report.callsign).to_bytes(6)
    if report.emitter_category is not None:
        items[30] = bytes([EMITTER_CATEGORIES.get(report.emitter_category, 0)])
    return block(21, items)


def track_block(report: AdsbReport, number: int, when: datetime) -> bytes:
    """Return the data block of category 062 for a report, as a track with a number."""
    speed_m_s, track = report.ground_speed_kt * KNOT, report.track_deg * DEGREE
    ground_bit = (1 << 9) if report.on_ground else 0
    status = (ground_bit | EMERGENCY_STATES.index(report.emergency)).to_bytes(2)
    category = TRACK_CATEGORIES.get(report.emitter_category or "A0")
    items = {
        1: _source(TRACK_SOURCE),
        4: _time(when),
        5: _angles(report, 180.0 / 2**25),
        7: b"".join(
            _signed(speed_m_s * axis / 0.25, 2) for axis in (math.sin(track), math.cos(track))
        ),
        # Target address; status reported by ADS-B; emitter category.
        11: bytes([0x80 | MORE, 0x10] if category is None else [0x80 | MORE, 0x10 | MORE, 0x02])
        + bytes.fromhex(report.icao24)
        + status
        + bytes([] if category is None else [category]),
        12: number.to_bytes(2),
        13: bytes([MONOSENSOR | MORE, SIMULATED_TRACK]),
        14: bytes([0x04, 0]),  # Age of the extended squitter.
    }
    if report.squawk is not None:
        items[9] = int(report.squawk, 8).to_bytes(2)
    if report.callsign is not None:
        items[10] = b"\0" + identification_code(report.callsign).to_bytes(6)
    if report.altitude_ft is not None:
        items[17] = _signed(report.altitude_ft / 25.0, 2)
        items[20] = _signed(report.vertical_rate_fpm / 6.25, 2)
    return block(62, items)


def plot_block(plot: RadarPlot, source: int, when: datetime) -> bytes:
    """Return the data block of category 048 for a plot of the radar that is a source."""
    items = {
        1: _source(source),
        2: _time(when),
        3: bytes([PLOT_TYPES[plot.kind] << 5 | SIMULATED_PLOT]),
        4: min(round(plot.range_m * 256.0 / NAUTICAL_MILE), 0xFFFF).to_bytes(2)
        + (round(plot.azimuth_deg * 2**16 / 360.0) % 2**16).to_bytes(2),
    }
    if plot.mode_a is not None:
        items[5] = int(plot.mode_a, 8).to_bytes(2)
    if plot.mode_c_ft is not None:
        items[6] = (round(plot.mode_c_ft / 25.0) & 0x3FFF).to_bytes(2)
    return block(48, items)


def _source(code: int) -> bytes:
    return bytes([0, code])


def _signed(value: float, octets: int) -> bytes:
    return round(value).to_bytes(octets, signed=True)


def _time(when: datetime) -> bytes:
    """Return the time since midnight in steps of 1/128 s."""
    since = when - when.replace(hour=0, minute=0, second=0, microsecond=0)
    return int(since.total_seconds() * 128.0).to_bytes(3)


def _angles(report: AdsbReport, step_deg: float) -> bytes:
    """Return latitude and longitude in 32 bits each."""
    return b"".join(
        _signed(angle / step_deg, 4) for angle in (report.latitude_deg, report.longitude_deg)
    )


def _ground_vector(report: AdsbReport) -> bytes:
    """Return ground speed in steps of 2**-14 NM/s and track angle, 16 bits each."""
    speed = min(round(report.ground_speed_kt / 3600.0 * 2**14), 0x7FFF)
    return speed.to_bytes(2) + (round(report.track_deg * 2**16 / 360.0) % 2**16).to_bytes(2)


class Blocks:
    """Makes the data blocks of the messages of a run."""

    def __init__(self) -> None:
        self._times = WallClock()
        self._tracks: dict[str, int] = {}
        self._radars: dict[str, int] = {}

    def of_report(self, report: AdsbReport) -> Iterator[bytes]:
        """Yield the blocks of an ADS-B report."""
        received = self._times.at(report.t_adsb_in_ns)
        yield report_block(report, received, self._times.at(report.t_adsb_out_ns))
        yield track_block(
            report, self._tracks.setdefault(report.icao24, len(self._tracks) + 1), received
        )

    def number(self, radars: Iterable[RadarInfo]) -> Iterator[str]:
        """Give radars their codes in the order of their names; yield a line on each."""
        for radar in sorted(radars, key=lambda radar: radar.site):
            yield (
                f"radar {radar.site}: data source 0/{self._code(radar.site)}, antenna at "
                f"{radar.latitude_deg:.6f} {radar.longitude_deg:.6f}, {radar.altitude_m:.0f} m"
            )

    def of_plot(self, plot: RadarPlot) -> Iterator[bytes]:
        """Yield the block of a plot."""
        yield plot_block(plot, self._code(plot.site), self._times.at(plot.t_plot_ns))

    def _code(self, site: str) -> int:
        return self._radars.setdefault(site, TRACK_SOURCE + 1 + len(self._radars))


def main() -> None:
    """Run the bridge until the run is over."""
    parser = options(__doc__, 8600)
    parser.add_argument(
        "--to", default="127.0.0.1", metavar="HOST", help="host or multicast group; 127.0.0.1"
    )
    parser.add_argument(
        "--categories", type=int, nargs="+", choices=CATEGORIES, default=CATEGORIES,
        help="categories to send; default: all",
    )  # fmt: skip
    given = parser.parse_args()
    blocks = Blocks()
    with exiting_on_error():
        datagram = datagrams(given.to, given.port)

        def send(made: Iterator[bytes]) -> None:
            for data in made:
                if data[0] in given.categories:
                    datagram(data)

        def name(kept: list[bytes]) -> None:
            if 48 in given.categories:
                for line in blocks.number(RadarInfo.model_validate_json(each) for each in kept):
                    tell(line)

        relay(
            given,
            {
                "adsb/*": lambda data: send(blocks.of_report(AdsbReport.model_validate_json(data))),
                "radar/*": lambda data: send(blocks.of_plot(RadarPlot.model_validate_json(data))),
                "radar/*/info": lambda data: name([data]),
            },
            told={"radar/*/info": name},
        )


if __name__ == "__main__":
    main()
