"""Aircraft, lofted from the numbers of their ``aircraft/*.json``.

The origin is the reference point of the flight model: half the length behind the nose, and
``wheel_height_offset_m`` above the ground when the aircraft stands on its wheels.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from airhilt.shapes.mesh import (
    Colour,
    Floats,
    Mesh,
    Paint,
    box,
    ellipsoid,
    join,
    loft,
    srgb,
    tube,
    wheel,
)
from airhilt.world.flight.aircraft_type import AircraftType
from airhilt.world.truth.outlines import TAIL_CHORD_PART, TAIL_ROOT_AT, WING_ROOT_AT

WHITE = srgb(238, 240, 243)
SILVER = srgb(178, 184, 190)
GREY = srgb(120, 126, 132)
DARK = srgb(38, 42, 48)
GLASS = srgb(26, 34, 44)
TYRE = srgb(30, 30, 32)
BLADE = srgb(60, 60, 62)
SEGMENTS = 28
COARSE_SEGMENTS = 12
"""Around a fuselage."""
WINDOW_PITCH_M = 0.51
"""Between cabin windows: Boeing D6-58325-6, section 2.3, frames 20 in apart."""


@dataclass(frozen=True)
class Livery:
    """The colours of an aircraft."""

    body: Colour
    belly: Colour
    tail: Colour
    stripe: Colour
    wing: Colour
    engine: Colour


LIVERIES = {
    "jet": Livery(WHITE, srgb(196, 202, 210), srgb(24, 62, 140), srgb(24, 62, 140), SILVER, WHITE),
    "heavy_jet": Livery(
        WHITE, srgb(176, 182, 190), srgb(176, 28, 44), srgb(28, 44, 96), SILVER, srgb(200, 204, 210)
    ),
    "piston_single": Livery(
        WHITE, WHITE, srgb(180, 30, 34), srgb(180, 30, 34), WHITE, srgb(180, 30, 34)
    ),
    "piston_twin": Livery(
        srgb(240, 236, 222), srgb(30, 70, 60), srgb(30, 70, 60), srgb(196, 150, 40),
        srgb(240, 236, 222), srgb(30, 70, 60),
    ),
}  # fmt: skip


def aircraft_meshes(kind: AircraftType, *, coarse: bool = False) -> dict[str, Mesh]:
    """Return the shapes of a type, ``clean`` and with its ``gear`` down.

    Coarse ones are for pictures in which it is small.
    """
    shape = _Aircraft(kind, coarse)
    clean = shape.clean()
    return {"clean": clean, "gear": join([clean, *shape.gear()])}


def wing_tip_m(kind: AircraftType) -> tuple[float, float, float]:
    """Return the leading edge of the right wing tip: right, ahead, up."""
    return _Aircraft(kind).wing_tip_m


class _Aircraft:
    def __init__(self, kind: AircraftType, coarse: bool = False) -> None:
        self._coarse = coarse
        self._segments = COARSE_SEGMENTS if coarse else SEGMENTS
        self._shape = kind.mesh
        self._is_jet = kind.category in ("jet", "heavy_jet")
        self._is_heavy = kind.category == "heavy_jet"
        self._single = kind.category == "piston_single"
        self._livery = LIVERIES[kind.category]
        size = kind.dimensions
        self._length = size.length_m
        self._half_span = size.span_m / 2.0
        self._radius = kind.mesh.fuselage_diameter_m / 2.0
        self._ground = -size.wheel_height_offset_m
        self._fin_top = size.height_m - size.wheel_height_offset_m
        foot = self._radius if self._is_jet else 0.0
        self._axis = self._fin_top - kind.mesh.fin_height_m - foot
        """Height of the fuselage's axis; fins of jets stand on its top, others on the tail cone."""

    def clean(self) -> Mesh:
        right = [self._wing(), self._tailplane()]
        parts = [self._fuselage(), self._fin(), *right, *(part.mirrored() for part in right)]
        parts += [self._engine(*place) for place in self._shape.engines_m]
        if self._is_heavy:
            parts.append(self._upper_deck())
        if not self._is_jet:
            parts.append(self._cabin())
        if self._shape.wing_position == "high":
            strut = self._strut()
            parts += [strut, strut.mirrored()]
        return join(parts)

    # --- fuselage ---------------------------------------------------------------------------

    def _fuselage(self) -> Mesh:
        stations = np.unique(
            np.concatenate((
                np.linspace(0.0, 0.16, 14),
                np.arange(0.16, 0.66, WINDOW_PITCH_M / 2.0 / self._length)
                if self._is_jet
                else np.linspace(0.16, 0.66, 12),
                np.linspace(0.66, 1.0, 14),
            ))
        )  # fmt: skip
        if self._coarse:
            stations = np.array((0.0, 0.012, 0.028, 0.062, 0.16, 0.4, 0.64, 0.76, 0.88, 1.0))
        angles = np.linspace(0.0, math.tau, self._segments, endpoint=False)
        rings = []
        for part in stations:
            half_width, half_height, rise = self._section(float(part))
            rings.append(
                np.column_stack((
                    half_width * np.cos(angles),
                    np.full(self._segments, self._length * (0.5 - part)),
                    self._axis + rise + half_height * np.sin(angles),
                ))
            )  # fmt: skip
        # Rings go aft, and their points run from the right side up.
        rings.reverse()
        return loft([ring[::-1] for ring in rings], self._paint, closed=True)

    def _section(self, part: float) -> tuple[float, float, float]:
        """Return half width, half height and rise of the axis at a part of the length."""
        radius = self._radius
        nose, tail = (0.13, 0.62) if self._is_jet else (0.22, 0.42)
        if part < nose:
            u = part / nose
            grown = math.sqrt(max(1.0 - (1.0 - u) ** 2.2, 0.0)) if self._is_jet else u**0.45
            if not self._is_jet:
                grown = 0.32 + 0.68 * min(1.0, u**0.7) if self._single else 0.05 + 0.95 * grown
            return radius * max(grown, 0.03), radius * max(grown, 0.03), -0.22 * radius * (1 - u)
        if part > tail:
            u = (part - tail) / (1.0 - tail)
            left = 1.0 - 0.93 * u ** (1.5 if self._is_jet else 1.0)
            lift = (0.62 if self._is_jet else 0.18) * radius * u**1.4
            wide = 1.0 - 0.95 * u ** (1.8 if self._is_jet else 1.0)
            return radius * wide, radius * left, lift
        return radius, radius, 0.0

    def _paint(self, centres: Floats) -> Floats:
        livery, radius = self._livery, self._radius
        aft = self._length / 2.0 - centres[:, 1]
        above = (centres[:, 2] - self._axis) / radius
        colours = np.tile(np.asarray(livery.body, dtype=np.float32), (len(centres), 1))
        if self._is_jet:
            colours[above < -0.42] = livery.belly
            colours[(above > -0.42) & (above < -0.2)] = livery.stripe
            along = aft / self._length
            tail = (along > 0.78 - 0.1 * above) & (along > 0.7)
            colours[tail] = livery.tail
            row = (above > 0.08) & (above < 0.34) & (along > 0.16) & (along < 0.66)
            windows = np.floor(aft / (WINDOW_PITCH_M / 2.0)).astype(int) % 2 == 0
            colours[row & windows & (not self._coarse)] = GLASS
            screen = (along > 0.028) & (along < 0.062) & (above > 0.18) & (above < 0.62)
            colours[screen] = GLASS
        else:
            colours[(above > -0.35) & (above < 0.0)] = livery.stripe
            colours[above < -0.75] = livery.belly
        return colours

    def _upper_deck(self) -> Mesh:
        """Return the hump of a 747, over the first third."""
        length, radius = 0.27 * self._length, 0.62 * self._radius

        def paint(centres: Floats) -> Floats:
            colours = np.tile(np.asarray(self._livery.body, dtype=np.float32), (len(centres), 1))
            front = 0.5 * length - centres[:, 1]
            above = centres[:, 2] / self._radius
            colours[(front < 0.13 * length) & (above > 0.2) & (above < 0.5)] = GLASS
            return colours

        finer = (8, 6) if self._coarse else (24, 24)
        hump = ellipsoid(paint, radius, length / 2.0, 0.72 * self._radius, *finer)
        ahead = 0.445 * self._length - length / 2.0
        return hump.moved(0.0, ahead, self._axis + 0.66 * self._radius)

    def _cabin(self) -> Mesh:
        """Return the glazed cabin on top of a small aircraft's fuselage."""
        radius = self._radius
        length = 0.34 * self._length
        middle = self._length * (0.5 - (0.36 if self._single else 0.42))
        high = 0.62 * radius if self._single else 0.5 * radius

        def paint(centres: Floats) -> Floats:
            colours = np.tile(np.asarray(GLASS, dtype=np.float32), (len(centres), 1))
            colours[centres[:, 2] > 0.88 * high] = self._livery.body
            posts = np.abs(np.mod(centres[:, 1] / length * 3.0 + 0.5, 1.0) - 0.5) < 0.12
            colours[posts & (np.abs(centres[:, 0]) > 0.5 * radius)] = self._livery.body
            return colours

        rings = []
        for end, (wide, tall) in (
            (-0.5, (0.35, 0.05)),
            (-0.3, (0.8, 0.85)),
            (-0.1, (0.93, 1.0)),
            (0.18, (0.93, 1.0)),
            (0.34, (0.9, 0.7)),
            (0.5, (0.82, 0.05)),
        ):
            outline = [(-1.0, -0.3), (1.0, -0.3), (0.98, 0.35), (0.82, 0.95), (-0.82, 0.95),
                       (-0.98, 0.35)]  # fmt: skip
            rings.append([
                (x * wide * radius * 0.98, end * length, z * tall * high if z > 0 else z * high)
                for x, z in outline
            ][::-1])  # fmt: skip
        skin = loft(rings, paint, closed=True)
        return skin.moved(0.0, middle, self._axis + 0.62 * radius)

    # --- wings and tail -----------------------------------------------------------------------

    @property
    def _wing_root_up(self) -> float:
        high = self._shape.wing_position == "high"
        return self._axis + (1.22 if high else -0.5) * self._radius

    @property
    def _dihedral(self) -> float:
        high = self._shape.wing_position == "high"
        return math.tan(math.radians(6.0 if self._is_jet else 1.7 if high else 5.0))

    @property
    def wing_tip_m(self) -> tuple[float, float, float]:
        """The leading edge of the right wing tip."""
        out = self._half_span - self._radius
        back = math.tan(math.radians(self._shape.wing_sweep_deg)) * out
        up = self._wing_root_up + self._dihedral * out
        return self._half_span, WING_ROOT_AT * self._length - back, up

    def _wing(self) -> Mesh:
        shape, radius = self._shape, self._radius
        root_at = WING_ROOT_AT * self._length
        up, dihedral = self._wing_root_up, self._dihedral
        sweep = math.tan(math.radians(shape.wing_sweep_deg))
        sections = []
        for part in (0.0, 0.33, 1.0) if self._coarse else (0.0, 0.33, 0.66, 1.0):
            out = 0.3 * radius + part * (self._half_span - 0.3 * radius)
            past = max(out - radius, 0.0)
            straight = shape.wing_root_chord_m + part * (
                shape.wing_tip_chord_m - shape.wing_root_chord_m
            )
            sections.append((out, root_at - sweep * past, up + dihedral * past, straight))
        if not self._is_jet:
            return _surface(sections, 0.14, self._wing_paint)
        wing = _surface(sections, 0.13, self._livery.wing)
        tip_out, tip_at, tip_up, chord = sections[-1]
        rise = 0.07 * self._half_span
        winglet = _blade(
            [(tip_out - 0.05, tip_at, tip_up), (tip_out + 0.35 * rise, tip_at - 0.9 * rise,
             tip_up + rise)], (chord, 0.45 * chord), 0.08, self._livery.tail
        )  # fmt: skip
        if self._coarse:
            return join([wing, winglet])
        fairings = [
            ellipsoid(self._livery.wing, 0.12 * radius, 0.32 * chord_here, 0.16 * radius, 8, 7)
            .moved(out, at - 0.92 * chord_here, height - 0.14 * radius)
            for out, at, height, chord_here in sections[1:3]
        ]  # fmt: skip
        return join([wing, winglet, *fairings])

    def _wing_paint(self, centres: Floats) -> Floats:
        colours = np.tile(np.asarray(self._livery.wing, dtype=np.float32), (len(centres), 1))
        colours[centres[:, 0] > 0.8 * self._half_span] = self._livery.tail
        return colours

    def _tailplane(self) -> Mesh:
        at = TAIL_ROOT_AT * self._length
        chord = TAIL_CHORD_PART * self._length
        half = self._shape.tail_span_m / 2.0
        sweep = math.tan(math.radians(self._shape.wing_sweep_deg + 5.0)) if self._is_jet else 0.12
        up = self._axis + (0.42 * self._radius if self._is_jet else 0.2 * self._radius)
        rise = 0.12 if self._is_jet else 0.0
        sections = [
            (part * half, at - sweep * part * half, up + rise * part * half,
             chord * (1.15 - 0.65 * part))
            for part in ((0.0, 1.0) if self._coarse else (0.0, 0.5, 1.0))
        ]  # fmt: skip
        colour = self._livery.wing if self._is_jet else self._livery.body
        return _surface(sections, 0.1, colour)

    def _fin(self) -> Mesh:
        at = TAIL_ROOT_AT * self._length + (0.055 if self._is_jet else 0.02) * self._length
        chord = TAIL_CHORD_PART * self._length * (1.75 if self._is_jet else 1.5)
        bottom = self._axis + (0.55 * self._radius if self._is_jet else 0.1 * self._radius)
        rise = self._fin_top - bottom
        slope = math.tan(math.radians(40.0 if self._is_jet else 28.0))
        chords = (chord, 0.36 * chord if self._is_jet else 0.5 * chord)
        return _blade(
            [(0.0, at, bottom), (0.0, at - slope * rise, self._fin_top)],
            chords,
            0.1,
            self._livery.tail,
        )

    def _strut(self) -> Mesh:
        wing_up = self._axis + 1.2 * self._radius
        ahead = WING_ROOT_AT * self._length - 0.3 * self._shape.wing_root_chord_m
        return tube(
            (0.9 * self._radius, ahead, self._axis - 0.7 * self._radius),
            (0.48 * self._half_span, ahead, wing_up),
            (0.05, 0.05),
            self._livery.body,
        )

    # --- engines and gear ---------------------------------------------------------------------

    def _engine(self, aft: float, right: float, above: float) -> Mesh:
        front = self._length / 2.0 - aft
        up = self._axis + above
        if self._is_jet:
            return self._turbofan(front, right, up)
        return self._propeller(front, right, up)

    def _turbofan(self, front: float, right: float, up: float) -> Mesh:
        radius = 0.21 * self._shape.fuselage_diameter_m + (0.2 if self._is_heavy else 0.15)
        length = 3.6 * radius
        sides = 8 if self._coarse else 20
        angles = np.linspace(0.0, math.tau, sides, endpoint=False)

        def ring(back: float, part: float) -> Floats:
            return np.column_stack((
                right + radius * part * np.cos(angles),
                np.full(sides, front - back * length),
                up + radius * part * np.sin(angles),
            )).astype(np.float32)[::-1]  # fmt: skip

        # The pylon, up and back to the wing.
        wing_up = self._axis - 0.45 * self._radius + 0.1 * (abs(right) - self._radius)
        pylon = box(self._livery.wing, 0.28 * radius, 0.75 * length, max(wing_up - up, 0.4))
        pylon = pylon.moved(right, front - 0.75 * length, up)

        def paint(centres: Floats) -> Floats:
            back = (front - centres[:, 1]) / length
            part = np.hypot(centres[:, 0] - right, centres[:, 2] - up) / radius
            colours = np.tile(np.asarray(self._livery.engine, dtype=np.float32), (len(back), 1))
            colours[(back < 0.12) & (part < 0.9)] = SILVER
            colours[(back < 0.12) & (part < 0.6)] = DARK
            colours[back > 0.97] = GREY
            return colours

        # From the cone at the back along the cowl to the middle of the fan.
        rings = [(1.2, 0.12), (1.0, 0.55), (0.35, 1.04), (0.0, 0.92), (0.02, 0.02)]
        if not self._coarse:
            rings = [(1.2, 0.12), (0.98, 0.36), (1.0, 0.55), (0.72, 0.82), (0.35, 1.04),
                     (0.06, 1.0), (0.0, 0.92), (0.03, 0.84), (0.12, 0.8), (0.1, 0.02)]  # fmt: skip
        return join([loft([ring(*at) for at in rings], paint, closed=True), pylon])

    def _propeller(self, front: float, right: float, up: float) -> Mesh:
        radius = 0.34 if self._single else 0.4
        long = 0.9 if self._single else 2.1
        reach = 0.95 if self._single else 1.0
        spinner = ellipsoid(SILVER, 0.16, 0.3, 0.16, 10, 7).moved(right, front, up)
        blades = []
        for turn in (0.6, 0.6 + math.pi) if self._single else (0.5, 2.6, 4.7):
            tip = (right + reach * math.cos(turn), front, up + reach * math.sin(turn))
            blades.append(tube((right, front, up), tip, (0.07, 0.05), BLADE, 6))
        if self._single:
            return join([spinner, *blades])
        rings = []
        for back, part in ((1.0, 0.12), (0.7, 0.62), (0.4, 0.95), (0.1, 1.0), (0.0, 0.5)):
            angles = np.linspace(0.0, math.tau, 14, endpoint=False)
            rings.append(
                np.column_stack((
                    right + radius * part * np.cos(angles),
                    np.full(14, front - 0.15 - back * long),
                    up + radius * 0.85 * part * np.sin(angles),
                ))[::-1]
            )  # fmt: skip
        return join([loft(rings, self._livery.engine, closed=True), spinner, *blades])

    def gear(self) -> list[Mesh]:
        radius = {True: 0.6, False: 0.55}[self._is_heavy] if self._is_jet else 0.22
        width = 0.4 if self._is_jet else 0.16
        nose_at = self._length * (0.5 - (0.12 if self._is_jet else 0.16))
        main_at = -0.04 * self._length if self._is_jet else -0.06 * self._length + 0.4
        out = 0.17 * self._half_span if self._is_jet else 0.24 * self._half_span
        legs = [(0.0, nose_at), (out, main_at), (-out, main_at)]
        if self._is_heavy:
            legs += [
                (0.06 * self._half_span, main_at - 3.0),
                (-0.06 * self._half_span, main_at - 3),
            ]
        parts = []
        for right, at in legs:
            top = self._axis - 0.5 * self._radius
            inboard = 0.75 * right if not self._is_jet else right
            parts.append(
                tube((inboard, at, top), (right, at, self._ground + radius),
                     (0.14, 0.14) if self._is_jet else (0.06, 0.06), SILVER,
                     4 if self._coarse else 8)
            )  # fmt: skip
            sides = (-0.45, 0.45) if self._is_jet else (0.0,)
            rows = (-0.7, 0.7) if self._is_heavy and right else (0.0,)
            if self._coarse:
                reach = (sides[-1] + width / 2.0, 0.0, 0.0)
                hub = right, at, self._ground + radius
                parts.append(
                    tube(np.subtract(hub, reach), np.add(hub, reach), (radius, radius), TYRE, 6)
                )
                continue
            parts += [
                wheel(TYRE, radius, width).moved(right + side, at + row, self._ground + radius)
                for side in sides
                for row in rows
            ]
        return parts


def _surface(
    sections: list[tuple[float, float, float, float]], thickness: float, colour: Colour | Paint
) -> Mesh:
    """Return a wing: leading edges (right, ahead, up) and chords, from the root outwards."""
    rings = [
        [(out, at - chord * x, up + chord * thickness * z) for x, z in _AEROFOIL]
        for out, at, up, chord in sections
    ]
    return loft(rings, colour, closed=True)


def _blade(
    edge: list[tuple[float, float, float]],
    chords: tuple[float, float],
    thickness: float,
    colour: Colour,
) -> Mesh:
    """Return an upright surface, given by its leading edge from the bottom up."""
    rings = [
        [(right + chord * thickness * z, at - chord * x, up) for x, z in _AEROFOIL][::-1]
        for (right, at, up), chord in zip(edge, chords, strict=True)
    ]
    return loft(rings, colour, closed=True)


_AEROFOIL = [
    (1.0, 0.0), (0.6, 0.34), (0.3, 0.5), (0.08, 0.34), (0.0, 0.0), (0.08, -0.22), (0.3, -0.34),
    (0.6, -0.2),
]  # fmt: skip
"""Aft of the leading edge in chords and up in thicknesses; a symmetric section with more on top."""
