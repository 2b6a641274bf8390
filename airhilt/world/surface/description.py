"""Says in words and numbers what an airport has."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from airhilt.units import DEGREE, FOOT, bearing_degrees
from airhilt.world.surface.layout import Layout


def describe(layout: Layout) -> dict[str, Any]:
    """Return runways, intersections, holds, exits and stands of an airport, ready for JSON."""
    airport = layout.airport
    magnetic = {
        end.ident: end.heading_magnetic_deg for runway in airport.runways for end in runway.ends
    }
    return {
        "icao": airport.icao,
        "name": airport.name,
        "lat_deg": airport.reference.lat_deg,
        "lon_deg": airport.reference.lon_deg,
        "elevation_ft": airport.elevation_ft,
        "variation_east_deg": airport.magnetic_variation.east_deg,
        "runways": [
            {
                "ident": end.ident,
                "length_m": round(end.length_m, 1),
                "width_m": round(end.width_m, 1),
                "displaced_m": round(end.displaced_m, 1),
                "elevation_ft": round(end.elevation_m / FOOT, 1),
                "course_true_deg": round(bearing_degrees(end.course_rad), 2),
                "heading_magnetic_deg": magnetic[end.ident],
                "threshold_deg": [round(angle / DEGREE, 7) for angle in end.threshold],
                "exits": [
                    {"taxiway": way.position, "along_m": round(way.along_m), "hold": way.hold}
                    for way in layout.exits(end.ident)
                ],
            }
            for strip in layout.strips.values()
            for end in strip.ends
        ],
        "intersections": [[first, second] for first, second, _ in layout.intersections],
        "holds": [
            {"runway": hold.runway, "taxiway": hold.position, "node": hold.name}
            for hold in layout.holds.values()
        ],
        "stands": list(layout.stands),
        "frequencies": [item.model_dump() for item in airport.frequencies],
        "synthetic": sorted(name for name, source in airport.sources.items() if source.synthetic),
    }


def as_lines(layout: Layout) -> Iterator[str]:
    """Return the same as lines for a terminal."""
    facts = describe(layout)
    variation = facts["variation_east_deg"]
    yield f"{facts['icao']}  {facts['name']}"
    yield (
        f"  elevation {facts['elevation_ft']:.0f} ft, variation {abs(variation):.1f} degrees "
        f"{'east' if variation >= 0 else 'west'}"
    )
    yield "  runways"
    for end in facts["runways"]:
        displaced = (
            f", threshold displaced {end['displaced_m']:.0f} m" if end["displaced_m"] else ""
        )
        yield (
            f"    {end['ident']:4} {end['length_m']:5.0f} x {end['width_m']:.0f} m, "
            f"course {end['course_true_deg']:.1f} true{displaced}"
        )
        exits = "  ".join(f"{way['taxiway']} {way['along_m']} m" for way in end["exits"])
        yield f"         exits  {exits}"
    for first, second in facts["intersections"]:
        yield f"    {first} crosses {second}"
    yield "  holds"
    for strip in layout.strips:
        here = "  ".join(hold["taxiway"] for hold in facts["holds"] if hold["runway"] == strip)
        yield f"    {strip:7} {here}"
    yield f"  stands  {'  '.join(facts['stands'])}"
    if facts["synthetic"]:
        yield f"  not surveyed: {', '.join(facts['synthetic'])}"
