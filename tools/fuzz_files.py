"""Mutates the airports or aircraft types that ship, and checks each mutant in a scenario with it.

python tools/fuzz_files.py airports --count 5000 --run-every 0
python tools/fuzz_files.py aircraft --count 5000 --run-every 50 --keep failures
"""

from __future__ import annotations

import json
import sys
from typing import Any

from airhilt.cosim.setup import require_runnable
from airhilt.scenario import Scenario, documents
from airhilt.world.flight.aircraft_type import load_aircraft_type
from airhilt.world.loading import load_text
from airhilt.world.surface.airport import load_airport
from airhilt.world.surface.description import describe
from airhilt.world.surface.layout import Layout
from mutants import Read, fuzz

FILE = "mutant.json"
CENTRE = {"type": "geodetic", "lat_deg": 38.9, "lon_deg": -77.0}
ALTITUDE_FT = 6000


def read_airport(text: str) -> Scenario:
    """Return a scenario at the airport in a text, with an aircraft over it."""
    document = documents.parse(text, FILE)
    airport = load_airport(FILE, {FILE: document})
    json.dumps(describe(Layout(airport)))
    over = {
        "type": "geodetic",
        "lat_deg": airport.reference.lat_deg,
        "lon_deg": airport.reference.lon_deg,
    }
    above_ft = ALTITUDE_FT + airport.elevation_ft
    return _scenario({"type": "airport", "airport": FILE}, document, "737", over, above_ft, 220)


def read_aircraft(text: str) -> Scenario:
    """Return a scenario with an aircraft of the type in a text."""
    document = documents.parse(text, FILE)
    speeds = load_aircraft_type(FILE, {FILE: document}).speeds
    cas_kt = (speeds.minimum_clean_kt + speeds.maximum_kt) / 2
    over = {"type": "from_centre", "bearing_deg": 270, "distance_nm": 20}
    return _scenario(
        {"type": "en_route", "centre": CENTRE}, document, FILE, over, ALTITUDE_FT, cas_kt
    )


def _scenario(
    scene: Any, document: Any, aircraft: str, position: Any, altitude_ft: float, cas_kt: float
) -> Scenario:
    place = {"position": position, "altitude_ft": altitude_ft, "cas_kt": cas_kt}
    actor = {
        "type": "aircraft",
        "callsign": "AAL123",
        "icao24": "a1b2c3",
        "aircraft": aircraft,
        "initial": {"type": "airborne", "track_deg": 90, **place},
    }
    wrapped = {
        "name": "mutant",
        "title": "A file of somebody else",
        "description": "A file of somebody else",
        "family": "S02A",
        "scene": scene,
        "duration_s": 60,
        "actors": [actor],
        "files": {FILE: document},
    }
    scenario = load_text(json.dumps(wrapped), "scenario.json")
    require_runnable(scenario)
    return scenario


READERS: dict[str, Read] = {"airports": read_airport, "aircraft": read_aircraft}

if __name__ == "__main__":
    if sys.argv[1:2] not in [[kind] for kind in READERS]:
        sys.exit(f"{__doc__}\nexpected one of: {', '.join(READERS)}")
    chosen = sys.argv.pop(1)
    sys.exit(fuzz(chosen, READERS[chosen], __doc__))
