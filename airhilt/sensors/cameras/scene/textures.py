"""Textures: by how much surfaces vary about their colour, anchored in the world.

A place is looked up in three tiles of different grain, which repeat in all directions, and each
tile is kept in levels as blurred as pixels are large (L. Williams, Pyramidal parametrics, SIGGRAPH
1983). What a surface sends out is multiplied by the product. The patterns are drawn by eye after
photographs; all are made of one seed, so that a place looks the same in all runs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from statistics import NormalDist
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from airhilt.shapes.material import Material
from airhilt.shapes.mesh import Floats
from airhilt.sim.streams import stream

SIDE = 512
"""Texels along each side of a tile."""
LEVELS = SIDE.bit_length()
"""Levels of a tile, from all its texels to a single one."""
SEED = 7
TINT = (1.12, 1.0, 0.78)
"""Share of a texture's variation in red, green and blue: where less grows, earth shows."""
NEAR = 0
"""Logarithm to base 2 of the footprint, in m, up to which the fine tile is looked up."""

DECK_M = 8000.0
"""Height of the deck of thin clouds, in m."""
DECK_VARIES = 0.1
"""Deviation of the deck's thickness."""
DECK_SLOPE = 11.0 / 3.0
"""Power of the frequency by which the power of what is seen of the deck falls.

In a plane 8/3 by turbulence, and about one more at sizes under 200 to 500 m, where light spreads
sideways (A. Davis et al., J. Atmos. Sci. 54, 1997). With less, specks stand alone in the sky."""
DECK_OPAQUE = 0.45
"""Share of the sky that a deviation more hides."""
DECK_MOST = 0.75

Pattern = Callable[[np.random.Generator], Floats]


class Grain(NamedTuple):
    """A tile of a grain: the size of its texels, and the pattern of each material that has one."""

    texel_m: float
    patterns: dict[Material, Pattern]


def noise(draws: np.random.Generator, slope: float, stretch: float = 1.0) -> Floats:
    """Return noise that repeats, of mean 0 and deviation 1, whose power falls with frequency.

    Parameters
    ----------
    slope
        Power of the frequency by which the noise's power falls: 0 is white, 2 has large patches.
    stretch
        Length of features along the columns for that along the rows.
    """
    field = _noise(slope, stretch)
    row, column = draws.integers(SIDE, size=2)
    turned: Floats = np.roll(
        field[:: draws.choice((-1, 1)), :: draws.choice((-1, 1))], (row, column), (0, 1)
    )
    return turned


@cache
def _noise(slope: float, stretch: float) -> Floats:
    across, down = np.fft.rfftfreq(SIDE)[None], np.fft.fftfreq(SIDE)[:, None] * stretch
    radius = np.hypot(across, down).astype(np.float32)
    radius[0, 0] = 1.0
    draws = stream(SEED, f"noise {slope} {stretch}")
    spectrum = np.fft.rfft2(draws.standard_normal((SIDE, SIDE), dtype=np.float32))
    spectrum *= radius ** np.float32(-slope / 2.0)
    spectrum[0, 0] = 0.0
    return _unit(np.fft.irfft2(spectrum, s=(SIDE, SIDE)))


def _unit(field: npt.NDArray[np.floating]) -> Floats:
    field = field - field.mean()
    return np.asarray(np.clip(field / field.std(), -3.0, 3.0), dtype=np.float32)


def _stripes(period: int, wander: Floats) -> Floats:
    """Return bands across the rows, ``period`` texels wide, whose edges wander by texels."""
    place = np.arange(SIDE)[None, :] + wander
    return np.asarray(np.tanh(4.0 * np.sin(2.0 * np.pi * place / period)), dtype=np.float32)


def _patches(draws: np.random.Generator, count: int, sides: tuple[int, int]) -> Floats:
    """Return rectangles, each of its own brightness, on nothing."""
    field = np.zeros((SIDE, SIDE), dtype=np.float32)
    for _ in range(count):
        (row, column), (tall, wide) = draws.integers(SIDE, size=2), draws.integers(*sides, size=2)
        rows, columns = (row + np.arange(tall)) % SIDE, (column + np.arange(wide)) % SIDE
        field[np.ix_(rows, columns)] = draws.normal()
    return field


