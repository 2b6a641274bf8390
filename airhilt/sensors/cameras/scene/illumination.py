"""The sun and the light of a scene, its sky, and what the air does to them.

All colours are linear; `encode` makes 8-bit sRGB of them. All renderers use the numbers of one
`Illumination`, which is why they agree.
"""

from __future__ import annotations

import datetime
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from airhilt.shapes.mesh import Floats, Mesh

CONTRAST_THRESHOLD = 0.02
"""Contrast that is just seen against the horizon at the meteorological visibility: H. Koschmieder,
Beitraege zur Physik der freien Atmosphaere 12 (1924) 33-55."""
EXTINCTION = -math.log(CONTRAST_THRESHOLD)
LIGHTS_BELOW_M = 5000.0
"""Visibility, in m, below which lights are on by day: 3 miles, FAA JO 7110.65, 3-4-10."""
SKY_STEPS = 2048
LOWEST_SKY = -0.25
"""Sine of the elevation where the table of the sky begins."""
LEVELS = 4096
"""Number of levels of linear light that encoding tells apart."""
GLARE = 24.0
"""Sharpness of the bright sky about the sun, by day and in twilight; and of the sun itself."""
TWILIGHT_GLARE = 3.5
DISC = 9000.0
GLARE_ENDS = 7.0
"""Angle at which the glare ends, as 1 less its cosine, times the sharpness."""
OVERCAST = 0.5
"""Cover from which nothing above the overcast is seen."""
AFTERGLOW = (0.5, 0.19, 0.05)

# Elevation of the sun in degrees; linear colours of zenith, horizon, direct light, diffuse light.
_HOURS = (
    (-18.0, (0.0008, 0.0012, 0.003), (0.003, 0.0038, 0.006), (0, 0, 0), (0.004, 0.005, 0.008)),
    (-9.0, (0.003, 0.006, 0.018), (0.016, 0.02, 0.036), (0, 0, 0), (0.012, 0.015, 0.026)),
    (-4.0, (0.014, 0.03, 0.085), (0.1, 0.105, 0.15), (0, 0, 0), (0.04, 0.05, 0.085)),
    (0.0, (0.045, 0.09, 0.21), (0.3, 0.27, 0.29), (0.2, 0.09, 0.03), (0.12, 0.14, 0.19)),
    (6.0, (0.075, 0.16, 0.36), (0.52, 0.5, 0.48), (0.62, 0.42, 0.25), (0.18, 0.21, 0.27)),
    (20.0, (0.08, 0.19, 0.45), (0.57, 0.64, 0.72), (0.84, 0.75, 0.61), (0.23, 0.28, 0.35)),
    (60.0, (0.07, 0.18, 0.46), (0.58, 0.66, 0.75), (0.92, 0.85, 0.75), (0.26, 0.31, 0.38)),
)
"""Drawn by eye after photographs; the sun is worth about three times the blue sky at noon."""


