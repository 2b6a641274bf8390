"""Ground vehicles, in the sizes of their kinds. The origin is the ground below their middle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from airhilt.shapes.aircraft import aircraft_meshes
from airhilt.shapes.aircraft.spec import AircraftShape
from airhilt.shapes.colours import (
    AMBER,
    BLACK,
    DARK,
    GLASS,
    GREY,
    LIME,
    ORANGE,
    RED,
    SILVER,
    TYRE,
    WHITE,
    YELLOW,
)
from airhilt.shapes.mesh import Colour, Mesh, box, join, loft, tube, wheel
from airhilt.shapes.sizes import Size

PANE_M = 0.02
"""Distance by which panes, lamps and grilles stand out, in m."""
PICK_UP: tuple[tuple[Colour, Sequence[tuple[float, float]], float, float], ...] = (
    (
        YELLOW,
        ((0.5, 0.24), (0.5, 0.5), (0.46, 0.56), (0.2, 0.62), (-0.5, 0.62), (-0.5, 0.24)),
        1,
        1,
    ),
    (YELLOW, ((0.2, 0.62), (0.1, 0.95), (-0.1, 0.95), (-0.15, 0.62)), 0.96, 0.8),
    (GLASS, ((0.205, 0.645), (0.118, 0.93), (0.108, 0.93), (0.19, 0.645)), 0.86, 0.7),
    (GLASS, ((-0.154, 0.66), (-0.111, 0.92), (-0.102, 0.92), (-0.14, 0.66)), 0.8, 0.7),
    (GLASS, ((0.165, 0.66), (0.09, 0.9), (0.015, 0.9), (0.015, 0.66)), 0.955, 0.835),
    (GLASS, ((-0.01, 0.66), (-0.01, 0.9), (-0.085, 0.9), (-0.12, 0.66)), 0.955, 0.835),
)
"""Parts of a pick-up: its body, cabin, windscreen, rear window, and windows beside.

