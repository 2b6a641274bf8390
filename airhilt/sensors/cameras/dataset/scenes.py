"""Random scenes to learn from: a world in some light, cameras in it, and bodies before them.

What a detector must tell apart is drawn on purpose: bodies as large and as far as they come, in
all weathers, from all stations, and many pictures without any.
"""

from __future__ import annotations

import datetime
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from shapely import Point

from airhilt.errors import CameraError
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.scenario.models import Daylight, Weather
from airhilt.sensors.cameras.mounts import Camera, station_mount
from airhilt.sensors.cameras.scene.bodies import (
    BodyState,
    Model,
    aircraft_model,
    kind_model,
)
from airhilt.sensors.cameras.scene.builder import air_and_sun
from airhilt.sensors.cameras.scene.illumination import EXTINCTION, Illumination
from airhilt.sensors.cameras.scene.landscape import World, airport_world, open_country
from airhilt.sensors.cameras.view import Intrinsics, Pose, View
from airhilt.units import DEGREE
from airhilt.world.surface.airport import load_airport
from airhilt.world.surface.layout import Layout

EN_ROUTE = "en_route"
"""In place of an airport: open country."""
SMALLEST_PX, LARGEST_PX = 5.0, 250.0
"""Between which the sizes of bodies in the pictures are spread, evenly in their logarithm."""
FAINTEST = 0.03
"""Part of a body's contrast that the air must leave for it to be placed."""
FARTHEST_M = 20_000.0
FIELDS_OF_VIEW = (10.0, 75.0)
"""In degrees. Narrow ones show things as large as parts of bigger pictures do, which are looked at
tile by tile."""
TRIES = 15
"""To place a body within a picture; some pictures have no room for one."""
FIXED_CAMERAS = 6
SHOTS_OF_A_CAMERA = 4
"""Few of each, so that there are many skies and grounds."""
FLIGHT_LATITUDES = (30.0, 55.0)
"""In degrees, of open country."""
DAYS_OF_A_YEAR = 365

# Kinds, how often each is drawn, and its greatest extent in metres.
_AIRCRAFT = (("737", 20, 36.6), ("B747", 12, 75.9), ("c172p", 14, 11.0), ("c310", 10, 10.9))
_VEHICLES = (("follow_me", 8, 5.8), ("fire_truck", 9, 11.6), ("snow_plough", 8, 19.8),
             ("tug_with_aircraft", 2, 52.6))  # fmt: skip
_BIRDS = (("goose", 9, 1.6), ("flock", 7, 14.4))
_GAME = (("deer", 14, 1.9), ("coyote", 12, 1.2))
_MODELS: tuple[tuple[Callable[[str], Model], tuple[tuple[str, int, float], ...]], ...] = (
    (aircraft_model, _AIRCRAFT),
    (kind_model, _VEHICLES),
    (kind_model, (*_BIRDS, *_GAME)),
)
_EXTENT_M = {kind: extent for _, group in _MODELS for kind, _, extent in group}
_OFTEN = {kind: often for _, group in _MODELS for kind, often, _ in group}
_FLYING = frozenset(kind for kind, *_ in (*_AIRCRAFT, *_BIRDS))
_COPIES = 3
"""Bodies of one kind in a picture, at most."""


@dataclass(frozen=True)
class Sitting:
    """A world in one light, with cameras and with what may stand before them.

    Attributes
    ----------
    place
        ICAO location indicator, or `EN_ROUTE`.
    models
        By actor: some carry cameras, the others are named after their kind.
    order
        The cameras of the pictures to take, in turn.
    """

    place: str
    weather: Weather
    daylight: Daylight
    light: Illumination
    world: World
    layout: Layout | None
    height_m: float
    models: Mapping[str, Model]
    cameras: Mapping[str, Camera]
    stations: Mapping[str, str]
    order: Sequence[str]


