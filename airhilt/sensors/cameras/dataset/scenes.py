"""Random scenes to learn from: a landscape in some light, cameras in it, and bodies before them.

What a detector must tell apart is drawn on purpose: bodies as large and as far as they come, in
all weathers, from all stations, and many pictures without any.
"""

from __future__ import annotations

import datetime
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from airhilt.errors import CameraError
from airhilt.imaging.view import Intrinsics, Pose
from airhilt.scenario.models import Daylight, Imaging, Weather
from airhilt.sensors.cameras.mounts import Camera, station_mount
from airhilt.sensors.cameras.scene.bodies import Model, aircraft_model, kind_model
from airhilt.sensors.cameras.scene.builder import air_and_sun
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.landscape import (
    Landscape,
    airport_landscape,
    casts_shadows,
    open_country,
)
from airhilt.sim.streams import stream
from airhilt.units import DEGREE
from airhilt.world.surface.layout import Layout, load_layout

EN_ROUTE = "en_route"
"""Name of open country, in place of an airport."""
FIELDS_OF_VIEW = (10.0, 75.0)
"""Least and greatest field of view, in degrees. Narrow ones show things as large as the tiles of
bigger pictures do."""
FIXED_CAMERAS = 6
PICTURES_PER_WORLD = 10
"""Pictures of a world: few, so that there are many skies, grounds and lights."""
FLIGHT_LATITUDES = (30.0, 55.0)
"""Least and greatest latitude of open country, in degrees."""
DAYS_OF_A_YEAR = 365

# Kinds, how often each is drawn, and its greatest extent in metres.
AIRCRAFT = (("737", 20, 36.6), ("B747", 12, 75.9), ("c172p", 14, 11.0), ("c310", 10, 10.9))
VEHICLES = (("follow_me", 8, 5.8), ("fire_truck", 9, 11.6), ("snow_plough", 8, 19.8),
             ("tug_with_aircraft", 2, 52.6))  # fmt: skip
BIRDS = (("goose", 9, 1.6), ("flock", 7, 14.4))
GAME = (("deer", 14, 1.9), ("coyote", 12, 1.2))
KINDS: tuple[tuple[Callable[[str], Model], tuple[tuple[str, int, float], ...]], ...] = (
    (aircraft_model, AIRCRAFT),
    (kind_model, VEHICLES),
    (kind_model, (*BIRDS, *GAME)),
)
_HOURS = ((6.0, 90.0), (-6.0, 6.0), (-30.0, -6.0))
"""Elevations of the sun in degrees: day, twilight, night."""
LIVERIES = 8
"""Liveries that are drawn of each type of aircraft."""
_COPIES = 3
"""Bodies of one kind in a picture, at most."""


@dataclass(frozen=True)
class Sitting:
    """A landscape in one light, with cameras and with what may stand before them.

    Attributes
    ----------
    place
        ICAO location indicator of the airport, or `EN_ROUTE`.
    models
        Models by actor: some carry cameras, the others are named after their kind.
    cameras
        Cameras by their names, which begin with their stations. No two worlds share one, as noise
        and rain differ by it.
    order
        Names of all cameras, in the order in which they take their turns.
    """

    place: str
    weather: Weather
    daylight: Daylight
    light: Illumination
    landscape: Landscape
    layout: Layout | None
    height_m: float
    models: Mapping[str, Model]
    cameras: Mapping[str, Camera]
    order: Sequence[str]


def station_of(camera: str) -> str:
    """Return the station of a camera of a sitting: ``fixed``, ``nose`` or ``tail``."""
    return camera.partition("-")[0]


class Casting:
    """Draws sittings and shots, and keeps what all of them share.

    Raises
    ------
    AirhiltError
        There is no such airport, or pictures cannot have that size.
    """

    def __init__(self, places: Sequence[str], size: tuple[int, int]) -> None:
        self._size = size
        self._layouts = {
            place: None if place == EN_ROUTE else load_layout(place) for place in places
        }
        self._models = {kind: make(kind) for make, group in KINDS for kind, *_ in group}
        self._in_shade: dict[tuple[str, bool, bool], Landscape] = {}
        self._painted = {
            (kind, livery): aircraft_model(kind, livery=livery)
            for kind, *_ in AIRCRAFT
            for livery in range(LIVERIES)
        }

    def sitting(self, number: int, seed: int, purpose: str) -> Sitting:
        """Return a landscape with its cameras; places take turns.

        Two places, or two purposes, never have the same weather and cameras by the same seed.
        """
        place = list(self._layouts)[number % len(self._layouts)]
        layout = self._layouts[place]
        draws = stream(seed, f"{purpose}/{place}", number)
        latitude = math.radians(float(draws.uniform(*FLIGHT_LATITUDES)))
        if layout is not None:
            latitude = layout.local_frame.origin[0]
        weather, daylight, light = _weather(latitude, layout is None, draws)
        height = math.exp(draws.uniform(math.log(400.0), math.log(9000.0)))
        if layout is not None:
            landscape = self._airport(layout, light)
        else:
            clouds = 0.6 * height if height > 700.0 and draws.random() < 0.7 else None
            landscape = open_country(light, f"{draws.integers(1 << 30)}", clouds)
        models = {
            f"{kind}-{copy}": self._painted.get((kind, (number + copy) % LIVERIES), model)
            for kind, model in self._models.items()
            for copy in range(_COPIES)
        }
        cameras: dict[str, Camera] = {}
        for index in range(5 if layout is not None else 8):
            carrier = f"carrier-{index}"
            kind, *_ = AIRCRAFT[int(draws.integers(len(AIRCRAFT)))]
            model = self._models[kind]
            models[carrier] = model
            station = "nose" if index % 5 < 3 else "tail"
            name = f"{station}-{index}-{seed}-{number}"
            mount = station_mount(name, carrier, station, model.aircraft)
            cameras[name] = Camera(name, self._lens(draws), mount, _imaging(draws))
        if layout is not None:
            for index in range(FIXED_CAMERAS):
                name = f"fixed-{index}-{seed}-{number}"
                cameras[name] = self._fixed(name, layout, landscape, draws)
        names = list(cameras)
        order = [names[index] for index in draws.permutation(len(names))]
        return Sitting(
            place, weather, daylight, light, landscape, layout, height, models, cameras, order
        )

    def _airport(self, layout: Layout, light: Illumination) -> Landscape:
        """Return an airport; without shadows and clouds it is the same in all lights."""
        if casts_shadows(light) or light.shows_deck:
            return airport_landscape(layout, light)
        key = layout.airport.icao, light.texture > 0.0, light.wet
        if key not in self._in_shade:
            self._in_shade[key] = airport_landscape(layout, light)
        return self._in_shade[key]

    def _lens(self, draws: np.random.Generator) -> Intrinsics:
        fov = math.exp(draws.uniform(*np.log(FIELDS_OF_VIEW)))
        return Intrinsics(*self._size, fov * DEGREE)

    def _fixed(
        self, name: str, layout: Layout, landscape: Landscape, draws: np.random.Generator
    ) -> Camera:
        """Return a camera on the tower, beside a runway or somewhere on the field."""
        while True:
            pose = _standpoint(layout, draws)
            try:
                landscape.require_free(name, pose.position_m)
            except CameraError:
                continue
            return Camera(name, self._lens(draws), pose, _imaging(draws))


