"""Points of light in pictures, and those beside runways and taxiways."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt
from shapely import Point

from airhilt.imaging.view import NEAR_M, Pose, View
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.shapes.lights import BLUE, GREEN, LANDING_BEAM, RED, WHITE, Light
from airhilt.shapes.mesh import Colour, Floats

if TYPE_CHECKING:  # An airport brings in NetworkX, which en route nobody needs.
    from airhilt.world.surface.layout import Layout

EDGE_SPACING_M = 60.0
"""Distance between two edge lights, in m: at most 60 m, ICAO Annex 14 volume I, 5.3.9.5."""
EDGE_CD = 3000.0
THRESHOLD_CD = 5000.0
TAXIWAY_CD = 20.0
DAY_LUX = 3e-2
NIGHT_LUX = 4e-6
"""Illuminance at the camera of a light that just saturates a pixel, by day and at night."""
GREATEST_RADIUS_PX = 9.0
FAINTEST_LIGHT = 0.02
"""Least light that is drawn, as a part of what saturates a pixel."""


def airport_lights(layout: Layout) -> tuple[Light, ...]:
    """Return the lights of runways and taxiways."""
    return (*_runway_lights(layout), *_taxiway_lights(layout))


def _runway_lights(layout: Layout) -> Iterator[Light]:
    for strip in layout.strips.values():
        first, second = strip.ends
        low, high = (layout.local_frame.to_local(end.start) for end in (first, second))
        along = np.subtract(high, low)
        length = float(np.hypot(*along))
        ahead = along / length
        across = np.array((ahead[1], -ahead[0]))
        half = first.width_m / 2.0 + 1.5
        for part in np.linspace(0.0, length, max(int(length // EDGE_SPACING_M), 1) + 1)[1:-1]:
            for side in (-half, half):
                yield _light(np.asarray(low) + part * ahead + side * across, WHITE, EDGE_CD)
        for corner, way in ((low, 1.0), (high, -1.0)):
            out = (-way * float(ahead[0]), -way * float(ahead[1]), 0.05)
            inwards = (-out[0], -out[1], 0.05)
            for side in np.linspace(-half, half, 12):
                place = np.asarray(corner) - way * 2.0 * ahead + side * across
                yield _light(place, GREEN, THRESHOLD_CD, out, 1.0)
                yield _light(place, RED, THRESHOLD_CD, inwards, 1.0)
            for row in range(1, 15):
                place = np.asarray(corner) - way * row * 30.0 * ahead
                for side in np.linspace(-2.0, 2.0, 5) if row != 10 else np.linspace(-15, 15, 15):
                    yield _light(place + side * across, WHITE, 4 * EDGE_CD, out, 2.0)


def _taxiway_lights(layout: Layout) -> Iterator[Light]:
    nodes = {n.name: layout.local_frame.to_local(n.place) for n in layout.airport.taxiways.nodes}
    runways = [strip.pavement.buffer(20.0) for strip in layout.strips.values()]
    for edge in layout.airport.taxiways.edges:
        start, end = (np.asarray(nodes[name]) for name in edge.nodes)
        length = float(np.hypot(*(end - start)))
        if length < 1.0:
            continue
        ahead = (end - start) / length
        across = np.array((ahead[1], -ahead[0])) * (edge.width_m / 2.0 + 2.0)
        for part in np.arange(20.0, length - 10.0, 50.0):
            for side in (-1.0, 1.0):
                place = start + part * ahead + side * across
                if not any(pavement.contains(Point(*place)) for pavement in runways):
                    yield _light(place, BLUE, TAXIWAY_CD)


def _light(
    place: npt.NDArray[np.float64],
    colour: Colour,
    candela: float,
    beam: tuple[float, float, float] | None = None,
    sharpness: float = LANDING_BEAM,
) -> Light:
    return Light((float(place[0]), float(place[1]), 0.4), colour, candela, beam, sharpness)


class Spot(NamedTuple):
    """A light in a picture: where, how far, and how bright if nothing stands before it."""

    column: float
    row: float
    away_m: float
    strength: float
    colour: tuple[float, ...]


@dataclass(frozen=True)
class Lights:
    """Points of light, in columns.

    Attributes
    ----------
    places_m, colours, beams
        Place, colour and direction of each light, shape (n, 3).
    sharpness
        Sharpness of each light's beam; 0 for a light that shines all round.
    """

    places_m: npt.NDArray[np.float64]
    colours: npt.NDArray[np.float64]
    candela: npt.NDArray[np.float64]
    beams: npt.NDArray[np.float64]
    sharpness: npt.NDArray[np.float64]

    @classmethod
    def of(cls, lights: Sequence[Light]) -> Lights:
        """Return lights that are given one by one."""
        rows = [
            (*light.place_m, *light.colour, light.candela, *(light.beam or (0.0, 0.0, 0.0)),
             light.beam_sharpness if light.beam else 0.0)
            for light in lights
        ]  # fmt: skip
        table = np.array(rows, dtype=np.float64).reshape(-1, 11)
        return cls(table[:, :3], table[:, 3:6], table[:, 6], table[:, 7:10], table[:, 10])

    @classmethod
    def carried(cls, groups: Sequence[tuple[Pose, Sequence[Light]]]) -> Lights:
        """Return lights that are given in the axes of what carries them."""
        lights = cls.of([light for _, group in groups for light in group])
        counts = [len(group) for _, group in groups]
        if not sum(counts):
            return lights
        turns = np.repeat([pose.rotation for pose, _ in groups], counts, axis=0)
        moves = np.repeat([pose.position_m for pose, _ in groups], counts, axis=0)
        return replace(
            lights,
            places_m=np.einsum("nij,nj->ni", turns, lights.places_m) + moves,
            beams=np.einsum("nij,nj->ni", turns, lights.beams),
        )

    def seen(self, view: View, light: Illumination) -> list[Spot]:
        """Return those that are in the picture and bright enough to be seen."""
        if not len(self.places_m):
            return []
        offset = self.places_m - np.asarray(view.pose.position_m)
        away = np.maximum(np.linalg.norm(offset, axis=1), 1.0)
        threshold = NIGHT_LUX**light.darkness * DAY_LUX ** (1.0 - light.darkness)
        strength = self.candela / away**2 * np.exp(-light.extinction_per_m * away) / threshold
        cosine = -np.einsum("ij,ij->i", offset, self.beams) / away
        strength *= np.exp(self.sharpness * (cosine - 1.0))
        bright = np.flatnonzero(strength > FAINTEST_LIGHT)
        inside = offset[bright] @ view.axes
        ahead = inside[:, 2] > NEAR_M
        bright, inside = bright[ahead], inside[ahead]
        lens = view.intrinsics
        found = []
        for index, (column, row) in zip(bright.tolist(), view.pixels(inside).tolist(), strict=True):
            if 0.0 <= column < lens.width_px and 0.0 <= row < lens.height_px:
                colour = tuple(self.colours[index].tolist())
                found.append(Spot(column, row, float(away[index]), float(strength[index]), colour))
        return found


def shine(picture: npt.NDArray[np.uint8], distance_m: Floats, spots: Sequence[Spot]) -> None:
    """Screen lights over a picture where nothing stands before them.

    What is brighter than white grows instead.
    """
    for column, row, away_m, strength, colour in spots:
        if distance_m[int(row), int(column)] < away_m - 1.5:
            continue
        radius = min(0.7 + 0.45 * math.log2(1.0 + strength), GREATEST_RADIUS_PX)
        reach = math.ceil(2.2 * radius)
        top, left = max(int(row) - reach, 0), max(int(column) - reach, 0)
        part = picture[top : int(row) + reach + 1, left : int(column) + reach + 1]
        rows = np.arange(top, top + part.shape[0])[:, None] + 0.5 - row
        columns = np.arange(left, left + part.shape[1])[None, :] + 0.5 - column
        peak = min(strength, 1.0)
        light = peak * np.exp(-(rows**2 + columns**2) / (0.5 * radius * radius))
        tint = np.asarray(colour) ** (1.0 / 2.2)
        tint = tint + (1.0 - tint) * min(1.0, strength / 20.0) * 0.7
        covered = light[..., None] * tint
        part[...] = (255.0 - (255.0 - part) * (1.0 - covered)).astype(np.uint8)
