"""Makes airports/kdca.json: the runways of OurAirports, the rest drawn after the real airport.

    python tools/make/kdca.py RUNWAYS_CSV FREQUENCIES_CSV airports/kdca.json

Runways and frequencies are those of the files. Everything else is drawn from memory of the real
airport, in metres beside the runways: right as to what crosses what and which side it is on, wrong
by tens of metres as to where.
"""

from __future__ import annotations

import sys
from pathlib import Path

from airhilt.world.surface.airport import (
    Airport,
    Block,
    Building,
    Camera,
    Frequency,
    ReferencePoint,
    Source,
    Tower,
    Water,
)
from airhilt.world.surface.draft import Draft, write_airport
from airhilt.world.surface.importer import (
    MAGNETIC_SOURCE,
    magnetic_variation,
    with_magnetic_headings,
)
from airhilt.world.surface.ourairports import CREDIT, read_frequencies, read_runways
from airhilt.world.surface.path import Local

REFERENCE = ReferencePoint(lat_deg=38.8521, lon_deg=-77.0377)
EPOCH = 2025.0
TAXIWAY_WIDTH_M = 23.0
"""75 ft: FAA AC 150/5300-13B, taxiway design group 5."""
MAIN, CROSS, SHORT = "01/19", "15/33", "04/22"
J, K, GATE = -122.0, -200.0, -275.0
"""Right of runway 01: to the west. J is 400 ft from the centre line (AC 150/5300-13B, group IV)."""
BESIDE = 122.0
"""Distance of the other parallel taxiways from their runways, in m."""
GATES = {
    "gate_a2": 725.0,
    "gate_a6": 870.0,
    "gate_b12": 930.0,
    "gate_b18": 985.0,
    "gate_c28": 1120.0,
    "gate_c34": 1175.0,
    "gate_d38": 1230.0,
    "gate_d44": 1285.0,
    "gate_e50": 1400.0,
    "gate_e58": 1460.0,
}
"""Distance along runway 01."""
STATIONS = {"fire_station": 600.0, "vehicle_base": 650.0}
CONNECTORS = {"D": 800.0, "E": 1050.0, "F": 1340.0}
DRAWN = "Drawn from memory of the airport, beside the runways"
UNIT_NAMES = {
    "APP": "Potomac Approach",
    "DEP": "Potomac Departure",
    "CLRD": "Washington Clearance",
    "GND": "Washington Ground",
    "TWR": "Washington Tower",
}
POTOMAC = [
    (-420, -2600), (-380, -1500), (-330, -1230), (-100, -1200), (150, -1230), (330, -1150),
    (370, -850), (350, -560), (480, -380), (560, -230), (520, -60), (530, 120), (540, 340),
    (430, 500), (310, 650), (160, 860), (60, 1130), (-150, 1170), (-330, 1240), (-620, 1330),
    (-900, 1700), (-1300, 2600), (900, 2600), (1500, 1500), (1300, 0), (1100, -1200),
    (1000, -2600),
]  # fmt: skip
ROACHES_RUN = [(-900, 850), (-760, 1050), (-800, 1250), (-1000, 1300), (-1150, 1050)]


def main(runways_csv: str, frequencies_csv: str, out: str) -> None:
    """Write the airport's file."""
    read = read_runways(Path(runways_csv), "KDCA")
    variation = magnetic_variation(REFERENCE.place, EPOCH)
    runways = tuple(with_magnetic_headings(runway, variation) for runway in read.runways)
    draft = Draft(REFERENCE, runways, TAXIWAY_WIDTH_M)
    draw_taxiways(draft)
    ends = [end for runway in runways for end in runway.ends]
    tower_lat, tower_lon = draft.degrees(draft.beside(MAIN, 880.0, -390.0))
    airport = Airport(
        icao="KDCA",
        name="Ronald Reagan Washington National",
        reference=REFERENCE,
        elevation_ft=max(end.elevation_ft for end in ends),
        magnetic_variation=variation,
        runways=runways,
        taxiways=draft.taxiways,
        holds=tuple(draft.holds),
        tower=Tower(lat_deg=tower_lat, lon_deg=tower_lon, height_m=55.0),
        buildings=buildings(draft),
        water=(
            Water(name="Potomac River", outline=draft.corners(*POTOMAC)),
            Water(name="Roaches Run", outline=draft.corners(*ROACHES_RUN)),
        ),
        frequencies=frequencies(Path(frequencies_csv)),
        cameras=cameras(draft),
        sources=sources(read.notes),
    )
    write_airport(airport, Path(out))


