"""Deer, coyotes and birds, in the sizes of their kinds. The origin is the ground below them."""

from __future__ import annotations

import math

import numpy as np

from airhilt.shapes.mesh import Colour, Floats, Mesh, ellipsoid, join, loft, srgb, tube
from airhilt.shapes.sizes import Size
from airhilt.sim.streams import stream

FAWN = srgb(150, 102, 62)
CREAM = srgb(226, 208, 180)
BROWN = srgb(92, 64, 42)
ANTLER = srgb(190, 168, 132)
SANDY = srgb(160, 132, 96)
ASH = srgb(112, 98, 84)
GOOSE_BACK = srgb(110, 92, 74)
GOOSE_NECK = srgb(22, 22, 24)
STARLING = srgb(30, 30, 36)
FLAP_RAD = math.radians(38.0)
"""Greatest angle of a beating wing."""
WING_BEATS = 4
"""Positions of a wing in one beat."""
WING = (
    (0.0, 0.9, 1.0),
    (0.2, 1.0, 1.15),
    (0.45, 1.05, 1.0),
    (0.7, 0.85, 0.75),
    (0.9, 0.55, 0.6),
    (1.0, 0.15, 0.5),
)
"""Parts of the half span, of the chord and of the angle of a beat, from the root of a wing out."""
TWIST = 0.25
"""Drop of the rear of a wing, as a part of its chord."""


def deer(size: Size) -> Mesh:
    """Return a white-tailed deer."""
    return _quadruped(size, FAWN, CREAM, neck_rise=0.36, antlers=True, tail=0.05)


def coyote(size: Size) -> Mesh:
    """Return a coyote."""
    return _quadruped(size, SANDY, ASH, neck_rise=0.1, antlers=False, tail=0.3)


def goose(size: Size, beat: int | None = None) -> Mesh:
    """Return a Canada goose: standing, or in the air with its wings at a part of their beat."""
    return _bird(size, GOOSE_BACK, GOOSE_NECK, beat, sides=8)


def flock(size: Size, beat: int | None = None, *, count: int) -> Mesh:
    """Return small birds within an ellipsoid of the flock's size."""
    places = stream(count, "birds of a flock").normal(size=(count, 3))
    places /= np.linalg.norm(places, axis=1, keepdims=True)
    radii = stream(count, "their distances").uniform(size=(count, 1)) ** (1.0 / 3.0)
    half = np.array((size.span_m, size.length_m, size.height_m)) / 2.0
    middle = (0.0, 0.0, half[2])
    places = places * radii * half + middle
    if beat is None:
        places[:, 2] = 0.0
    span = 0.37 if beat is not None else 0.12
    phases = [None] if beat is None else [(beat + step) % WING_BEATS for step in range(WING_BEATS)]
    kinds = [_small_bird(span, phase) for phase in phases]
    return join([kinds[k % len(kinds)].moved(*place) for k, place in enumerate(places.tolist())])


def _quadruped(
    size: Size, coat: Colour, under: Colour, *, neck_rise: float, antlers: bool, tail: float
) -> Mesh:
    length, height, width = size.length_m, size.height_m, size.span_m
    shoulder = (1.0 - neck_rise) * height
    trunk = length * (0.72 - tail)
    deep = 0.2 * shoulder + 0.07 * length

    def paint(centres: Floats) -> Floats:
        return np.where(centres[:, 2:] < -0.55 * deep, np.asarray(under), np.asarray(coat))

    middle = length * (0.5 - 0.28) - trunk / 2.0
    body = ellipsoid(paint, 0.42 * width, 0.56 * trunk, deep, 12, 9)
    top = shoulder - deep
    front, back = middle + 0.42 * trunk, middle - 0.42 * trunk
    head_at = (0.0, length * 0.5 - 0.11 * length, height - 0.09 * height)
    neck = tube(
        (0.0, front, top + 0.15 * deep), head_at, (0.17 * width + 0.35 * deep, 0.14 * width), coat
    )
    head = ellipsoid(coat, 0.16 * width, 0.11 * length, 0.07 * height).moved(*head_at)
    parts = [body.moved(0.0, middle, top), neck, head]
    for side in (-1.0, 1.0):
        parts.append(
            tube(
                (side * 0.1 * width, head_at[1] - 0.04 * length, head_at[2] + 0.02),
                (side * 0.3 * width, head_at[1] - 0.07 * length, head_at[2] + 0.1 * height),
                (0.04 * height, 0.01),
                coat,
                6,
            )
        )
        for at, stride in ((front, 0.07), (back, -0.06)):
            hip = (side * 0.24 * width, at, top)
            parts += _leg(hip, stride * side * length, 0.28 * deep, coat)
        if antlers:
            parts += _antler(side, head_at, height)
    parts.append(
        tube(
            (0.0, middle - 0.5 * trunk, top + 0.3 * deep),
            (
                0.0,
                middle - 0.5 * trunk - max(tail, 0.05) * length,
                top - (0.5 if tail > 0.1 else 0.1) * deep,
            ),
            (0.12 * deep, 0.3 * deep),
            under if antlers else coat,
            7,
        )
    )
    return join(parts)