@dataclass(frozen=True)
class Illumination:
    """Sun, sky and air of a scene; they do not change during a run.

    Attributes
    ----------
    sun
        Unit vector towards it: east, north, up.
    visibility_m
        Meteorological visibility.
    overcast
        Cover of the sky: 0 for blue, 1 for white, as fog and rain make it.
    background
        Factor by which ground and clouds are seen farther than bodies.
    texture
        Share of the variation of surfaces about their colours.
    clouds
        Share of the sky in which thin clouds are seen.
    wet
        True if rain has wetted the ground.
    """

    sun: npt.NDArray[np.float64]
    visibility_m: float
    overcast: float
    background: float = 1.0
    texture: float = 0.0
    clouds: float = 0.0
    wet: bool = False

    @property
    def key(self) -> list[float]:
        """Numbers that determine everything else."""
        air = self.visibility_m, self.overcast, self.background
        return [*self.sun.tolist(), *air, self.texture, self.clouds, float(self.wet)]

    @property
    def sun_elevation_rad(self) -> float:
        """Elevation of the sun above the horizon."""
        return math.asin(min(max(float(self.sun[2]), -1.0), 1.0))

    @cached_property
    def darkness(self) -> float:
        """0 in daylight, 1 at night, between them while the sun is low."""
        return min(max((4.0 - math.degrees(self.sun_elevation_rad)) / 10.0, 0.0), 1.0)

    @property
    def needs_lights(self) -> bool:
        """The lights of an airport are on."""
        return self.darkness > 0.0 or self.visibility_m < LIGHTS_BELOW_M

    @cached_property
    def extinction_per_m(self) -> float:
        """Extinction of the air: Koschmieder's 3.912 / V."""
        return EXTINCTION / self.visibility_m

    @cached_property
    def _hour(self) -> tuple[Floats, Floats, Floats, Floats]:
        elevation = math.degrees(self.sun_elevation_rad)
        at = [row[0] for row in _HOURS]
        table = np.array([row[1:] for row in _HOURS], dtype=np.float64)
        mixed = np.array(
            [[np.interp(elevation, at, table[:, i, c]) for c in range(3)] for i in range(4)]
        )
        zenith, horizon, direct, diffuse = mixed
        grey = horizon.mean() * np.array((0.94, 0.98, 1.0))
        cover = self.overcast
        horizon = horizon * (1.0 - cover) + cover * grey
        zenith = zenith * (1.0 - cover) + cover * 0.82 * grey
        cloudy = diffuse.mean() * 1.35 * np.ones(3)
        return (
            zenith.astype(np.float32),
            horizon.astype(np.float32),
            (direct * (1.0 - 0.92 * cover)).astype(np.float32),
            (diffuse * (1.0 - cover) + cover * cloudy).astype(np.float32),
        )

    @property
    def airlight(self) -> Floats:
        """Colour of an endless way through the air: that of the horizon."""
        return self._hour[1]

    @property
    def direct(self) -> Floats:
        """Light of the sun on a surface that faces it."""
        return self._hour[2]

    @property
    def diffuse(self) -> Floats:
        """Light of the sky on a surface that faces up."""
        return self._hour[3]

    @property
    def reflected(self) -> Floats:
        """Light of the ground on a surface that faces down."""
        return np.asarray(0.6 * self.diffuse + 0.1 * self.direct, dtype=np.float32)

    @cached_property
    def deck(self) -> Floats:
        """Colour of thin clouds high above."""
        return np.asarray(0.8 * self.diffuse + 0.5 * self.direct, dtype=np.float32)

    @property
    def shows_deck(self) -> bool:
        """True if thin clouds are seen: there are some, and no overcast hides them."""
        return self.clouds > 0.0 and self.overcast < OVERCAST

    @cached_property
    def sky(self) -> Floats:
        """Colours by the sine of the elevation, from `LOWEST_SKY` to 1; shape (SKY_STEPS, 3)."""
        zenith, horizon, _, _ = self._hour
        sine = np.clip(np.linspace(LOWEST_SKY, 1.0, SKY_STEPS), 0.0, 1.0)
        # Air of this visibility in a layer of 1.2 km hides the blue: Koschmieder upwards.
        veil = np.exp(-sine * 9.0 * min(1.0, self.visibility_m / 10_000.0) ** 0.5)
        depth = EXTINCTION * 1200.0 / self.visibility_m
        veil = np.maximum(veil, 1.0 - np.exp(-depth / np.maximum(sine, 0.02)) ** 0.35)
        return np.asarray(zenith + (horizon - zenith) * veil[:, None], dtype=np.float32)

    @property
    def _twilight(self) -> float:
        """1 with the sun on the horizon, 0 with it 9 degrees above or below."""
        return max(1.0 - abs(math.degrees(self.sun_elevation_rad)) / 9.0, 0.0)

    @cached_property
    def glare(self) -> Floats:
        """Colour that is added about the sun."""
        afterglow = self._twilight * np.array(AFTERGLOW)
        glare = (0.5 * self.direct + afterglow) * (1.0 - self.overcast)
        return np.asarray(glare, dtype=np.float32)

    @property
    def glare_sharpness(self) -> float:
        """Rate at which the glare fades away from the sun: the afterglow is wide."""
        return GLARE + self._twilight * (TWILIGHT_GLARE - GLARE)

    @property
    def disc(self) -> float:
        """Brightness of the sun itself against the glare."""
        return 20.0 if self.sun[2] > 0.0 else 0.0

    def sky_steps(self, up: Floats) -> npt.NDArray[np.intp]:
        """Return entries of `sky` by the sine of the elevation."""
        step = (up - np.float32(LOWEST_SKY)) * np.float32((SKY_STEPS - 1) / (1.0 - LOWEST_SKY))
        return np.asarray(np.clip(step + np.float32(0.5), 0, SKY_STEPS - 1), dtype=np.intp)

    @property
    def glare_from(self) -> float:
        """Cosine of the angle from the sun at which its glare ends."""
        return 1.0 - GLARE_ENDS / self.glare_sharpness

    def glare_at(self, apart: Floats) -> Floats:
        """Return what the sun adds at some angles, given as 1 less their cosine; shape (3, n)."""
        lobes = np.exp(-self.glare_sharpness * apart) + self.disc * np.exp(-DISC * apart)
        return np.asarray(self.glare[:, None] * lobes, dtype=np.float32)

    def shade(self, colours: Floats, normals: Floats, sunlit: Floats | float = 1.0) -> Floats:
        """Return the light that matt surfaces send back, shape (n, 3)."""
        facing = np.maximum(normals @ self.sun.astype(np.float32), 0.0) * sunlit
        upward = (0.5 + 0.5 * normals[:, 2])[:, None]
        light = facing[:, None] * self.direct
        light += self.reflected + upward * (self.diffuse - self.reflected)
        return np.asarray(colours * light, dtype=np.float32)

    def baked(self, mesh: Mesh) -> Floats:
        """Return the light that triangles which never move send out, shape (n, 3)."""
        lit = self.shade(mesh.colours, mesh.mean_normals, mesh.sunlit)
        return lit + (mesh.glow * np.float32(self.darkness))[:, None] * mesh.colours

    @property
    def background_extinction_per_m(self) -> float:
        """Extinction of the air before ground and clouds."""
        return self.extinction_per_m / self.background

    def through_air(self, colours: Floats, distances_m: Floats, extinction_per_m: float) -> Floats:
        """Return what is left of light after some way, and what the air adds; changes colours.

        Colours are of shape (3, n), distances of shape (n,).
        """
        left = np.exp(distances_m * np.float32(-extinction_per_m))
        for channel, air in zip(colours, self.airlight, strict=True):
            channel -= air
            channel *= left
            channel += air
        return colours


