"""Reads a file of traffic in any of the formats, and parts its records by aircraft."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from airhilt.geodesy.wgs84 import distance_m
from airhilt.units import DEGREE, FOOT, KNOT
from airhilt.world.flight.track import TrackPoint, track_problems
from airhilt.world.tracks import avr, opensky, readsb, sbs, traffic_frame
from airhilt.world.tracks.record import BadRecord, Format, Record, TracksError, record_of

FORMATS: tuple[Format, ...] = (
    readsb.FORMAT,
    opensky.FORMAT,
    sbs.FORMAT,
    avr.FORMAT,
    traffic_frame.FORMAT,
)
HEAD_BYTES = 4096
"""Bytes at the beginning of a file by which its format is known."""
DOUBT_S = 5.0
"""Least time between two positions from which the speed between them is compared, in s."""
DOUBT_KT = 100.0
"""Difference in kt between the speed that a file gives and that between its positions."""


@dataclass
class Traffic:
    """Records of a file by aircraft, in order of time, and what was left out of it.

    Attributes
    ----------
    bad
        Records that cannot be right.
    without_altitude
        Number of positions in the air without an altitude.
    """

    by_aircraft: dict[str, list[Record]] = field(default_factory=dict)
    bad: list[BadRecord] = field(default_factory=list)
    without_altitude: int = 0


def read_traffic(path: Path, name: str | None = None) -> Traffic:
    """Return the records of a file, in the format of a name, or in that which it looks like.

    Raises
    ------
    TracksError
        The file cannot be read, or is of no format that is known.
    """
    try:
        with path.open("rb") as stream:
            head = stream.read(HEAD_BYTES)
        form = _format(path, head, name)
        traffic = Traffic()
        for where, row in form.read(path):
            match record_of(where, row, form.fields):
                case Record() as record:
                    traffic.by_aircraft.setdefault(record.icao24, []).append(record)
                case BadRecord() as bad:
                    traffic.bad.append(bad)
                case None:
                    traffic.without_altitude += 1
    except OSError as error:
        raise TracksError(f"{path}: cannot be read: {error.strerror or error}") from None
    for address, records in traffic.by_aircraft.items():
        traffic.by_aircraft[address], unreachable = _reachable(records, form)
        traffic.bad += unreachable
    return traffic


def _format(path: Path, head: bytes, name: str | None) -> Format:
    for form in FORMATS:
        if form.name == name if name is not None else form.matches(path, head):
            return form
    known = "; ".join(f"{form.name} ({form.description})" for form in FORMATS)
    raise TracksError(f"{path}: no format that is known; --format names one of: {known}")


def point_of(record: Record, begin_s: float) -> TrackPoint:
    """Return a record as a point of a track that counts from an instant."""
    altitude_ft = record.altitude_ft
    return TrackPoint(
        record.t_s - begin_s,
        record.latitude_deg * DEGREE,
        record.longitude_deg * DEGREE,
        None if altitude_ft is None else altitude_ft * FOOT,
    )


def _reachable(records: list[Record], form: Format) -> tuple[list[Record], list[BadRecord]]:
    """Return the records that follow from those before them, and the others.

    Receivers repeat what they have: of two records of one time, or of one place in the air, the
    first one stays.
    """
    alone = [records[0]]
    for record in records[1:]:
        if not _is_repeated(alone[-1], record):
            alone.append(record)
    points = [point_of(record, 0.0) for record in alone]
    names = {"time": "t_s", "position": "latitude_deg", "altitude": "altitude_ft"}
    bad = {
        problem.number: BadRecord(
            alone[problem.number].where, form.fields[names[problem.field]], problem.text
        )
        for problem in track_problems(points)
    }
    left = [number for number in range(len(alone)) if number not in bad]
    for before, number, after in zip(left, left[1:], left[2:], strict=False):
        text = _doubt(alone[before], alone[number], alone[after])
        if text is not None and before not in bad:
            bad[number] = BadRecord(alone[number].where, form.fields["latitude_deg"], text)
    good = [record for number, record in enumerate(alone) if number not in bad]
    return good, [bad[number] for number in sorted(bad)]


def _is_repeated(last: Record, record: Record) -> bool:
    places = [(each.latitude_deg, each.longitude_deg) for each in (last, record)]
    is_airborne = last.altitude_ft is not None and record.altitude_ft is not None
    return record.t_s == last.t_s or (is_airborne and places[0] == places[1])


def _doubt(before: Record, record: Record, after: Record) -> str | None:
    """Return why a position is doubtful: no speed in the file explains the way to and from it."""
    given = record.ground_speed_kt if record.ground_speed_kt is not None else before.ground_speed_kt
    if given is None or record.altitude_ft is None:
        return None
    speeds = [_speed_kt(before, record), _speed_kt(record, after)]
    if any(speed is None or abs(speed - given) < DOUBT_KT for speed in speeds):
        return None
    to_kt, from_kt = (round(speed) for speed in speeds if speed is not None)
    return (
        f"the way to it takes {to_kt} kt and the way from it {from_kt} kt; expected about "
        f"{given:.0f} kt, as the file says"
    )


def _speed_kt(one: Record, other: Record) -> float | None:
    passed_s = other.t_s - one.t_s
    if passed_s < DOUBT_S:
        return None
    return distance_m(point_of(one, 0.0).place, point_of(other, 0.0).place) / passed_s / KNOT


def parts_of(records: Sequence[Record], longest_gap_s: float) -> list[list[Record]]:
    """Return the parts of the records of an aircraft between gaps longer than a time."""
    parts: list[list[Record]] = [[records[0]]]
    for before, record in itertools.pairwise(records):
        if record.t_s - before.t_s > longest_gap_s:
            parts.append([])
        parts[-1].append(record)
    return parts