def sources(notes: tuple[str, ...]) -> dict[Block, Source]:
    """Return where the numbers of the airport come from."""
    drawn = Source(text=DRAWN, synthetic=True)
    return {
        "reference": Source(text="Airport reference point, FAA, to four decimals"),
        "elevation_ft": Source(text=f"Highest runway end of {CREDIT}"),
        "magnetic_variation": MAGNETIC_SOURCE,
        "runways": Source(
            text=f"{CREDIT}, rows of 2026-08-22; hold distance 250 ft: FAA AC 150/5300-13B; "
            "magnetic headings computed from the coordinates and the variation",
            note="; ".join(notes),
        ),
        "taxiways": Source(
            text=DRAWN,
            synthetic=True,
            note="J and K run as the real ones do; connectors, east-side taxiways and most "
            "letters are approximate, stands stand for groups of gates",
        ),
        "holds": Source(
            text="Where the drawn taxiways meet the hold distance of the runways",
            synthetic=True,
        ),
        "tower": drawn,
        "buildings": drawn,
        "water": drawn,
        "frequencies": Source(
            text=f"{CREDIT}, rows of 2026-08-22; ATIS on 132.65 MHz is in them as a weather "
            "broadcast; names of units that they leave empty are those spoken on the radio"
        ),
        "cameras": Source(text="Invented for AIRHILT", synthetic=True),
    }


def draw_taxiways(draft: Draft) -> None:
    """Draw J, K and S on the terminal side, H and L by the river, and what joins them."""
    draw_crossings(draft)
    draw_j(draft)
    draw_k(draft)
    draw_connectors(draft)
    draw_s(draft)
    draw_river_side(draft)


def along_main(draft: Draft) -> dict[str, float]:
    """Return how far along runway 01 the taxiways that cross J are."""
    return {"A": 20.0, "B": 180.0, **CONNECTORS, "M": 1900.0, "N": length(draft, MAIN) - 20.0}


def draw_crossings(draft: Draft) -> None:
    """Place the points where J and K meet runways and other taxiways."""
    for letter, along in along_main(draft).items():
        draft.node(f"J/{letter}", draft.beside(MAIN, along, J), "junction")
        draft.node(f"{MAIN} at {letter}", draft.beside(MAIN, along, 0.0), "runway")
    j, s = line(draft, MAIN, J), line(draft, SHORT, -BESIDE)
    draft.node("J/S", meet(j, s), "junction")
    draft.node("K/S", meet(line(draft, MAIN, K), s), "junction")
    draft.node(f"{SHORT} at J", meet(j, line(draft, SHORT, 0.0)), "runway")
    draft.node(f"{CROSS} at J", meet(j, line(draft, CROSS, 0.0)), "runway")


def draw_j(draft: Draft) -> None:
    """Draw J, parallel to runway 01/19: it crosses 04/22 in the south and 15/33 in the north."""
    draft.taxiway("J", "J/A", "J/B")
    draft.entrance("J", "J/B", f"{SHORT} at J", SHORT, "south")
    draft.entrance("J", "J/S", f"{SHORT} at J", SHORT, "north")
    draft.taxiway("J", "J/S", "J/D", "J/E", "J/F")
    draft.entrance("J", "J/F", f"{CROSS} at J", CROSS, "south")
    draft.entrance("J", "J/M", f"{CROSS} at J", CROSS, "north")
    draft.taxiway("J", "J/M", "J/N")


def draw_k(draft: Draft) -> None:
    """Draw K, which passes the gates, and follows 15/33 to the end of 15."""
    stands = {**GATES, **STATIONS}
    junctions = {f"K/{name}": along for name, along in {**stands, **CONNECTORS}.items()}
    for name, along in junctions.items():
        draft.node(name, draft.beside(MAIN, along, K), "junction")
    draft.node("K/north", meet(line(draft, MAIN, K), line(draft, CROSS, BESIDE)), "junction")
    draft.node("K/G", draft.beside(CROSS, 360.0, BESIDE), "junction")
    draft.node("K/P", draft.beside(CROSS, 20.0, BESIDE), "junction")
    draft.taxiway(
        "K", "K/S", *sorted(junctions, key=junctions.__getitem__), "K/north", "K/G", "K/P"
    )
    for name, along in stands.items():
        draft.node(name, draft.beside(MAIN, along, GATE), "stand")
        draft.taxiway("ramp", f"K/{name}", name)


def draw_connectors(draft: Draft) -> None:
    """Draw what joins K, J and runway 01/19; B and M go on to the river side."""
    at = along_main(draft)
    for letter in CONNECTORS:
        draft.taxiway(letter, f"K/{letter}", f"J/{letter}")
    for letter in ("A", *CONNECTORS, "N"):
        draft.entrance(letter, f"J/{letter}", f"{MAIN} at {letter}", MAIN)
    for letter in ("B", "M"):
        draft.node(f"{letter}/east", draft.beside(MAIN, at[letter], -J), "junction")
        draft.entrance(letter, f"J/{letter}", f"{MAIN} at {letter}", MAIN, "west")
        draft.entrance(letter, f"{letter}/east", f"{MAIN} at {letter}", MAIN, "east")
    for letter, along in (("G", 360.0), ("P", 20.0)):
        draft.node(f"{CROSS} at {letter}", draft.beside(CROSS, along, 0.0), "runway")
        draft.entrance(letter, f"K/{letter}", f"{CROSS} at {letter}", CROSS)