class Casting:
    """Draws sittings and shots, and keeps what all of them share.

    Parameters
    ----------
    places
        ICAO location indicators, or `EN_ROUTE`, in turn.
    size
        Width and height of the pictures.

    Raises
    ------
    AirhiltError
        There is no such airport, or pictures cannot have that size.
    """

    def __init__(self, places: Sequence[str], size: tuple[int, int]) -> None:
        self._size = size
        Intrinsics(*size, 1.0)
        self._layouts = {
            place: None if place == EN_ROUTE else Layout(load_airport(place)) for place in places
        }
        self._models = {kind: make(kind) for make, group in _MODELS for kind, *_ in group}

    def sitting(self, number: int, draws: np.random.Generator) -> Sitting:
        """Return a world with its cameras."""
        place = list(self._layouts)[number % len(self._layouts)]
        layout = self._layouts[place]
        latitude = math.radians(float(draws.uniform(*FLIGHT_LATITUDES)))
        frame = LocalFrame((latitude, 0.0)) if layout is None else layout.frame
        weather, daylight, light = _weather(frame, layout is None, draws)
        height = math.exp(draws.uniform(math.log(400.0), math.log(9000.0)))
        if layout is not None:
            world = airport_world(layout, light)
        else:
            clouds = 0.6 * height if height > 700.0 and draws.random() < 0.7 else None
            world = open_country(light, f"{draws.integers(1 << 30)}", clouds)
        models = {
            f"{kind}-{copy}": model
            for kind, model in self._models.items()
            for copy in range(_COPIES)
        }
        cameras: dict[str, Camera] = {}
        stations: dict[str, str] = {}
        for index in range(5 if layout is not None else 8):
            carrier = f"carrier-{index}"
            models[carrier] = self._models[_pick([kind for kind, *_ in _AIRCRAFT], draws)]
            station = "nose" if index % 5 < 3 else "tail"
            name = f"{station}-{index}"
            mount = station_mount(name, carrier, station, models)
            cameras[name] = Camera(name, self._lens(draws), mount)
            stations[name] = station
        if layout is not None:
            for index in range(FIXED_CAMERAS):
                name = f"fixed-{index}"
                cameras[name] = self._fixed(name, layout, world, draws)
                stations[name] = "fixed"
        order = [name for name in cameras for _ in range(SHOTS_OF_A_CAMERA)]
        order = [order[index] for index in draws.permutation(len(order))]
        return Sitting(
            place, weather, daylight, light, world, layout, height, models, cameras, stations, order
        )

    def _lens(self, draws: np.random.Generator) -> Intrinsics:
        fov = math.exp(draws.uniform(*np.log(FIELDS_OF_VIEW)))
        return Intrinsics(*self._size, fov * DEGREE)

    def _fixed(self, name: str, layout: Layout, world: World, draws: np.random.Generator) -> Camera:
        """Return a camera on the tower, beside a runway or somewhere on the field."""
        while True:
            pose = _standpoint(layout, draws)
            try:
                world.require_free(name, pose.position_m)
            except CameraError:
                continue
            return Camera(name, self._lens(draws), pose)


def cast(
    sitting: Sitting, camera: str, draws: np.random.Generator, empty: float
) -> list[BodyState]:
    """Return who stands, drives, walks and flies before a camera.

    Parameters
    ----------
    empty
        Part of the pictures that have nobody in them.
    """
    bodies: dict[str, BodyState] = {}
    chosen = sitting.cameras[camera]
    if not isinstance(chosen.at, Pose):
        carrier = chosen.at.actor
        bodies[carrier] = _carrier(sitting, carrier, draws)
    view = chosen.view(bodies)
    count = 0 if draws.random() < empty else 1 + int(draws.integers(6))
    free = [actor for actor in sitting.models if not actor.startswith("carrier")]
    if sitting.layout is None:
        free = [actor for actor in free if _kind(actor) in _FLYING]
    for _ in range(count):
        often = np.array([_OFTEN[_kind(actor)] for actor in free], dtype=float)
        actor = free.pop(int(draws.choice(len(free), p=often / often.sum())))
        body = _placed(sitting, actor, view, draws)
        if body is not None:
            bodies[actor] = body
    return list(bodies.values())


# --- light and cameras --------------------------------------------------------------------


def _weather(
    frame: LocalFrame, en_route: bool, draws: np.random.Generator
) -> tuple[Weather, Daylight, Illumination]:
    """Return weather and daylight: day, twilight and night in turn by chance."""
    visibility = math.exp(draws.uniform(math.log(800.0), math.log(30_000.0)))
    rain = math.exp(draws.uniform(0.0, math.log(30.0))) if draws.random() < 0.2 else 0.0
    weather = Weather(visibility_m=visibility, rain_mm_h=rain)
    low, high = _HOURS[int(draws.choice(len(_HOURS), p=[0.62, 0.2, 0.18]))]
    while True:
        day = datetime.timedelta(days=int(draws.integers(DAYS_OF_A_YEAR)))
        daylight = Daylight(
            date=datetime.date(2026, 1, 1) + day, solar_time_h=float(draws.uniform(0.0, 24.0))
        )
        light = air_and_sun(weather, daylight, frame.origin[0], en_route)
        if low <= math.degrees(light.sun_elevation_rad) < high:
            return weather, daylight, light