def _imaging(draws: np.random.Generator) -> Imaging:
    """Return lens, sensor and coder of a camera: good ones, and as often poor ones."""
    if draws.random() < 0.5:
        return Imaging()
    return Imaging(
        exposure_ev=float(np.clip(draws.normal(0.0, 0.5), -1.5, 1.5)),
        vignetting=float(draws.uniform(0.0, 0.6)),
        blur_px=float(draws.uniform(0.0, 1.1)),
        fixed_pattern=float(draws.uniform(0.0, 0.015)),
        noise_levels=float(np.exp(draws.uniform(np.log(0.5), np.log(8.0)))),
        jpeg_quality=int(draws.integers(40, 96)) if draws.random() < 0.5 else None,
    )


def _weather(
    latitude_rad: float, en_route: bool, draws: np.random.Generator
) -> tuple[Weather, Daylight, Illumination]:
    """Return weather and daylight: day, twilight and night in turn by chance."""
    visibility = math.exp(draws.uniform(math.log(800.0), math.log(30_000.0)))
    rain = math.exp(draws.uniform(0.0, math.log(30.0))) if draws.random() < 0.2 else 0.0
    cover = float(draws.uniform()) if draws.random() < 0.6 else 0.0
    weather = Weather(visibility_m=visibility, rain_mm_h=rain, cloud_cover=cover)
    texture = float(draws.uniform(0.3, 1.0)) if draws.random() < 0.9 else 0.0
    low, high = _HOURS[int(draws.choice(len(_HOURS), p=[0.62, 0.2, 0.18]))]
    while True:
        day = datetime.timedelta(days=int(draws.integers(DAYS_OF_A_YEAR)))
        daylight = Daylight(
            date=datetime.date(2026, 1, 1) + day, solar_time_h=float(draws.uniform(0.0, 24.0))
        )
        light = air_and_sun(weather, daylight, texture, latitude_rad, en_route)
        if low <= math.degrees(light.sun_elevation_rad) < high:
            return weather, daylight, light


def _standpoint(layout: Layout, draws: np.random.Generator) -> Pose:
    airport = layout.airport
    azimuth = float(draws.uniform(0.0, math.tau))
    level = float(draws.normal(-2.0, 4.0)) * DEGREE
    choice = draws.random()
    if choice < 0.3 and airport.tower is not None:
        east, north = layout.local_frame.to_local(airport.tower.place)
        up = airport.tower.height_m + float(draws.uniform(1.0, 15.0))
        return Pose.of((east, north, up), azimuth, level - 2.0 * DEGREE)
    strip = list(layout.strips.values())[int(draws.integers(len(layout.strips)))]
    line = strip.centreline
    along = float(draws.uniform(-0.1, 1.1)) * line.length
    (x0, y0), (x1, y1) = line.coords[0], line.coords[-1]
    ahead = np.array((x1 - x0, y1 - y0)) / line.length
    across = np.array((ahead[1], -ahead[0]))
    offset = float(draws.uniform(40.0, 160.0)) * (1.0 if draws.random() < 0.5 else -1.0)
    if choice < 0.7:
        east, north = np.array((x0, y0)) + along * ahead + offset * across
        up = float(draws.uniform(3.0, 12.0))
        course = math.atan2(ahead[0], ahead[1]) + (math.pi if draws.random() < 0.5 else 0.0)
        azimuth = course + float(draws.normal(0.0, 25.0)) * DEGREE
        # As often as not it watches those who come down the glide path.
        level = max(level, float(draws.uniform(-2.0, 6.0)) * DEGREE)
    else:
        east, north = np.array((x0, y0)) + along * ahead + 5.0 * offset * across
        up = float(draws.uniform(2.5, 40.0))
    return Pose.of((float(east), float(north), up), azimuth, level)