def _slabs(draws: np.random.Generator, side: int) -> Floats:
    """Return squares, each of its own brightness."""
    values = draws.standard_normal((SIDE // side, SIDE // side), dtype=np.float32)
    return np.asarray(np.kron(values, np.ones((side, side), dtype=np.float32)))


def _joints(side: int) -> Floats:
    """Return the lines between squares: 1 there, else 0."""
    line = (np.arange(SIDE) % side == 0).astype(np.float32)
    return np.asarray(np.maximum(line[:, None], line[None, :]))


def _cracks(draws: np.random.Generator, count: int) -> Floats:
    """Return thin lines that wander: 1 there, else 0."""
    field = np.zeros((SIDE, SIDE), dtype=np.float32)
    for _ in range(count):
        steps = int(draws.integers(40, 200))
        angle = draws.uniform(0.0, 2.0 * np.pi) + np.cumsum(draws.normal(0.0, 0.25, steps))
        row = draws.integers(SIDE) + np.cumsum(np.sin(angle))
        column = draws.integers(SIDE) + np.cumsum(np.cos(angle))
        field[row.astype(int) % SIDE, column.astype(int) % SIDE] = 1.0
    return field


def _grass(draws: np.random.Generator) -> Floats:
    worn = np.maximum(noise(draws, 2.5) - np.float32(1.3), 0.0)
    mown = _stripes(32, 3.0 * noise(draws, 2.5))
    return _sum((0.07, noise(draws, 1.0)), (0.06, noise(draws, 2.5)), (0.035, mown), (0.12, worn))


def _asphalt(draws: np.random.Generator) -> Floats:
    seams = np.tile((np.arange(SIDE) % 16 == 0).astype(np.float32), (SIDE, 1))
    return _sum(
        (0.04, noise(draws, 1.0)),
        (0.05, noise(draws, 2.5)),
        (0.1, _patches(draws, 40, (4, 40))),
        (-0.06, seams),
        (-0.16, _cracks(draws, 60)),
    )


def _concrete(draws: np.random.Generator) -> Floats:
    return _sum(
        (0.03, noise(draws, 1.0)),
        (0.05, noise(draws, 2.5)),
        (0.05, _slabs(draws, 16)),
        (-0.18, _joints(16)),
    )


def _field(draws: np.random.Generator) -> Floats:
    rows = _stripes(8, 6.0 * noise(draws, 2.5))
    return _sum((0.06, noise(draws, 1.0)), (0.07, noise(draws, 2.5)), (0.03, rows))


def _foliage(draws: np.random.Generator) -> Floats:
    return _sum((0.12, noise(draws, 0.5)), (0.12, noise(draws, 2.0)))


def _water(draws: np.random.Generator) -> Floats:
    return _sum((0.05, noise(draws, 1.5, 0.3)), (0.03, noise(draws, 2.5)))


def _wall(draws: np.random.Generator) -> Floats:
    return _sum(
        (0.04, _slabs(draws, 8)),
        (-0.08, _joints(8)),
        (0.04, noise(draws, 2.0, 0.2)),
        (0.03, noise(draws, 2.0)),
    )


def _skin(draws: np.random.Generator) -> Floats:
    return _sum(
        (0.03, _slabs(draws, 32)),
        (-0.1, _joints(32)),
        (0.03, noise(draws, 1.0)),
        (0.05, noise(draws, 2.0, 0.2)),
    )


def _sum(*parts: tuple[float, Floats]) -> Floats:
    total: Floats = np.sum(
        [np.float32(share) * field for share, field in parts], axis=0, dtype=np.float32
    )
    return total


def _of_noise(part: float, slope: float) -> Pattern:
    return lambda draws: _sum((part, noise(draws, slope)))


FINE = Grain(
    1.0 / 32.0,
    {
        Material.PAINT: _of_noise(0.05, 1.0),
        Material.GRASS: _of_noise(0.16, 0.5),
        Material.ASPHALT: _of_noise(0.09, 0.5),
        Material.CONCRETE: _of_noise(0.05, 1.0),
        Material.FIELD: _of_noise(0.14, 0.5),
        Material.FOLIAGE: _of_noise(0.25, 1.0),
        Material.WATER: _of_noise(0.06, 1.5),
        Material.WALL: _of_noise(0.03, 1.0),
        Material.SKIN: _skin,
        Material.COAT: _of_noise(0.12, 1.0),
    },
)
"""16 m: blades of grass, gravel, panels."""
MIDDLE = Grain(
    0.5,
    {
        Material.PAINT: _of_noise(0.05, 1.5),
        Material.GRASS: _grass,
        Material.ASPHALT: _asphalt,
        Material.CONCRETE: _concrete,
        Material.FIELD: _field,
        Material.FOLIAGE: _foliage,
        Material.WATER: _water,
        Material.WALL: _wall,
        Material.CLOUD: _of_noise(0.04, 2.0),
    },
)
"""256 m: mowing and wear, slabs, repairs, crops, crowns of trees, waves."""
COARSE = Grain(
    32.0,
    {
        Material.GRASS: _of_noise(0.04, 2.0),
        Material.FIELD: _of_noise(0.14, 1.0),
        Material.FOLIAGE: _of_noise(0.06, 1.5),
        Material.WATER: _of_noise(0.03, 2.0),
        Material.CLOUD: _of_noise(0.05, 2.0),
        Material.DECK: _of_noise(DECK_VARIES, DECK_SLOPE),
    },
)
"""16 km: soils and winds."""
GRAINS = (FINE, MIDDLE, COARSE)


@dataclass(frozen=True)
class Tile:
    """The patterns of one grain.

    Attributes
    ----------
    table
        Factors of all materials and levels, one behind the other, after a tile of ones.
    starts
        Where levels begin in it, by material and level: that of material m is at m LEVELS + level.
    """

    texel_m: float
    table: Floats
    starts: npt.NDArray[np.int32]

    @property
    def finest(self) -> Floats:
        """Factors of all materials at the finest level, shape (materials, rows, columns)."""
        finest = self.table[self.starts[::LEVELS, None] + np.arange(SIDE**2)]
        return np.asarray(finest.reshape(-1, SIDE, SIDE))


class Places(NamedTuple):
    """Places of surfaces that pixels show.

    Attributes
    ----------
    material
        Number of the material of each.
    footprint_m
        Size of what a pixel shows.
    """

    material: npt.NDArray[np.int32]
    east_m: Floats
    north_m: Floats
    footprint_m: Floats


def on_surface(material: npt.NDArray[np.int32], place_m: Floats, footprint_m: Floats) -> Places:
    """Return places of shape (3, n), right, ahead and up: heights slant them on walls."""
    right, ahead, up = place_m
    return Places(material, right + up, ahead + up, footprint_m)


def deck_from(cover: float) -> float:
    """Return how many deviations of its thickness a deck is thicker where it is seen."""
    return NormalDist().inv_cdf(1.0 - min(max(cover, 1e-3), 1.0 - 1e-3))


def deck(towards: Floats, eye_m: Sequence[float], pixel_rad: float, cover: float) -> Floats:
    """Return what share of the sky the deck of clouds hides, shape (n,).

    Parameters
    ----------
    towards
        Unit vectors upwards, shape (3, n).
    eye_m
        Place of the camera: east, north, up.
    cover
        Share of the sky in which the deck is seen.
    """
    above = max(DECK_M - eye_m[2], 0.0)
    away = np.float32(above) / np.maximum(towards[2], np.float32(1e-3))
    east = towards[0] * away
    north = towards[1] * away
    east += np.float32(eye_m[0])
    north += np.float32(eye_m[1])
    away *= np.float32(pixel_rad)
    material = np.full(len(away), Material.DECK, dtype=np.int32)
    size = _binary_size(away)
    found = _looked_up(tiles()[2], Places(material, east, north, away), size, material * LEVELS)
    found -= np.float32(1.0 + deck_from(cover) * DECK_VARIES)
    found *= np.float32(DECK_OPAQUE / DECK_VARIES)
    # Towards the horizon it is lost in the haze.
    hidden = np.clip(found, 0.0, DECK_MOST) * np.clip(4.0 * towards[2], 0.0, 1.0)
    return np.asarray(hidden)


def _binary_size(footprint_m: Floats) -> npt.NDArray[np.int32]:
    """Return the nearest logarithms to base 2."""
    # The exponent of a number is the whole part of its logarithm.
    size = (footprint_m * np.float32(2.0**0.5)).view(np.int32)
    size >>= 23
    size -= 127
    return size


def factors(places: Places) -> Floats:
    """Return by how much places are brighter or darker than their colours."""
    middle, coarse = tiles()[1:]
    size = _binary_size(places.footprint_m)
    first = places.material * LEVELS
    found = _looked_up(middle, places, size, first)
    found *= _looked_up(coarse, places, size, first)
    near = np.flatnonzero(size < NEAR)
    if len(near):
        material, east, north, footprint = places
        fine = Places(material[near], east[near], north[near], footprint[near])
        found[near] *= _looked_up(tiles()[0], fine, size[near], first[near])
    return found


def _looked_up(
    tile: Tile, places: Places, size: npt.NDArray[np.int32], first: npt.NDArray[np.int32]
) -> Floats:
    scale = np.float32(1.0 / tile.texel_m)
    level = np.clip(size + int(math.log2(scale)), 0, LEVELS - 1)
    bits = (LEVELS - 1) - level
    mask = np.left_shift(1, bits, dtype=np.int32)
    mask -= 1
    entry = np.floor(places.north_m * scale).astype(np.int32)
    entry >>= level
    entry &= mask
    entry <<= bits
    column = np.floor(places.east_m * scale).astype(np.int32)
    column >>= level
    column &= mask
    entry += column
    level += first
    entry += tile.starts.take(level, mode="clip")
    return np.asarray(tile.table.take(entry, mode="clip"))


@cache
def tiles() -> tuple[Tile, ...]:
    """Return the tiles of all grains; they are the same in all scenes."""
    return tuple(_tile(number, grain) for number, grain in enumerate(GRAINS))


def _tile(number: int, grain: Grain) -> Tile:
    starts = np.zeros((len(Material), LEVELS), dtype=np.int32)
    table = [np.ones(SIDE**2, dtype=np.float32)]
    filled = SIDE**2
    for material, pattern in grain.patterns.items():
        drawn = pattern(stream(SEED, f"texture {number} {material.name}"))
        texels = np.asarray(1.0 + drawn - drawn.mean(), dtype=np.float32)
        for level in range(LEVELS):
            starts[material, level] = filled
            table.append(texels.reshape(-1))
            filled += texels.size
            if half := len(texels) // 2:
                texels = texels.reshape(half, 2, half, 2).mean(axis=(1, 3))
    return Tile(grain.texel_m, np.concatenate(table), starts.reshape(-1))