def _encoding_table() -> npt.NDArray[np.uint8]:
    linear = (np.arange(LEVELS) + 0.5) / LEVELS
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)
    return np.asarray(np.round(255.0 * encoded), dtype=np.uint8)


_ENCODED = _encoding_table()


def encode(linear: Floats) -> npt.NDArray[np.uint8]:
    """Return linear light, shape (3, n), as pixels in 8-bit sRGB (IEC 61966-2-1), shape (n, 3)."""
    pixels = np.empty((linear.shape[1], 3), dtype=np.uint8)
    for channel, light in enumerate(linear):
        pixels[:, channel] = encode_levels(light * np.float32(LEVELS))
    return pixels


def encode_levels(levels: Floats) -> npt.NDArray[np.uint8]:
    """Return one channel of linear light, white being `LEVELS`, in 8-bit sRGB."""
    return np.asarray(_ENCODED.take(levels.astype(np.intp), mode="clip"))


def sun_direction(
    latitude_rad: float, date: datetime.date, solar_time_h: float
) -> npt.NDArray[np.float64]:
    """Return the unit vector towards the sun: east, north, up.

    Parameters
    ----------
    solar_time_h
        Local apparent solar time: the sun is highest at 12.

    Notes
    -----
    Declination by the Fourier series of J. W. Spencer, Search 2 (1971) 172, to 0.01 degrees, as in
    NOAA, General Solar Position Calculations. Refraction is left out.
    """
    year = math.tau / 365.0 * (date.timetuple().tm_yday - 1 + (solar_time_h - 12.0) / 24.0)
    declination = (
        0.006918
        - 0.399912 * math.cos(year)
        + 0.070257 * math.sin(year)
        - 0.006758 * math.cos(2.0 * year)
        + 0.000907 * math.sin(2.0 * year)
        - 0.002697 * math.cos(3.0 * year)
        + 0.00148 * math.sin(3.0 * year)
    )
    hour_angle = (solar_time_h - 12.0) * math.tau / 24.0
    east = -math.cos(declination) * math.sin(hour_angle)
    north = math.sin(declination) * math.cos(latitude_rad) - math.cos(declination) * math.cos(
        hour_angle
    ) * math.sin(latitude_rad)
    up = math.sin(declination) * math.sin(latitude_rad) + math.cos(declination) * math.cos(
        hour_angle
    ) * math.cos(latitude_rad)
    return np.array((east, north, up))