Each has a colour, its side (places ahead and up), and its widths at foot and top: all of them as
parts of the whole."""


def follow_me(size: Size) -> Mesh:
    """Return a pick-up with a chequered board and a light bar."""
    width, length, height = size.span_m, size.length_m, size.height_m
    squares = [
        box(YELLOW if (column + row) % 2 else BLACK, 0.225 * width, 0.1, 0.18 * height).moved(
            (column - 1.5) * 0.225 * width, -0.4 * length, (0.62 + 0.18 * row) * height
        )
        for column in range(4)
        for row in range(2)
    ]
    return join([
        *(
            _side_to_side(colour, [(along * length, up * height) for along, up in side],
                          low * width, high * width)
            for colour, side, low, high in PICK_UP
        ),
        box(DARK, 0.86 * width, 0.3 * length, PANE_M).moved(0, -0.33 * length, 0.62 * height),
        box(AMBER, 0.7 * width, 0.06 * length, 0.05 * height).moved(up_m=0.95 * height),
        *_ends(width, length, 0.22 * height, 0.3 * height),
        *squares,
        *_wheels((-0.32, 0.32), width, length, 0.2 * height),
    ])  # fmt: skip


def fire_truck(size: Size) -> Mesh:
    """Return an airport crash tender with shutters along it and a turret on its roof."""
    width, length, height = size.span_m, size.length_m, size.height_m
    low = 0.18 * height
    hull = join([
        box(RED, width, 0.74 * length, 0.28 * height),
        box(LIME, width, 0.74 * length, 0.46 * height).moved(up_m=0.28 * height),
        box(WHITE, 1.01 * width, 0.742 * length, 0.05 * height).moved(up_m=0.28 * height),
        *(
            box(SILVER, 1.012 * width, 0.13 * length, 0.3 * height).moved(
                0, at * length, 0.38 * height)
            for at in (-0.27, -0.1, 0.07)
        ),
        box(GREY, 0.5 * width, 0.744 * length, 0.3 * height).moved(up_m=0.38 * height),
    ])  # fmt: skip
    cab = _cab(RED, width, 0.24 * length, 0.72 * height, 0.42)
    return join([
        hull.moved(ahead_m=-0.12 * length, up_m=low),
        cab.moved(ahead_m=0.37 * length, up_m=low),
        box(LIME, 0.9 * width, 0.2 * length, 0.05 * height).moved(0, 0.37 * length, 0.9 * height),
        box(GREY, 0.4 * width, 0.1 * length, 0.09 * height).moved(0, 0.2 * length, 0.91 * height),
        tube((0, 0.2 * length, 0.97 * height), (0, 0.36 * length, 0.99 * height), (0.1, 0.07), RED),
        *_ends(width, length, low, 0.18 * height),
        *_wheels((-0.36, -0.24, 0.2, 0.32), width, length, 0.2 * height),
    ])  # fmt: skip


def snow_plough(size: Size) -> Mesh:
    """Return a truck with its blade in front and a sweeper behind."""
    width, length, height = size.span_m, size.length_m, size.height_m
    cab = 0.36 * width
    return join([
        box(DARK, 0.4 * cab, 0.8 * length, 0.08 * height).moved(0, -0.05 * length, 0.2 * height),
        _cab(ORANGE, cab, 0.13 * length, 0.7 * height, 0.5).moved(
            0, 0.3 * length, 0.25 * height),
        box(ORANGE, cab, 0.22 * length, 0.55 * height).moved(0, 0.1 * length, 0.25 * height),
        *(
            box(DARK, 1.02 * cab, 0.008 * length, 0.5 * height).moved(
                0, at * length, 0.27 * height)
            for at in (0.03, 0.1, 0.17, -0.38, -0.28, -0.18)
        ),
        box(AMBER, 0.6 * cab, 0.02 * length, 0.05 * height).moved(0, 0.31 * length, 0.95 * height),
        box(YELLOW, width, 0.05 * length, 0.32 * height, 0.96).moved(0, 0.47 * length, 0.02),
        box(ORANGE, cab, 0.34 * length, 0.5 * height).moved(0, -0.28 * length, 0.25 * height),
        tube((-0.45 * width, -0.2 * length, 0.16 * height), (0.45 * width, -0.2 * length,
             0.16 * height), (0.16 * height, 0.16 * height), BLACK, 12),
        *_wheels((-0.4, -0.33, 0.04, 0.12, 0.3), cab, length, 0.15 * height),
    ])  # fmt: skip


def tug_with_aircraft(size: Size, aircraft: AircraftShape) -> Mesh:
    """Return a tug, its towbar and an aircraft behind it, which is as wide as the whole."""
    length, own = size.length_m, aircraft.dimensions
    towed = aircraft_meshes(aircraft)["gear"]
    stretch = size.span_m / own.span_m
    towed = towed.moved(up_m=own.wheel_height_offset_m).stretched(stretch, stretch, 1.0)
    aft = -length / 2.0 + own.length_m * stretch / 2.0
    nose = length / 2.0
    return join([
        towed.moved(ahead_m=aft),
        box(YELLOW, 2.8, 5.0, 1.0).moved(0, nose - 2.5, 0.5),
        _cab(YELLOW, 2.2, 1.6, 1.0, 0.1).moved(0, nose - 1.4, 1.5),
        tube((0, nose - 5.0, 0.7), (0, nose - 11.0, 0.7), (0.1, 0.1), RED),
        *[part.moved(0, nose - 2.5, 0) for part in _ends(2.8, 5.0, 0.5, 0.8)],
        *[part.moved(0, nose - 2.5, 0) for part in _wheels((-0.32, 0.32), 2.8, 5.0, 0.55)],
    ])  # fmt: skip


def van(size: Size, colour: Colour = WHITE) -> Mesh:
    """Return a van of some size, for kinds of vehicles that have no mesh of their own."""
    width, length, height = size.span_m, size.length_m, size.height_m
    return join([
        box(colour, width, 0.74 * length, 0.8 * height, 0.96).moved(
            0, -0.13 * length, 0.2 * height),
        _cab(colour, width, 0.26 * length, 0.72 * height, 0.5).moved(
            0, 0.37 * length, 0.2 * height),
        *_ends(width, length, 0.2 * height, 0.25 * height),
        *_wheels((-0.3, 0.3), width, length, 0.2 * height),
    ])  # fmt: skip


def _side_to_side(
    colour: Colour, side: Sequence[tuple[float, float]], low_m: float, high_m: float
) -> Mesh:
    """Return a body as its side is, ahead and up, of one width at its foot and one at its top."""
    foot, top = min(up for _, up in side), max(up for _, up in side)
    halves = [
        0.5 * (low_m + (high_m - low_m) * (up - foot) / max(top - foot, 1e-6)) for _, up in side
    ]
    rings = [
        [(way * half, along, up) for half, (along, up) in zip(halves, side, strict=True)]
        for way in (-1.0, 1.0)
    ]
    return loft(rings, colour, closed=True)


def _cab(colour: Colour, width: float, length: float, height: float, sill: float) -> Mesh:
    """Return a driver's cab with panes in front and beside from a part of its height on."""
    pane, up = 0.8 * (1.0 - sill) * height, (sill + 0.06) * height
    mirror = box(DARK, 0.12, 0.12, 0.8 * pane)
    return join([
        box(colour, width, length, height, 0.97),
        box(GLASS, 0.86 * width, length + PANE_M, pane, 0.98).moved(0, 0.01 * length, up),
        box(GLASS, width + PANE_M, 0.55 * length, pane, 0.98).moved(0, 0.14 * length, up),
        *(mirror.moved(way * (0.5 * width + 0.1), 0.5 * length, up) for way in (-1.0, 1.0)),
    ])  # fmt: skip


def _ends(width: float, length: float, low: float, tall: float) -> Iterator[Mesh]:
    """Yield bumpers, a grille, and lamps in front and behind, above a height."""
    yield box(DARK, width + PANE_M, length + 4.0 * PANE_M, 0.35 * tall).moved(up_m=low)
    yield box(DARK, 0.5 * width, PANE_M, 0.5 * tall).moved(0, 0.5 * length, low + 0.45 * tall)
    for way in (-1.0, 1.0):
        lamp = way * 0.38 * width
        yield box(WHITE, 0.16 * width, PANE_M, 0.35 * tall).moved(
            lamp, 0.5 * length, low + 0.5 * tall
        )
        yield box(RED, 0.12 * width, PANE_M, 0.4 * tall).moved(
            lamp, -0.5 * length, low + 0.5 * tall
        )


def _wheels(along: tuple[float, ...], width: float, length: float, radius: float) -> Iterator[Mesh]:
    for part in along:
        for side in (-1.0, 1.0):
            at = side * (0.5 * width - 0.1), part * length, radius
            yield wheel(TYRE, radius, 0.25 * radius + 0.12).moved(*at)
            yield wheel(SILVER, 0.55 * radius, 0.25 * radius + 0.14).moved(*at)
