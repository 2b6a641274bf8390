"""Pictures as other ground, light, sensors and lenses would have made them.

A detector that has only seen what one renderer draws learns how that renderer draws. What helps
most against it is texture: the picture multiplied by a field of chance, behind a body, on it, or
on all. So that no field is learnt either, they are of four kinds, mixed: noise of cells of some
size, noise of a power spectrum, patches, and stripes.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from io import BytesIO

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageFilter
from scipy import ndimage
from scipy.spatial import cKDTree

from detector_data import Body, Shot

SIDE_PX = 768
"""Side of a field."""
UNIT = 40.0
"""Fields are kept in such parts of their standard deviation."""
DROWNED_PX = 24.0
"""A body of such a size is drowned by texture that deviates as much as the body stands out."""
DROWNED = 0.3, 1.5
"""The contrast of a drowned body in deviations, at least (large ones) and at most (small ones)."""
LEAST_DEVIATION = 3.0
"""Smaller ones, in levels, drown nothing."""
LEAST_APART = 22.0
"""Least difference between a body and another background, in levels."""

Picture = npt.NDArray[np.uint8]
Mask = npt.NDArray[np.bool_]
Floats = npt.NDArray[np.float32]
Draws = np.random.Generator


@dataclass(frozen=True)
class Disturbed:
    """A disturbed picture, and how much what was put beside its bodies deviates, in levels."""

    picture: Picture
    deviation: float

    def bodies(self, bodies: Sequence[Body]) -> tuple[Body, ...]:
        """Return bodies, those without contrast that can hardly be seen any more."""
        return tuple(
            dataclasses.replace(body, contrast=0.0) if self._drowns(body) else body
            for body in bodies
        )

    def _drowns(self, body: Body) -> bool:
        low, high = DROWNED
        times = min(max(DROWNED_PX / body.size_px, low), high)
        return self.deviation > LEAST_DEVIATION and body.contrast < self.deviation * times


class Disturber:
    """Disturbs pictures, by the same fields for the same seed."""

    def __init__(self, seed: int) -> None:
        self._fields = fields(np.random.default_rng((seed, 77)))

    def __call__(self, picture: Picture, bodies: Mask, draws: Draws) -> Disturbed:
        """Return a picture with other texture, light, sensor, lens and coder.

        Parameters
        ----------
        bodies
            Where bodies are, shape (rows, columns).
        """
        levels, deviation = picture.astype(np.float32), 0.0
        if draws.random() < 0.1:
            levels, deviation = self._before_another(levels, bodies, draws)
        if draws.random() < 0.65:
            for _ in range(1 + (draws.random() < 0.25)):
                levels, spread = self._textured(levels, bodies, draws)
                deviation = math.hypot(deviation, spread * float(levels.mean()))
        levels = np.clip(_through_a_lens(_lit(levels, draws), draws), 0.0, 255.0)
        if draws.random() < 0.4:
            levels, spread = _noisy(levels, draws)
            deviation = math.hypot(deviation, spread)
        taken = np.ascontiguousarray(np.clip(levels, 0.0, 255.0).astype(np.uint8))
        if draws.random() < 0.25:
            taken = coded(taken, int(draws.integers(35, 96)))
        return Disturbed(taken, deviation)

    def field(self, rows: int, columns: int, draws: Draws) -> Floats:
        """Return a mixture of fields, of a standard deviation of about 1."""
        if (larger := max(rows, columns) / SIDE_PX) > 1.0:
            small = self.field(int(rows / larger), int(columns / larger), draws)
            enlarged = Image.fromarray(small).resize((columns, rows), Image.Resampling.BILINEAR)
            return np.asarray(enlarged)
        mixed, total = np.zeros((rows, columns), dtype=np.float32), 0.0
        for _ in range(int(draws.integers(1, 4))):
            zoom = 1 if max(rows, columns) > SIDE_PX // 2 or draws.random() < 0.6 else 2
            top = int(draws.integers(SIDE_PX - zoom * rows + 1))
            left = int(draws.integers(SIDE_PX - zoom * columns + 1))
            part = self._fields[int(draws.integers(len(self._fields)))]
            part = part[top : top + zoom * rows : zoom, left : left + zoom * columns : zoom]
            if draws.random() < 0.5:
                part = part[:, ::-1]
            if draws.random() < 0.5:
                part = part[::-1]
            share = draws.uniform(0.3, 1.0)
            mixed += (share / UNIT) * part
            total += share * share
        return mixed / np.float32(math.sqrt(total))

    def _textured(self, levels: Floats, bodies: Mask, draws: Draws) -> tuple[Floats, float]:
        """Return a textured picture, and the part of the levels that the background deviates."""
        spread = draws.uniform(0.1, 0.25)
        if draws.random() < 0.85:
            spread = min(abs(draws.normal(0.0, 0.075)) + 0.01, 0.22)
        rows, columns = levels.shape[:2]
        field: Floats = self.field(rows, columns, draws)[..., None]
        if draws.random() < 0.4:
            field = field * (1.0 + draws.normal(0.0, 0.25, 3)).astype(np.float32)
        where = draws.random()
        if where < 0.45:
            return levels * (1.0 + spread * field), spread
        soft = _soft(bodies)
        beside: Floats = np.float32(1.0) - soft
        if where < 0.8:
            return levels * (1.0 + spread * field * beside), spread
        if where < 0.9:
            return levels * (1.0 + spread * field * soft), 0.0
        other = self.field(rows, columns, draws)[..., None] * np.float32(draws.uniform(0.0, 1.0))
        both: Floats = field * soft + other * beside
        return levels * (1.0 + spread * both), spread

    def _before_another(self, levels: Floats, bodies: Mask, draws: Draws) -> tuple[Floats, float]:
        """Return bodies before another background, if they stand out there."""
        rows, columns = levels.shape[:2]
        colour = 0.3 * draws.uniform(30.0, 230.0, 3) + 0.7 * draws.uniform(30.0, 230.0)
        across = (np.arange(columns) / columns - 0.5) * draws.normal(0.0, 40.0)
        down = (np.arange(rows) / rows - 0.5)[:, None] * draws.normal(0.0, 40.0)
        behind = colour + (across + down)[..., None] * (1.0 + draws.normal(0.0, 0.2, 3))
        if draws.random() < 0.75:
            field = self.field(rows, columns, draws)[..., None]
            behind = behind + field * draws.uniform(2.0, 45.0) * (1.0 + draws.normal(0.0, 0.15, 3))
        behind = behind.astype(np.float32)
        parts, count = ndimage.label(bodies)
        away = ndimage.median(np.abs(levels - behind).max(axis=2), parts, range(1, count + 1))
        if count and np.min(away) < LEAST_APART:
            return levels, 0.0
        soft = _soft(bodies)
        return levels * soft + behind * (1.0 - soft), 0.5 * float(behind.mean(axis=2).std())


def half_disturbed(shots: Sequence[Shot], seed: tuple[int, ...]) -> Iterator[tuple[Shot, Picture]]:
    """Yield shots with their pixels, every second disturbed."""
    disturber = Disturber(seed[0])
    for index, shot in enumerate(shots):
        picture = shot.picture()
        if index % 2:
            draws = np.random.default_rng((*seed, index))
            taken = disturber(picture, shot.masks(), draws)
            picture = taken.picture
            shot = dataclasses.replace(shot, bodies=taken.bodies(shot.bodies))
        yield shot, picture


def coded(picture: Picture, quality: int) -> Picture:
    """Return a picture as JPEG of some quality leaves it."""
    buffer = BytesIO()
    Image.fromarray(picture).save(buffer, format="JPEG", quality=quality)
    return np.asarray(Image.open(buffer))


# --- fields -------------------------------------------------------------------------------


def fields(draws: Draws) -> npt.NDArray[np.int8]:
    """Return fields of mean 0, in parts of their deviation, shape (n, `SIDE_PX`, `SIDE_PX`)."""
    made = [_cell_noise(draws) for _ in range(36)]
    made += [_power_noise(draws, beta) for beta in (0, 0.5, 1, 1, 1.5, 1.5, 2, 2, 2.5, 3)]
    made += [_patches(draws, count) for count in (40, 150, 300, 600, 1200, 2500, 5000, 8000)]
    made += [_stripes(draws) for _ in range(8)]
    return np.stack([_in_parts(field) for field in made])


def _in_parts(field: Floats) -> npt.NDArray[np.int8]:
    field = field - field.mean()
    parts = (field / field.std()).clip(-3.0, 3.0) * UNIT
    whole: npt.NDArray[np.int8] = parts.round().astype(np.int8)
    return whole


def _value_noise(draws: Draws, cell_x: float, cell_y: float, kind: Image.Resampling) -> Floats:
    across, down = (max(2, round(SIDE_PX / cell) + 1) for cell in (cell_x, cell_y))
    coarse = draws.normal(0.0, 1.0, (down, across)).astype(np.float32)
    return np.asarray(Image.fromarray(coarse).resize((SIDE_PX, SIDE_PX), kind))


def _cell_noise(draws: Draws) -> Floats:
    """Return noise of cells of one size, from a pixel or two to a sixth of the side."""
    cell = math.exp(draws.uniform(math.log(2.0), math.log(120.0)))
    longer = math.exp(draws.normal(0.0, 0.5))
    kinds = Image.Resampling.BICUBIC, Image.Resampling.BILINEAR, Image.Resampling.NEAREST
    kind = kinds[int(draws.integers(3))] if cell < 40.0 else Image.Resampling.BICUBIC
    return _value_noise(draws, cell * longer, cell / longer, kind)


def _power_noise(draws: Draws, beta: float) -> Floats:
    """Return noise whose power falls with the frequency to the power ``beta``."""
    across, down = np.fft.rfftfreq(SIDE_PX)[None], np.fft.fftfreq(SIDE_PX)[:, None]
    frequency = np.hypot(across, down)
    frequency[0, 0] = 1.0
    waves = draws.normal(size=frequency.shape) + 1j * draws.normal(size=frequency.shape)
    waves /= frequency ** (beta / 2.0)
    waves[0, 0] = 0.0
    return np.fft.irfft2(waves, s=(SIDE_PX, SIDE_PX)).astype(np.float32)


def _patches(draws: Draws, count: int) -> Floats:
    """Return patches of one shade each, or the lines between them."""
    side = SIDE_PX // 2
    down, across = np.mgrid[:side, :side]
    places = cKDTree(draws.uniform(0.0, side, (count, 2)))
    away, nearest = places.query(np.column_stack((across.ravel(), down.ravel())), k=2)
    if draws.random() < 0.5:
        shades = draws.normal(0.0, 1.0, count)[nearest[:, 0]]
    else:
        shades = np.minimum(away[:, 1] - away[:, 0], 4.0)
    coarse = Image.fromarray(shades.reshape(side, side).astype(np.float32))
    return np.asarray(coarse.resize((SIDE_PX, SIDE_PX), Image.Resampling.BILINEAR))


def _stripes(draws: Draws) -> Floats:
    """Return wavy stripes, soft or hard."""
    course, period = draws.uniform(0.0, math.pi), math.exp(draws.uniform(math.log(3), math.log(80)))
    down, across = np.mgrid[:SIDE_PX, :SIDE_PX]
    way = across * math.cos(course) + down * math.sin(course)
    way = way + _value_noise(draws, 120.0, 120.0, Image.Resampling.BICUBIC) * draws.uniform(0, 12)
    waves = np.sin(2.0 * math.pi * way / period)
    return np.asarray(np.sign(waves) if draws.random() < 0.4 else waves, dtype=np.float32)


# --- light, lens and sensor ---------------------------------------------------------------


def _soft(bodies: Mask) -> Floats:
    image = Image.fromarray(bodies.astype(np.uint8) * 255)
    soft = np.asarray(image.filter(ImageFilter.GaussianBlur(0.6)), dtype=np.float32)
    return soft[..., None] / np.float32(255.0)


def _lit(levels: Floats, draws: Draws) -> Floats:
    rows, columns = levels.shape[:2]
    if draws.random() < 0.2:
        across = (np.arange(columns) / columns - 0.5) * draws.normal(0.0, 0.25)
        down = (np.arange(rows) / rows - 0.5)[:, None] * draws.normal(0.0, 0.25)
        levels = levels * np.clip(1.0 + across + down, 0.3, 2.0)[..., None].astype(np.float32)
    if draws.random() < 0.7:
        cast = 0.14 if draws.random() < 0.3 else 0.06
        gains = draws.uniform(1.0 - cast, 1.0 + cast, 3) * draws.uniform(0.6, 1.12)
        bent = (np.arange(256)[:, None] / 255.0) ** math.exp(draws.normal(0.0, 0.25))
        table = np.clip(255.0 * bent * gains + draws.uniform(-10.0, 10.0), 0.0, 255.0)
        levels = np.asarray(_image(levels).point(table.T.ravel().tolist()), dtype=np.float32)
    if draws.random() < 0.08:
        levels = np.repeat(levels.mean(axis=2, keepdims=True), 3, axis=2)
    return levels


def _through_a_lens(levels: Floats, draws: Draws) -> Floats:
    """Return a picture that is blurred, smeared by a motion, or sharpened, or none of it."""
    kind = draws.random()
    if kind < 0.08:
        return _smeared(levels, draws.uniform(1.0, 6.0), draws.uniform(0.0, math.pi))
    if kind < 0.3:
        return _filtered(levels, ImageFilter.GaussianBlur(float(draws.uniform(0.3, 1.3))))
    if kind < 0.38:
        radius, share = float(draws.uniform(0.6, 2.0)), int(draws.integers(40, 160))
        return _filtered(levels, ImageFilter.UnsharpMask(radius, share, 0))
    return levels


def _filtered(levels: Floats, how: ImageFilter.Filter) -> Floats:
    return np.asarray(_image(levels).filter(how), dtype=np.float32)


def _image(levels: Floats) -> Image.Image:
    return Image.fromarray(np.clip(levels, 0.0, 255.0).astype(np.uint8))


def _smeared(levels: Floats, length_px: float, course: float) -> Floats:
    """Return the mean of a picture on its way along a line."""
    steps = max(2, math.ceil(length_px))
    ways = [length_px * (step / (steps - 1) - 0.5) for step in range(steps)]
    moved = [(round(way * math.cos(course)), round(way * math.sin(course))) for way in ways]
    margin = math.ceil(length_px / 2.0)
    rows, columns = levels.shape[:2]
    wide = np.pad(levels, ((margin, margin), (margin, margin), (0, 0)), mode="edge")
    total = np.zeros_like(levels)
    for across, down in moved:
        top, left = margin + down, margin + across
        total += wide[top : top + rows, left : left + columns]
    return total / np.float32(steps)


def _noisy(levels: Floats, draws: Draws) -> tuple[Floats, float]:
    """Return a picture with noise of all kinds, and its mean deviation in levels."""
    spread = math.exp(draws.uniform(math.log(0.7), math.log(10.0)))
    of_colours = draws.random() < 0.7
    shape = levels.shape if of_colours else (*levels.shape[:2], 1)
    noise = draws.standard_normal(shape, dtype=np.float32)
    if draws.random() < 0.3:
        neighbours = [np.roll(noise, by, (0, 1)) for by in ((0, 1), (1, 0), (1, 1))]
        noise = sum(neighbours, start=noise) * np.float32(0.5)
    if draws.random() < 0.3:
        deviations = spread * np.sqrt(levels / 128.0 + 0.05)
        return levels + noise * deviations, float(deviations.mean())
    return levels + noise * np.float32(spread), spread