def draw_s(draft: Draft) -> None:
    """Draw S, which follows 04/22 past the hangars to the end of 04."""
    draft.node("S/hangar", draft.beside(SHORT, 320.0, -BESIDE), "junction")
    draft.node("hangar_south", draft.beside(SHORT, 320.0, -BESIDE - 75.0), "stand")
    draft.node("S/C", draft.beside(SHORT, 20.0, -BESIDE), "junction")
    draft.taxiway("S", "J/S", "K/S", "S/hangar", "S/C")
    draft.taxiway("ramp", "S/hangar", "hangar_south")
    draft.node(f"{SHORT} at C", draft.beside(SHORT, 20.0, 0.0), "runway")
    draft.entrance("C", "S/C", f"{SHORT} at C", SHORT)


def draw_river_side(draft: Draft) -> None:
    """Draw H to the end of 33, and L to the end of 22."""
    h, river = line(draft, SHORT, BESIDE), line(draft, CROSS, -220.0)
    draft.node("H/bend", draft.beside(SHORT, 890.0, BESIDE), "junction")
    draft.node(f"{CROSS} at H", meet(h, line(draft, CROSS, 0.0)), "runway")
    draft.taxiway("H", "B/east", "H/bend")
    draft.entrance("H", "H/bend", f"{CROSS} at H", CROSS)
    draft.node("L/bend", draft.beside(CROSS, 820.0, -220.0), "junction")
    draft.node(f"{SHORT} at L", meet(river, line(draft, SHORT, 0.0)), "runway")
    draft.taxiway("L", "M/east", "L/bend")
    draft.entrance("L", "L/bend", f"{SHORT} at L", SHORT)


def buildings(draft: Draft) -> tuple[Building, ...]:
    """Return blocks by their extent along and right of a runway."""
    blocks = [
        ("Terminal 1", MAIN, 690, 880, -400, -335, 14),
        ("Terminal 2", MAIN, 900, 1500, -440, -395, 20),
        ("Pier B", MAIN, 955, 995, -395, -310, 15),
        ("Pier C", MAIN, 1130, 1170, -395, -310, 15),
        ("Pier D", MAIN, 1240, 1280, -395, -310, 15),
        ("Pier E", MAIN, 1410, 1450, -395, -310, 15),
        ("Garages", MAIN, 950, 1450, -540, -470, 16),
        ("Fire station", MAIN, 570, 625, -350, -300, 9),
        ("Vehicle base", MAIN, 635, 670, -345, -300, 7),
        ("South hangars", SHORT, 180, 470, -300, -225, 17),
        ("North hangar", CROSS, 300, 420, 190, 260, 17),
        ("Tower", MAIN, 874, 886, -396, -384, 55),
    ]  # fmt: skip
    return tuple(
        Building(
            name=name,
            footprint=draft.corners(
                *(
                    draft.beside(runway, float(along), float(right))
                    for along, right in ((near, west), (far, west), (far, east), (near, east))
                )
            ),
            height_m=float(height),
        )
        for name, runway, near, far, west, east, height in blocks
    )


def cameras(draft: Draft) -> tuple[Camera, ...]:
    """Return cameras on the tower and beside each runway end, outside the protected areas."""
    tower = draft.beside(MAIN, 880.0, -390.0)
    return (
        draft.camera("tower_north", tower, 57.0, 25.0),
        draft.camera("tower_east", tower, 57.0, 90.0),
        draft.camera("tower_south", tower, 57.0, 150.0),
        *draft.runway_cameras(MAIN, 95.0),
        *draft.runway_cameras(CROSS, -95.0),
        *draft.runway_cameras(SHORT, 95.0),
    )


def frequencies(path: Path) -> tuple[Frequency, ...]:
    """Return the frequencies of the file, with the names that the units go by."""
    return tuple(
        Frequency(role="atis", frequency_khz=item.frequency_khz, name="Washington National ATIS")
        if "ASOS" in item.name
        else item.model_copy(update={"name": UNIT_NAMES.get(item.name, item.name)})
        for item in read_frequencies(path, "KDCA")
    )


def length(draft: Draft, runway: str) -> float:
    """Return the length (m) of a runway."""
    return float(draft.strips[runway].centreline.length)


def line(draft: Draft, runway: str, right_m: float) -> tuple[Local, Local]:
    """Return a line parallel to a runway."""
    return draft.beside(runway, 0.0, right_m), draft.beside(runway, 1000.0, right_m)


def meet(first: tuple[Local, Local], second: tuple[Local, Local]) -> Local:
    """Return where two lines cross."""
    (x1, y1), (x2, y2) = first
    (x3, y3), (x4, y4) = second
    across = (x2 - x1) * (y4 - y3) - (y2 - y1) * (x4 - x3)
    part = ((x3 - x1) * (y4 - y3) - (y3 - y1) * (x4 - x3)) / across
    return x1 + part * (x2 - x1), y1 + part * (y2 - y1)


if __name__ == "__main__":
    main(*sys.argv[1:])
