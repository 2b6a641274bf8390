"""Reads the runways and frequencies of an airport from the CSV files of OurAirports.

The files are ``runways.csv`` and ``airport-frequencies.csv`` of https://ourairports.com/data/
(public domain), whole or cut down to some airports.
"""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from pydantic import BaseModel, ValidationError

from airhilt.errors import ScenarioError
from airhilt.geodesy.wgs84 import distance_and_azimuth
from airhilt.host import library
from airhilt.host.files import read_file
from airhilt.host.text import readable
from airhilt.scenario.problems import problems_of
from airhilt.units import FOOT
from airhilt.world.surface.airport import Frequency, Role, Runway, RunwayThreshold

LARGEST_BYTES = 50_000_000
"""Size of the largest file that is read; those of all airports had 4 MB in 2026."""
MOST_LINES = 200_000
"""Greatest number of lines; the runways of all airports were 48,000 in 2026."""
MOST_RUNWAYS, MOST_FREQUENCIES = 50, 500
"""Greatest numbers of rows of one airport: what its file may have."""
LONGEST_NAME = 20
LONGEST_M = 20_000.0
"""Greatest length of a runway, in m; lake beds have some of 12 km."""
CREDIT = "OurAirports (public domain)"
ENDS = ("le", "he")
"""Beginnings of the columns of both ends of a runway."""
OF_ENDS = ("ident", "latitude_deg", "longitude_deg", "elevation_ft", "displaced_threshold_ft")
RUNWAY_COLUMNS = (
    *("airport_ident", "length_ft", "width_ft", "surface", "closed"),
    *(f"{end}_{what}" for end in ENDS for what in OF_ENDS),
)
FREQUENCY_COLUMNS = ("airport_ident", "type", "description", "frequency_mhz")
ROLES: dict[str, Role] = {
    "TWR": "tower",
    "GND": "ground",
    "CLD": "clearance",
    "CLR": "clearance",
    "CLRD": "clearance",
    "DEL": "clearance",
    "APP": "approach",
    "ARR": "approach",
    "DIR": "approach",
    "A/D": "approach",
    "DEP": "departure",
    "ATIS": "atis",
    "UNIC": "unicom",
    "CTAF": "unicom",
}
"""Role by the first word of OurAirports' type; every other is ``other``."""
DESIGNATOR = re.compile("[0-9]{1,2}[A-Z]{0,2}")
DECIMALS = 7
"""Decimals of degrees: a centimetre."""
USUAL_WIDTH_FT = 100.0
"""Width of runways whose width is not given, in ft."""
LENGTHS_DISAGREE_M = 25.0
"""Difference between coordinates and published length from which on there is a note, in m."""
HOLD_DISTANCES_M = ((800.0, 30.0), (1200.0, 40.0), (math.inf, 90.0))
"""Runway lengths, and distances of holding positions from the centre line of shorter runways, in m:
ICAO Annex 14 volume I, table 3-2, code numbers 1 and 2 without instrument approaches, 3 and 4
with precision approaches of category I."""
HOLD_DISTANCE_FAA_M = 250.0 * FOOT
"""FAA AC 150/5300-13B, appendix G: approach categories C and D, design groups I to IV."""


@dataclass(frozen=True)
class Runways:
    """Runways of an airport as a file has them, and notes on what it leaves open."""

    runways: tuple[Runway, ...]
    notes: tuple[str, ...]


def read_runways(path: Path, ident: str) -> Runways:
    """Read the runways of an airport that aeroplanes can use.

    Closed runways, helicopter areas, water lanes without a number and rows without coordinates
    are left out, and noted.

    Raises
    ------
    ScenarioError
        The file cannot be read, lacks a column, knows no such airport, or has nothing left.
    """
    rows, known = _rows(path, ident, RUNWAY_COLUMNS, MOST_RUNWAYS)
    if not rows:
        near = readable(library.nearest(ident, sorted(known)))
        raise ScenarioError(f"{path} has no airport {ident!r}{near}")
    notes: list[str] = []
    usable = []
    for row in rows:
        name = readable(f"{row['le_ident'] or '?'}/{row['he_ident'] or '?'}", LONGEST_NAME)
        if reason := _unusable(row):
            notes.append(f"left out {name}: {reason}")
        else:
            usable.append((name, row))
    elevations = [
        elevation
        for _, row in usable
        for end in ENDS
        if (elevation := _number(row[f"{end}_elevation_ft"])) is not None
    ]
    if not usable:
        raise ScenarioError(f"{path} has no usable runway at {ident}: {'; '.join(notes)}")
    if not elevations:
        raise ScenarioError(f"{path} gives no elevation for any runway of {ident}")
    runways = tuple(
        _runway(path, name, row, sum(elevations) / len(elevations), notes) for name, row in usable
    )
    return Runways(tuple(sorted(runways, key=lambda runway: runway.name)), tuple(notes))


def read_frequencies(path: Path, ident: str) -> tuple[Frequency, ...]:
    """Read the frequencies of an airport; an airport may have none.

    Raises
    ------
    ScenarioError
        The file cannot be read, or lacks a column.
    """
    found: dict[tuple[Role, int], Frequency] = {}
    rows, _ = _rows(path, ident, FREQUENCY_COLUMNS, MOST_FREQUENCIES)
    for row in rows:
        megahertz = _number(row["frequency_mhz"])
        if megahertz is None:
            continue
        role = ROLES.get(row["type"].upper().split(" ")[0], "other")
        name = row["description"] or row["type"]
        with refusing(f"{path}: a frequency of {ident}", Frequency):
            frequency = Frequency(role=role, frequency_khz=round(megahertz * 1000.0), name=name)
        found.setdefault((role, frequency.frequency_khz), frequency)
    return tuple(found.values())