def _leg(
    hip: tuple[float, float, float], stride_m: float, thigh_m: float, coat: Colour
) -> list[Mesh]:
    """Return a leg from the hip to a foot on the ground, a stride ahead."""
    right, at, top = hip
    knee = (right, at + 0.4 * stride_m, 0.48 * top)
    return [
        tube(hip, knee, (thigh_m, 0.035), coat, 7),
        tube(knee, (right, at + stride_m, 0.0), (0.035, 0.022), coat, 6),
    ]


def _antler(side: float, head: tuple[float, float, float], height: float) -> list[Mesh]:
    root = (side * 0.04, head[1] - 0.03, head[2] + 0.06 * height)
    bend = (side * 0.2, head[1] - 0.12, head[2] + 0.16 * height)
    tip = (side * 0.16, head[1] + 0.12, head[2] + 0.25 * height)
    tine = (side * 0.26, head[1] - 0.02, head[2] + 0.24 * height)
    return [
        tube(root, bend, (0.02, 0.016), ANTLER, 5),
        tube(bend, tip, (0.016, 0.008), ANTLER, 5),
        tube(bend, tine, (0.014, 0.006), ANTLER, 5),
    ]


def _bird(size: Size, back: Colour, neck: Colour, beat: int | None, sides: int) -> Mesh:
    length, height = size.length_m, size.height_m
    flying = beat is not None
    up = 0.5 * height if flying else 0.45 * height
    girth = 0.11 * length if flying else 0.34 * size.span_m

    def paint(centres: Floats) -> Floats:
        return np.where(centres[:, 2:] < -0.3 * girth, np.asarray(CREAM), np.asarray(back))

    body = ellipsoid(paint, girth, 0.32 * length, girth, sides, 7).moved(0.0, -0.06 * length, up)
    head = (0.0, 0.44 * length, up + 0.02) if flying else (0.0, 0.36 * length, 0.93 * height)
    parts = [
        body,
        tube((0.0, 0.18 * length, up + 0.3 * girth), head, (0.5 * girth, 0.3 * girth), neck, 7),
        ellipsoid(neck, 0.35 * girth, 0.07 * length, 0.35 * girth, 7, 5).moved(*head),
        _tail(0.9 * girth, 0.5 * length, back).moved(up_m=up),
    ]
    if beat is None:
        parts += [
            tube((side * 0.05, -0.02, 0.0), (side * 0.05, -0.02, up), (0.015, 0.02), BROWN, 5)
            for side in (-1.0, 1.0)
        ]
    else:
        wing = _wing(size.span_m / 2.0, 0.26 * length, beat, back).moved(0.0, 0.06 * length, up)
        parts += [wing, wing.mirrored()]
    return join(parts)


def _small_bird(span_m: float, beat: int | None) -> Mesh:
    body = ellipsoid(STARLING, 0.03, 0.1, 0.03, 5, 3)
    if beat is None:
        return body.moved(up_m=0.1)
    wing = _wing(span_m / 2.0, 0.1, beat, STARLING)
    return join([body, wing, wing.mirrored()])


def _tail(half_m: float, back_m: float, colour: Colour) -> Mesh:
    """Return the feathers of a tail, spread to its end."""
    root, thick = 0.55 * back_m, 0.08 * half_m
    return loft(
        [
            [(-wide, -at, -thick), (wide, -at, -thick), (wide, -at, thick), (-wide, -at, thick)]
            for at, wide in ((root, 0.5 * half_m), (back_m, half_m))
        ],
        colour,
        closed=True,
    )


def _wing(half_span_m: float, chord_m: float, beat: int, colour: Colour) -> Mesh:
    """Return the right wing: thin, bent at the wrist, and turned up in front as it beats."""
    angle = FLAP_RAD * math.sin(math.tau * beat / WING_BEATS + 0.4)
    rings = []
    x = z = last = 0.0
    for out, chord, bend in WING:
        x += half_span_m * (out - last) * math.cos(bend * angle)
        z += half_span_m * (out - last) * math.sin(bend * angle)
        last = out
        back, thick, deep = chord * chord_m, 0.05 * chord_m, TWIST * chord * chord_m
        ahead = -0.15 * chord_m * max(0.0, out - 0.4)
        rings.append([
            (x, ahead - back, z - deep),
            (x, ahead - 0.4 * back, z + thick),
            (x, ahead, z),
            (x, ahead - 0.4 * back, z - thick - 0.3 * deep),
        ])  # fmt: skip
    return loft(rings, colour, closed=True)