_HOURS = ((6.0, 90.0), (-6.0, 6.0), (-30.0, -6.0))
"""Elevations of the sun in degrees: day, twilight, night."""


def _standpoint(layout: Layout, draws: np.random.Generator) -> Pose:
    airport = layout.airport
    azimuth = float(draws.uniform(0.0, math.tau))
    level = float(draws.normal(-2.0, 4.0)) * DEGREE
    choice = draws.random()
    if choice < 0.3 and airport.tower is not None:
        east, north = layout.frame.to_local(airport.tower.place)
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


def _carrier(sitting: Sitting, actor: str, draws: np.random.Generator) -> BodyState:
    """Return an aircraft that carries a camera: on the ground, on final, or in flight."""
    kind = sitting.models[actor].aircraft
    assert kind is not None
    layout = sitting.layout
    choice = draws.random()
    if layout is not None and choice < 0.35:
        (east, north), heading = _on_pavement(layout, draws)
        wheels = kind.dimensions.wheel_height_offset_m
        return BodyState(actor, east, north, wheels, heading, 0.0, 0.0, "gear", True)
    if layout is not None and choice < 0.7:
        (east, north, up), heading = _on_final(layout, draws)
    else:
        east, north = (float(value) for value in draws.uniform(-4000.0, 4000.0, size=2))
        up = float(draws.uniform(120.0, 1500.0))
        heading = float(draws.uniform(0.0, math.tau))
        if layout is None:
            up = sitting.height_m * float(draws.uniform(0.95, 1.1))
    pitch, roll = _attitude(draws)
    shape = "gear" if up < 600.0 else "clean"
    return BodyState(actor, east, north, up, heading, pitch, roll, shape, up < 3048.0)


# --- who stands before them ---------------------------------------------------------------


def _kind(actor: str) -> str:
    return actor.rpartition("-")[0]


def _placed(
    sitting: Sitting, actor: str, view: View, draws: np.random.Generator
) -> BodyState | None:
    """Return a body somewhere in a picture, None where there is no room for it."""
    kind = _kind(actor)
    model = sitting.models[actor]
    aloft = kind in _FLYING and (sitting.layout is None or draws.random() < 0.6)
    wheels = 0.0
    if model.aircraft is not None:
        wheels = model.aircraft.dimensions.wheel_height_offset_m
    seen_m = min(-math.log(FAINTEST) / EXTINCTION * sitting.light.visibility_m, FARTHEST_M)
    for _ in range(TRIES):
        size = math.exp(draws.uniform(math.log(SMALLEST_PX), math.log(LARGEST_PX)))
        # What is seen of the greatest extent, from most sides.
        away = 0.85 * _EXTENT_M[kind] * view.intrinsics.focal_px / size
        if away > seen_m or away < _EXTENT_M[kind]:
            continue
        place = _place(sitting, view, away, aloft, wheels, draws)
        if place is None:
            continue
        position, heading = place
        pixel = view.in_camera(position)
        if pixel[2] <= 0.0 or not _within(view, view.pixels(pixel)):
            continue
        if math.dist(position, view.pose.position_m) > seen_m:
            continue
        if any(
            position[2] < block.height_m and block.outline.covers(Point(*position[:2]))
            for block in sitting.world.blocks
        ):
            continue
        return _body(actor, model, position, heading, aloft, draws)
    return None