def _rows(
    path: Path, ident: str, columns: tuple[str, ...], most: int
) -> tuple[list[dict[str, str]], set[str]]:
    """Return these columns of the rows of an airport, and the identifiers of all airports."""
    rows: list[dict[str, str]] = []
    known = set()
    try:
        data = read_file(path, LARGEST_BYTES)
        header, _, _ = data.partition(b"\n")
        separator = ";" if header.count(b";") > header.count(b",") else ","
        text = io.TextIOWrapper(io.BytesIO(data), "utf-8-sig", newline="")
        reader = csv.reader(text, delimiter=separator)
        names = next(reader, [])
        if missing := [name for name in columns if name not in names]:
            has = readable(", ".join(names) or "none")
            raise ScenarioError(f"{path} has no column {', '.join(missing)}; it has {has}")
        places = {name: names.index(name) for name in columns}
        for fields in reader:
            row = {name: "".join(fields[at : at + 1]).strip() for name, at in places.items()}
            known.add(row["airport_ident"])
            if row["airport_ident"].upper() == ident.upper():
                rows.append(row)
            if reader.line_num > MOST_LINES:
                raise ScenarioError(f"{path}: found over {MOST_LINES:,} lines; expected fewer")
            if len(rows) > most:
                raise ScenarioError(f"{path}: found over {most} rows of {ident}; expected fewer")
    except OSError as error:
        raise ScenarioError(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise ScenarioError(f"{path}: is not UTF-8 text: {error.reason}") from error
    except csv.Error as error:
        raise ScenarioError(f"{path}: no CSV: {error}") from None
    return rows, known


@contextmanager
def refusing(origin: str, model: type[BaseModel]) -> Iterator[None]:
    """Raise the first of what pydantic finds wrong as a ScenarioError that names the origin."""
    try:
        yield
    except ValidationError as error:
        raise ScenarioError(f"{origin}: {problems_of(error, model)[0]}") from None


def _unusable(row: dict[str, str]) -> str | None:
    idents = (row["le_ident"].upper(), row["he_ident"].upper())
    if row["closed"] == "1":
        return "closed"
    if any(ident.startswith("H") or ident.endswith("H") for ident in idents):
        return "for helicopters"
    if not all(DESIGNATOR.fullmatch(ident) for ident in idents):
        return "has no runway number"
    numbers = [_number(row[f"{end}_{what}"]) for end in ENDS for what in OF_ENDS[1:3]]
    if None in numbers:
        return "has no coordinates"
    if numbers[:2] == numbers[2:]:
        return "has the same coordinates twice"
    return None


def _runway(
    path: Path, name: str, row: dict[str, str], elevation_ft: float, notes: list[str]
) -> Runway:
    of_airport = f"{name} of {row['airport_ident']}"
    ends = []
    for end in ENDS:
        with refusing(f"{path}: {end} of runway {of_airport}", RunwayThreshold):
            ends.append(_end(end, row, elevation_ft, notes))
    length_m, _ = distance_and_azimuth(ends[0].place, ends[1].place)
    if length_m > LONGEST_M:
        raise ScenarioError(
            f"{path}: runway {of_airport} is {length_m:.0f} m long by its coordinates; "
            f"expected at most {LONGEST_M:.0f} m"
        )
    published = _number(row["length_ft"])
    if published and abs(published * FOOT - length_m) > LENGTHS_DISAGREE_M:
        notes.append(
            f"{name} is {length_m / FOOT:.0f} ft long by its coordinates, which are used, "
            f"and {published:g} ft as published"
        )
    if length_m < (ends[0].displaced_threshold_ft + ends[1].displaced_threshold_ft) * FOOT:
        raise ScenarioError(
            f"{path}: runway {name} has thresholds that are displaced beyond its length"
        )
    width_ft = _number(row["width_ft"])
    if not width_ft:
        notes.append(f"{name} has no width, {USUAL_WIDTH_FT:.0f} ft is used")
    with refusing(f"{path}: runway {of_airport}", Runway):
        return Runway(
            ends=(ends[0], ends[1]),
            width_ft=width_ft or USUAL_WIDTH_FT,
            surface=row["surface"],
            hold_distance_m=_hold_distance(row["airport_ident"], length_m),
        )


def _end(end: str, row: dict[str, str], elevation_ft: float, notes: list[str]) -> RunwayThreshold:
    ident = row[f"{end}_ident"].upper()
    elevation = _number(row[f"{end}_elevation_ft"])
    if elevation is None:
        notes.append(f"{ident} has no elevation, the mean of the others is used")
    return RunwayThreshold(
        ident=ident if ident[1:2].isdigit() else f"0{ident}",
        lat_deg=round(float(row[f"{end}_latitude_deg"]), DECIMALS),
        lon_deg=round(float(row[f"{end}_longitude_deg"]), DECIMALS),
        elevation_ft=round(elevation_ft, 1) if elevation is None else elevation,
        displaced_threshold_ft=max(_number(row[f"{end}_displaced_threshold_ft"]) or 0.0, 0.0),
    )


def _hold_distance(ident: str, length_m: float) -> float:
    distance = next(metres for longest, metres in HOLD_DISTANCES_M if length_m < longest)
    american = ident.startswith("K") and len(ident) == 4
    return HOLD_DISTANCE_FAA_M if american and distance == HOLD_DISTANCES_M[-1][1] else distance


def _number(text: str) -> float | None:
    """Return a field as a number, or None where it is empty, none, or beyond all reason."""
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number * 1000.0) else None
