"""The paint on runways and taxiways, as polygons in local metres (east, north).

Sizes are those of FAA AC 150/5340-1M, Standards for Airport Markings, chapter 2 for runways with
precision approaches and chapter 4 for taxiways.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from shapely import LineString, Point, Polygon, affinity, box, transform
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.units import FOOT

if TYPE_CHECKING:  # An airport brings in NetworkX, which en route nobody needs.
    from airhilt.world.surface.layout import Hold
    from airhilt.world.surface.path import Local
    from airhilt.world.surface.runway import RunwayEnd
    from airhilt.world.surface.strips import RunwayStrip

THRESHOLD_STRIPES = ((60.0, 4), (75.0, 6), (100.0, 8), (150.0, 12), (200.0, 16))
"""Runway width in feet, number of stripes: table 2-2."""
STRIPE_M = 5.75 * FOOT
"""Width of a threshold stripe, and of the gap between two: paragraph 2.5."""
STRIPE_LENGTH_M = 150.0 * FOOT
FIRST_STRIPE_M = 20.0 * FOOT
"""Distance of the first stripe from the threshold, in m."""
DESIGNATOR_M = FIRST_STRIPE_M + STRIPE_LENGTH_M + 40.0 * FOOT
"""Distance from the threshold to the foot of the designator, in m: figure 2-1."""
CHARACTER_M = (20.0 * FOOT, 60.0 * FOOT)
CENTRE_WIDTH_M = 3.0 * FOOT
CENTRE_STRIPE_M = 120.0 * FOOT
CENTRE_GAP_M = 80.0 * FOOT
AIM_POINT_M = 1020.0 * FOOT
AIM_SIZE_M = (30.0 * FOOT, 150.0 * FOOT)
AIM_INNER_M = 36.0 * FOOT
"""Distance of the inner edges of aiming point and touchdown zone from the centre line, in m."""
ZONE_BARS = ((500.0, 3), (1500.0, 2), (2000.0, 2), (2500.0, 1), (3000.0, 1))
"""Distance from the threshold in ft, and number of bars on each side: paragraph 2.7."""
BAR_M = (6.0 * FOOT, 75.0 * FOOT)
BAR_GAP_M = 5.0 * FOOT
EDGE_M = 3.0 * FOOT
TOUCHDOWN_M = 450.0
"""Distance from the threshold about which aircraft touch down, in m."""
RUBBER_M = ((3.0, 1.4, 330.0), (4.8, 1.8, 260.0))
"""Distance of tracks of wheels from the centre line, half width and half length, in m: the main
wheels of airliners are 5.7 to 11 m apart."""
TAXI_LINE_M = 1.0 * FOOT
"""Width of a taxiway line, in m: the wider of the two that paragraph 4.2 allows."""
HOLD_LINE_M = 1.0 * FOOT
"""Width of each of the four lines across a taxiway, and of the spaces: paragraph 4.3."""
HOLD_DASH_M = 3.0 * FOOT

_STROKES: dict[str, tuple[tuple[tuple[float, float], ...], ...]] = {
    "0": (((0.1, 0.1), (0.9, 0.1), (0.9, 0.9), (0.1, 0.9), (0.1, 0.1)),),
    "1": (((0.5, 0.0), (0.5, 1.0), (0.25, 0.85)),),
    "2": (((0.1, 0.9), (0.9, 0.9), (0.9, 0.55), (0.1, 0.08), (0.95, 0.08)),),
    "3": (((0.1, 0.92), (0.9, 0.92), (0.45, 0.58), (0.9, 0.5), (0.9, 0.08), (0.05, 0.08)),),
    "4": (((0.7, 0.0), (0.7, 1.0), (0.1, 0.35), (1.0, 0.35)),),
    "5": (((0.9, 0.92), (0.15, 0.92), (0.15, 0.55), (0.9, 0.55), (0.9, 0.08), (0.05, 0.08)),),
    "6": (((0.8, 0.95), (0.1, 0.4), (0.1, 0.08), (0.9, 0.08), (0.9, 0.45), (0.1, 0.45)),),
    "7": (((0.05, 0.92), (0.9, 0.92), (0.4, 0.0)),),
    "8": (((0.1, 0.08), (0.9, 0.08), (0.9, 0.92), (0.1, 0.92), (0.1, 0.08)),
          ((0.1, 0.5), (0.9, 0.5))),
    "9": (((0.2, 0.05), (0.9, 0.6), (0.9, 0.92), (0.1, 0.92), (0.1, 0.55), (0.9, 0.55)),),
    "L": (((0.15, 1.0), (0.15, 0.08), (0.95, 0.08)),),
    "R": (((0.12, 0.0), (0.12, 0.92), (0.88, 0.92), (0.88, 0.5), (0.12, 0.5)),
          ((0.45, 0.5), (0.95, 0.0))),
    "C": (((0.95, 0.92), (0.12, 0.92), (0.12, 0.08), (0.95, 0.08)),),
}  # fmt: skip
"""Characters as strokes in a unit square."""


def runway_paint(strip: RunwayStrip, local_frame: LocalFrame) -> BaseGeometry:
    """Return all white paint of a runway."""
    marks: list[BaseGeometry] = []
    for end in strip.ends:
        marks += [_placed(mark, end, local_frame) for mark in _end_paint(end)]
    low, high = strip.ends
    marks += [
        _placed(mark, low, local_frame)
        for mark in _along_paint(
            low.length_m - low.displaced_m - high.displaced_m, low.width_m, low.displaced_m
        )
    ]
    return unary_union(marks).intersection(strip.pavement)


def rubber(strip: RunwayStrip, local_frame: LocalFrame) -> Iterator[BaseGeometry]:
    """Yield the tracks of main wheels where aircraft touch down at each end of a runway."""
    for end in strip.ends:
        for side in (-1.0, 1.0):
            for inner, outer, reach in RUBBER_M:
                middle = Point(side * inner, TOUCHDOWN_M)
                yield _placed(affinity.scale(middle.buffer(1.0), outer, reach), end, local_frame)


def _placed(mark: BaseGeometry, end: RunwayEnd, local_frame: LocalFrame) -> BaseGeometry:
    """Return a mark, given right of and beyond the threshold, in local metres."""
    east, north = local_frame.to_local(end.threshold)
    along = np.subtract(local_frame.to_local(end.end), (east, north))
    along = along / np.hypot(*along)
    across = np.array((along[1], -along[0]))
    return transform(mark, lambda xy: xy[:, :1] * across + xy[:, 1:] * along + (east, north))


def _end_paint(end: RunwayEnd) -> Iterator[BaseGeometry]:
    width_ft = end.width_m / FOOT
    count = next((n for width, n in reversed(THRESHOLD_STRIPES) if width <= width_ft + 1.0), 4)
    for number in range(count // 2):
        inner = STRIPE_M + number * 2.0 * STRIPE_M
        yield from _both_sides(inner, STRIPE_M, FIRST_STRIPE_M, STRIPE_LENGTH_M)
    yield from _designator(end.ident)
    if end.length_m >= 4200.0 * FOOT:
        yield from _both_sides(AIM_INNER_M, AIM_SIZE_M[0], AIM_POINT_M, AIM_SIZE_M[1])
        for along_ft, bars in ZONE_BARS:
            if along_ft * FOOT > end.length_m / 2.0 - 900.0 * FOOT:
                continue
            for number in range(bars):
                inner = AIM_INNER_M + number * (BAR_M[0] + BAR_GAP_M)
                yield from _both_sides(inner, BAR_M[0], along_ft * FOOT, BAR_M[1])
    if end.displaced_m > 1.0:
        yield box(-end.width_m / 2.0, -10.0 * FOOT, end.width_m / 2.0, 0.0)


def _along_paint(length_m: float, width_m: float, before_m: float) -> Iterator[BaseGeometry]:
    half = width_m / 2.0
    for side in (-1.0, 1.0):
        edge = side * (half - EDGE_M)
        yield box(min(edge, side * half), -before_m, max(edge, side * half), length_m)
    first = DESIGNATOR_M + CHARACTER_M[1] + 40.0 * FOOT
    step = CENTRE_STRIPE_M + CENTRE_GAP_M
    count = max(int((length_m - 2.0 * first + CENTRE_GAP_M) // step), 0)
    spare = length_m - 2.0 * first - count * step + CENTRE_GAP_M
    for number in range(count):
        begin = first + spare / 2.0 + number * step
        yield box(-CENTRE_WIDTH_M / 2.0, begin, CENTRE_WIDTH_M / 2.0, begin + CENTRE_STRIPE_M)


def _both_sides(inner: float, width: float, begin: float, length: float) -> Iterator[Polygon]:
    for side in (-1.0, 1.0):
        near, far = side * inner, side * (inner + width)
        yield box(min(near, far), begin, max(near, far), begin + length)


def _designator(ident: str) -> Iterator[BaseGeometry]:
    """Yield the characters of a designator; a single digit has no zero before it (2.3.c)."""
    digits = ident.rstrip("LRC").lstrip("0")
    letter = ident[len(ident.rstrip("LRC")) :]
    foot = DESIGNATOR_M
    rows = [digits] if not letter else [letter, digits]
    for row in rows:
        total = len(row) * CHARACTER_M[0] + (len(row) - 1) * 15.0 * FOOT
        for number, character in enumerate(row):
            left = -total / 2.0 + number * (CHARACTER_M[0] + 15.0 * FOOT)
            yield _character(character, left, foot)
        foot += CHARACTER_M[1] + 20.0 * FOOT


def _character(character: str, left: float, foot: float) -> BaseGeometry:
    strokes = [
        LineString([(x * CHARACTER_M[0], y * CHARACTER_M[1]) for x, y in stroke]).buffer(
            5.0 * FOOT / 2.0 + 0.35, cap_style="square", join_style="mitre"
        )
        for stroke in _STROKES[character]
    ]
    return affinity.translate(unary_union(strokes), left, foot)


def taxiway_lines(legs: Sequence[tuple[Local, Local]]) -> BaseGeometry:
    """Return the yellow centre lines of taxiways."""
    return unary_union(
        [LineString(leg).buffer(TAXI_LINE_M / 2.0, cap_style="flat") for leg in legs]
    )


def hold_lines(hold: Hold, local_frame: LocalFrame, width_m: float) -> list[BaseGeometry]:
    """Return the two solid and two dashed lines of a holding position: the dashes are nearer."""
    east, north = local_frame.to_local(hold.place)
    ahead = math.sin(hold.heading_rad), math.cos(hold.heading_rad)
    across = ahead[1], -ahead[0]

    def mark(begin: float, left: float, right: float) -> Polygon:
        return Polygon([
            (east + ahead[0] * along + across[0] * side,
             north + ahead[1] * along + across[1] * side)
            for along, side in ((begin, left), (begin, right), (begin + HOLD_LINE_M, right),
                                (begin + HOLD_LINE_M, left))
        ])  # fmt: skip

    half = width_m / 2.0
    marks: list[BaseGeometry] = [mark(number * 2.0 * HOLD_LINE_M, -half, half) for number in (0, 1)]
    for number in (2, 3):
        left = -half
        while left < half:
            marks.append(mark(number * 2.0 * HOLD_LINE_M, left, min(left + HOLD_DASH_M, half)))
            left += 2.0 * HOLD_DASH_M
    return marks