def _place(
    sitting: Sitting,
    view: View,
    away_m: float,
    aloft: bool,
    wheels_m: float,
    draws: np.random.Generator,
) -> tuple[tuple[float, float, float], float] | None:
    """Return a place and a heading, in the picture or not."""
    camera = view.pose.position_m
    heading = float(draws.uniform(0.0, math.tau))
    choice = draws.random()
    if aloft:
        if sitting.layout is not None and choice < 0.2:
            return _on_final(sitting.layout, draws)
        column = np.array([draws.uniform(0.0, view.intrinsics.width_px)], dtype=np.float32)
        row = np.array([draws.uniform(0.0, view.intrinsics.height_px)], dtype=np.float32)
        towards = view.directions(column, row)[:, 0]
        east, north, up = (
            float(at + away_m * part) for at, part in zip(camera, towards, strict=True)
        )
        if up < wheels_m + 3.0:
            return None
        if choice > 0.5:
            # It comes, or is being overtaken.
            side = 1.0 if choice > 0.65 else -1.0
            course = math.atan2(side * (camera[0] - east), side * (camera[1] - north))
            heading = course + float(draws.normal(0.0, 15.0)) * DEGREE
        return (east, north, up), heading
    if sitting.layout is not None and choice < 0.3:
        (east, north), heading = _on_pavement(sitting.layout, draws)
        return (east, north, wheels_m), heading
    if away_m <= camera[2]:
        return None
    level = math.sqrt(away_m**2 - camera[2] ** 2)
    ahead = view.pose.rotation[:, 1]
    side = float(draws.uniform(-0.5, 0.5)) * view.intrinsics.horizontal_fov_rad
    azimuth = math.atan2(ahead[0], ahead[1]) + side
    east = camera[0] + level * math.sin(azimuth)
    north = camera[1] + level * math.cos(azimuth)
    return (east, north, wheels_m), heading


def _within(view: View, pixel: np.ndarray) -> bool:
    lens = view.intrinsics
    return bool(0.0 <= pixel[0] < lens.width_px and 0.0 <= pixel[1] < lens.height_px)


def _body(
    actor: str,
    model: Model,
    position: tuple[float, float, float],
    heading: float,
    aloft: bool,
    draws: np.random.Generator,
) -> BodyState:
    east, north, up = position
    if model.aircraft is not None:
        pitch, roll = _attitude(draws) if aloft else (0.0, 0.0)
        low = up < 600.0 and (not aloft or draws.random() < 0.7)
        lit = up < 3048.0 and draws.random() < (0.9 if aloft else 0.5)
        return BodyState(
            actor, east, north, up, heading, pitch, roll, "gear" if low else "clean", lit
        )
    shapes = [name for name in model.shapes if name.startswith("flying") == aloft]
    shape = shapes[int(draws.integers(len(shapes)))]
    return BodyState(actor, east, north, up, heading, 0.0, 0.0, shape, True)


def _attitude(draws: np.random.Generator) -> tuple[float, float]:
    """Return pitch and roll in flight: most fly straight, some turn."""
    bank = 3.0 if draws.random() < 0.7 else 18.0
    return float(draws.normal(2.0, 3.0)) * DEGREE, float(draws.normal(0.0, bank)) * DEGREE


def _on_final(
    layout: Layout, draws: np.random.Generator
) -> tuple[tuple[float, float, float], float]:
    """Return a place on the glide path of a runway, and the heading of who flies there."""
    ends = [end for strip in layout.strips.values() for end in strip.ends]
    end = ends[int(draws.integers(len(ends)))]
    east, north = layout.frame.to_local(end.threshold)
    before = math.exp(draws.uniform(math.log(150.0), math.log(12_000.0)))
    aside = float(draws.normal(0.0, 0.01)) * before
    sin, cos = math.sin(end.course_rad), math.cos(end.course_rad)
    up = 18.0 + before * math.tan(end.glide_path_rad + float(draws.normal(0.0, 0.003)))
    place = east - before * sin + aside * cos, north - before * cos - aside * sin, up
    return place, end.course_rad + float(draws.normal(0.0, 2.0)) * DEGREE


def _on_pavement(layout: Layout, draws: np.random.Generator) -> tuple[tuple[float, float], float]:
    """Return a place on a runway or a taxiway, and a heading along it."""
    airport = layout.airport
    edges = airport.taxiways.edges
    if edges and draws.random() < 0.6:
        nodes = edges[int(draws.integers(len(edges)))].nodes
        start, end = (np.asarray(layout.frame.to_local(layout.node(name))) for name in nodes)
    else:
        strip = list(layout.strips.values())[int(draws.integers(len(layout.strips)))]
        start, end = (np.asarray(corner) for corner in strip.centreline.coords)
    if draws.random() < 0.5:
        start, end = end, start
    east, north = start + float(draws.random()) * (end - start)
    along = end - start
    return (float(east), float(north)), math.atan2(along[0], along[1])


def _pick(kinds: Sequence[str], draws: np.random.Generator) -> str:
    return kinds[int(draws.integers(len(kinds)))]
