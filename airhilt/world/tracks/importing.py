"""Makes a scenario of recorded traffic: one aircraft on a track for each in the file."""

from __future__ import annotations

import itertools
import math
import re
import statistics
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from airhilt.host import library
from airhilt.quantities import LONGEST_RUN_S
from airhilt.scenario.models import Scenario
from airhilt.scenario.models.actors import MOST_POINTS
from airhilt.scenario.problems import validated
from airhilt.units import FOOT
from airhilt.world.checks import check
from airhilt.world.flight.aircraft_type import load_aircraft_type
from airhilt.world.tracks.reading import Traffic, parts_of
from airhilt.world.tracks.record import SQUAWK, Record, TracksError

LEAST_STEP_S = 2.0
"""Time between two points of a track below which the later one is left out, in s."""
LONGEST_STEP_S = 4.0
"""Time between two points from which none is left out, in s."""
FT_PER_HPA = 27.3
"""Altitude in ft for a hectopascal near sea level in the standard atmosphere (ICAO Doc 7488/3)."""
STANDARD_QNH_HPA = 1013.25
CALLSIGN = re.compile(r"[A-Z0-9]{2,8}")
HEAVY, LIGHT = "A5", ("A1", "A2")
"""Emitter categories of heavy and of light aircraft (DO-260B, 2.2.3.2.5.2)."""
FAST_KT, QUICK_KT = 250.0, 140.0
"""Ground speeds in kt from which an unknown type counts as an airliner, and as a twin."""
HIGH_FT = 20_000.0
"""Altitude in ft from which an unknown type counts as an airliner."""


@dataclass(frozen=True)
class Wanted:
    """Choice of the traffic that becomes a scenario, and of its form.

    Attributes
    ----------
    from_s, until_s
        Times in s after the first record of the file.
    only
        Addresses or callsigns of the aircraft to take; empty: all.
    airport
        Airport of the scene; None: en route, without what is on the ground.
    aircraft
        Type of all aircraft; None: the one most like what the file says.
    qnh_hpa
        Pressure at sea level, by which altitudes become those above it.
    """

    name: str
    from_s: float = 0.0
    until_s: float = math.inf
    only: Collection[str] = ()
    airport: str | None = None
    aircraft: str | None = None
    longest_gap_s: float = 120.0
    qnh_hpa: float = STANDARD_QNH_HPA


@dataclass(frozen=True)
class Imported:
    """A scenario of recorded traffic, and notes on what is not in it."""

    scenario: Scenario
    document: dict[str, Any]
    notes: tuple[str, ...]


def scenario_of(traffic: Traffic, wanted: Wanted) -> Imported:
    """Return a scenario of recorded traffic.

    Raises
    ------
    TracksError
        Nothing of the traffic is wanted, or too much.
    ScenarioError
        The scenario is not valid.
    """
    notes: list[str] = []
    chosen = dict(_chosen(traffic, wanted, notes))
    if not chosen:
        raise TracksError(
            "no aircraft is left with two positions in the air; see --from, --until, --only and "
            "--longest-gap"
        )
    begin_s = min(records[0].t_s for records in chosen.values())
    length_s = max(records[-1].t_s for records in chosen.values()) - begin_s
    if length_s > LONGEST_RUN_S:
        raise TracksError(
            f"the traffic lasts {length_s:,.0f} s; expected at most {LONGEST_RUN_S:,.0f} s: choose "
            "a part with --from and --until"
        )
    document: dict[str, Any] = {
        "name": wanted.name,
        "title": f"Recorded traffic: {len(chosen)} aircraft",
        "family": "S02A",
        "scene": _scene(chosen, wanted),
        "duration_s": max(math.ceil(length_s), 1),
        "actors": [],
    }
    names: set[str] = set()
    for address, records in chosen.items():
        callsign = _callsign(address, records, names)
        names.add(callsign)
        actor = {
            "type": "aircraft",
            "callsign": callsign,
            "icao24": address,
            "aircraft": wanted.aircraft or aircraft_like(records),
            "initial": {"type": "track", "points": _points(records, begin_s)},
        }
        squawk = next((r.squawk for r in records if r.squawk and SQUAWK.fullmatch(r.squawk)), None)
        if squawk is not None:
            actor["transponder"] = {"squawk": squawk}
        document["actors"].append(actor)
    scenario = validated(Scenario, document, wanted.name)
    check(scenario, wanted.name)
    return Imported(scenario, document, tuple(notes))


