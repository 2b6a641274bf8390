"""Ground vehicles, in the sizes of their kinds. The origin is the ground below their middle."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.shapes.aircraft import aircraft_meshes
from airhilt.shapes.aircraft.spec import AircraftShape
from airhilt.shapes.colours import (
    AMBER,
    BLACK,
    GLASS,
    GREY,
    LIME,
    ORANGE,
    RED,
    TYRE,
    WHITE,
    YELLOW,
)
from airhilt.shapes.mesh import Colour, Mesh, box, join, tube, wheel
from airhilt.shapes.sizes import Size


def follow_me(size: Size) -> Mesh:
    """Return a pick-up with a chequered board and a light bar."""
    width, length, height = size.span_m, size.length_m, size.height_m
    body = box(YELLOW, width, length, 0.42 * height).moved(up_m=0.22 * height)
    cabin = box(GLASS, 0.92 * width, 0.36 * length, 0.28 * height, 0.86)
    roof = box(YELLOW, 0.8 * width, 0.31 * length, 0.04 * height)
    bar = box(AMBER, 0.7 * width, 0.06 * length, 0.05 * height)
    squares = [
        box(YELLOW if (column + row) % 2 else BLACK, 0.225 * width, 0.1, 0.18 * height).moved(
            (column - 1.5) * 0.225 * width, -0.4 * length, (0.62 + 0.18 * row) * height
        )
        for column in range(4)
        for row in range(2)
    ]
    return join([
        body,
        cabin.moved(ahead_m=0.06 * length, up_m=0.62 * height),
        roof.moved(ahead_m=0.06 * length, up_m=0.9 * height),
        bar.moved(ahead_m=0.06 * length, up_m=0.95 * height),
        *squares,
        *_wheels((-0.32, 0.32), width, length, 0.2 * height),
    ])  # fmt: skip


def fire_truck(size: Size) -> Mesh:
    """Return an airport crash tender with a sloping glass front and a roof turret."""
    width, length, height = size.span_m, size.length_m, size.height_m
    low = 0.18 * height
    hull = join([
        box(RED, width, 0.74 * length, 0.28 * height),
        box(LIME, width, 0.74 * length, 0.46 * height).moved(up_m=0.28 * height),
        box(WHITE, 1.01 * width, 0.742 * length, 0.05 * height).moved(up_m=0.28 * height),
    ])  # fmt: skip
    front = box(RED, width, 0.24 * length, 0.34 * height)
    glass = box(GLASS, 0.97 * width, 0.23 * length, 0.38 * height, 0.88)
    return join([
        hull.moved(ahead_m=-0.12 * length, up_m=low),
        front.moved(ahead_m=0.37 * length, up_m=low),
        glass.moved(ahead_m=0.37 * length, up_m=low + 0.34 * height),
        box(LIME, 0.9 * width, 0.2 * length, 0.05 * height).moved(0, 0.37 * length, 0.9 * height),
        box(GREY, 0.4 * width, 0.1 * length, 0.09 * height).moved(0, 0.2 * length, 0.91 * height),
        tube((0, 0.2 * length, 0.97 * height), (0, 0.36 * length, 0.99 * height), (0.1, 0.07), RED),
        *_wheels((-0.36, -0.24, 0.2, 0.32), width, length, 0.2 * height),
    ])  # fmt: skip


def snow_plough(size: Size) -> Mesh:
    """Return a truck with its blade in front and a sweeper behind."""
    width, length, height = size.span_m, size.length_m, size.height_m
    cab = 0.36 * width
    return join([
        box(ORANGE, cab, 0.12 * length, 0.42 * height).moved(0, 0.3 * length, 0.25 * height),
        box(GLASS, 0.95 * cab, 0.1 * length, 0.28 * height, 0.9).moved(
            0, 0.31 * length, 0.67 * height),
        box(ORANGE, cab, 0.24 * length, 0.55 * height).moved(0, 0.11 * length, 0.25 * height),
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
        box(GLASS, 2.2, 1.6, 0.9, 0.9).moved(0, nose - 1.4, 1.5),
        tube((0, nose - 5.0, 0.7), (0, nose - 11.0, 0.7), (0.1, 0.1), RED),
        *[part.moved(0, nose - 2.5, 0) for part in _wheels((-0.32, 0.32), 2.8, 5.0, 0.55)],
    ])  # fmt: skip


def van(size: Size, colour: Colour = WHITE) -> Mesh:
    """Return a van of some size, for kinds of vehicles that have no mesh of their own."""
    width, length, height = size.span_m, size.length_m, size.height_m
    return join([
        box(colour, width, length, 0.8 * height, 0.94).moved(up_m=0.2 * height),
        box(GLASS, 0.97 * width, 0.12 * length, 0.3 * height).moved(
            0, 0.435 * length, 0.55 * height),
        *_wheels((-0.3, 0.3), width, length, 0.2 * height),
    ])  # fmt: skip


def _wheels(along: tuple[float, ...], width: float, length: float, radius: float) -> Iterator[Mesh]:
    for part in along:
        for side in (-1.0, 1.0):
            yield wheel(TYRE, radius, 0.25 * radius + 0.12).moved(
                side * (0.5 * width - 0.1), part * length, radius
            )
