"""Header, scale, north arrow and legend of a diagram."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence

from airhilt.units import FOOT
from airhilt.world.surface.airport import Airport, Frequency, Role
from airhilt.world.surface.chart import svg
from airhilt.world.surface.chart.view import HEADER_PX, View
from airhilt.world.surface.ground_plan import GroundPlan

VHF_KHZ = (117_975, 137_000)
"""The aeronautical mobile band, in kHz: ICAO Annex 10 volume V, 4.1."""
SHOWN_ROLES: tuple[Role, ...] = ("tower", "ground", "clearance", "approach", "departure", "atis")
LEGEND = (
    ('<line class="hold" x1="0" y1="0" x2="14" y2="0"/>', "hold line"),
    ('<rect class="protected" x="0" y="-5" width="14" height="10"/>', "protected area"),
    ('<circle class="crossing" cx="7" cy="0" r="5"/>', "intersection"),
    ('<polygon class="tower" points="7,-7 12,5 2,5"/>', "tower"),
    ('<polygon class="camera" points="0,5 14,0 10,9"/>', "camera"),
    ('<circle class="stand" cx="7" cy="0" r="3"/>', "stand"),
)
"""Symbols of the legend, and what they stand for."""


def margin(airport: Airport, plan: GroundPlan, view: View) -> Iterator[str]:
    """Yield everything that stands beside the map."""
    variation = airport.magnetic_variation
    side = "E" if variation.east_deg >= 0.0 else "W"
    yield svg.text("title", (16.0, 26.0), f"{airport.icao}  {airport.name}", anchor="start")
    facts = (
        f"elevation {airport.elevation_ft:.0f} ft ({airport.elevation_ft * FOOT:.0f} m) · "
        f"variation {abs(variation.east_deg):.1f}° {side} ({variation.epoch:.1f}) · "
        f"{len(plan.runways)} runways, {len(plan.holds)} holds"
    )
    yield svg.text("line", (16.0, 48.0), facts, anchor="start")
    yield svg.text("line", (16.0, 68.0), _frequencies(airport.frequencies), anchor="start")
    yield from _north_arrow(view, variation.east_deg)
    yield from _scale_bar(view)
    yield from _legend(view)
    invented = sorted(block for block, source in airport.sources.items() if source.synthetic)
    if invented:
        note = f"Not surveyed, drawn or generated: {', '.join(invented)}. Not for navigation."
        yield svg.text("small", (16.0, view.height - 12.0), note, anchor="start")


def _frequencies(frequencies: Sequence[Frequency]) -> str:
    by_role = defaultdict(list)
    for item in frequencies:
        if VHF_KHZ[0] <= item.frequency_khz <= VHF_KHZ[1]:
            by_role[item.role].append(f"{item.frequency_khz / 1000.0:g}")
    return " · ".join(
        f"{'ATIS' if role == 'atis' else role} {' '.join(by_role[role][:2])}"
        for role in SHOWN_ROLES
        if role in by_role
    )


def _north_arrow(view: View, variation_deg: float) -> Iterator[str]:
    """Yield an arrow to true north, and a dashed line to magnetic north."""
    x, y = view.width - 40.0, HEADER_PX + 62.0
    yield f'<polygon class="solid" points="{x},{y - 42} {x + 7},{y} {x},{y - 9} {x - 7},{y}"/>'
    yield svg.text("line", (x, y + 11.0), "N")
    declination = math.radians(variation_deg)
    tip = x + 44.0 * math.sin(declination), y - 44.0 * math.cos(declination)
    yield svg.line("ink", ((x, y), tip), ' stroke-dasharray="3 2"')


def _scale_bar(view: View) -> Iterator[str]:
    metres = next(m for m in (2000, 1000, 500, 200, 100) if m * view.scale <= view.width / 4.0)
    x, y = 16.0, view.height - 40.0
    right = x + metres * view.scale
    yield f'<path class="ink" d="M{x} {y - 5}V{y}H{right:.1f}V{y - 5}"/>'
    yield svg.text("small", (right + 6.0, y - 2.0), f"{metres} m", anchor="start")
    yield svg.text("small", (x, y + 12.0), f"{metres / FOOT:.0f} ft", anchor="start")


def _legend(view: View) -> Iterator[str]:
    x, y = max(view.width / 3.0, 240.0), view.height - 42.0
    for symbol, name in LEGEND:
        yield f'<g transform="translate({x:.1f} {y:.1f})">{symbol}</g>'
        yield svg.text("small", (x + 18.0, y), name, anchor="start")
        x += 28.0 + 6.2 * len(name)