def _chosen(
    traffic: Traffic, wanted: Wanted, notes: list[str]
) -> Iterator[tuple[str, list[Record]]]:
    """Yield the wanted records of each aircraft, at their altitudes above sea level."""
    every = [record for records in traffic.by_aircraft.values() for record in records]
    first_s = min((record.t_s for record in every), default=0.0)
    ground_ft = _ground_ft(wanted)
    only = {name.lower() for name in wanted.only}
    for address, records in sorted(traffic.by_aircraft.items()):
        names = {address, *((r.callsign or "").lower() for r in records)}
        if only and not only & names:
            continue
        inside = [
            _above_sea_level(r, wanted.qnh_hpa)
            for r in records
            if wanted.from_s <= r.t_s - first_s <= wanted.until_s
        ]
        there = [r for r in inside if _is_there(r, ground_ft, wanted.airport is not None)]
        if len(there) < len(inside):
            notes.append(
                f"{address}: {len(inside) - len(there)} positions on or below the ground are left "
                "out"
            )
        if not there:
            continue
        parts = parts_of(there, wanted.longest_gap_s)
        longest = max(parts, key=lambda part: part[-1].t_s - part[0].t_s)
        for before, after in itertools.pairwise(parts):
            notes.append(
                f"{address}: {after[0].where}: time: {after[0].t_s - before[-1].t_s:,.0f} s after "
                f"the position before, more than --longest-gap {wanted.longest_gap_s:g}"
            )
        if len(parts) > 1:
            notes.append(
                f"{address}: of {len(parts)} parts the longest is taken, from {longest[0].where} "
                f"to {longest[-1].where}: {longest[0].t_s - first_s:,.0f} to "
                f"{longest[-1].t_s - first_s:,.0f} s"
            )
        if len(longest) > 1:
            yield address, longest


def _is_there(record: Record, ground_ft: float, has_ground: bool) -> bool:
    return has_ground if record.altitude_ft is None else record.altitude_ft > ground_ft


def _above_sea_level(record: Record, qnh_hpa: float) -> Record:
    if record.altitude_ft is None or qnh_hpa == STANDARD_QNH_HPA:
        return record
    rise_ft = FT_PER_HPA * (qnh_hpa - STANDARD_QNH_HPA)
    return record._replace(altitude_ft=record.altitude_ft + rise_ft)


def _ground_ft(wanted: Wanted) -> float:
    if wanted.airport is None:
        return 0.0
    from airhilt.world.surface.layout import load_layout

    return load_layout(wanted.airport, {}).elevation_m / FOOT


def _scene(chosen: dict[str, list[Record]], wanted: Wanted) -> dict[str, Any]:
    if wanted.airport is not None:
        return {"type": "airport", "airport": wanted.airport}
    records = [record for each in chosen.values() for record in each]
    east = records[0].longitude_deg
    turns = [(r.longitude_deg - east + 180.0) % 360.0 - 180.0 for r in records]
    longitude = (east + statistics.median(turns) + 180.0) % 360.0 - 180.0
    centre = {
        "type": "geodetic",
        "lat_deg": round(statistics.median(r.latitude_deg for r in records), 4),
        "lon_deg": round(longitude, 4),
    }
    return {"type": "en_route", "centre": centre}


def _points(records: Sequence[Record], begin_s: float) -> list[list[float | None]]:
    """Return the points of a track, without those that lie close to the one before in time."""
    kept = [records[0]]
    for record, after in itertools.pairwise(records[1:]):
        last = kept[-1]
        is_needed = after.t_s - last.t_s > LONGEST_STEP_S
        touches = (record.altitude_ft is None) != (last.altitude_ft is None)
        if record.t_s - last.t_s >= LEAST_STEP_S or is_needed or touches:
            kept.append(record)
    kept.append(records[-1])
    if len(kept) > MOST_POINTS:
        raise TracksError(
            f"{records[0].icao24}: {len(kept):,} points; expected at most {MOST_POINTS:,}: choose "
            "a part with --from and --until"
        )
    return [
        [
            round(r.t_s - begin_s, 3),
            round(r.latitude_deg, 6),
            round(r.longitude_deg, 6),
            None if r.altitude_ft is None else round(r.altitude_ft, 1),
        ]
        for r in kept
    ]


def _callsign(address: str, records: Sequence[Record], taken: Collection[str]) -> str:
    """Return the callsign that an aircraft sends most, or its address."""
    said = [r.callsign.upper() for r in records if r.callsign]
    usual = statistics.mode(said) if said else ""
    return usual if CALLSIGN.fullmatch(usual) and usual not in taken else address.upper()


def aircraft_like(records: Sequence[Record]) -> str:
    """Return the type that is most like what the records say of an aircraft.

    It is the one of the type designator, else one of the emitter category, else one of the speed
    and the altitude.
    """
    designator = next((r.designator for r in records if r.designator), None)
    for name in library.names("aircraft"):
        if load_aircraft_type(name).icao_designator == designator:
            return name
    category = next((r.category for r in reversed(records) if r.category), None)
    fastest_kt = max((r.ground_speed_kt or 0.0 for r in records), default=0.0)
    highest_ft = max((r.altitude_ft or 0.0 for r in records), default=0.0)
    if category == HEAVY:
        return "B747"
    if fastest_kt > FAST_KT or highest_ft > HIGH_FT:
        return "737"
    if category in LIGHT or fastest_kt > 0.0:
        return "c310" if fastest_kt > QUICK_KT else "c172p"
    return "737"
