"""Pictures with the truth about them: of random worlds, and of the cameras of a scenario."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from itertools import islice
from typing import Any

from airhilt.errors import CameraError
from airhilt.host import library
from airhilt.scenario import Scenario
from airhilt.scenario.models import Daylight, Imaging, Weather
from airhilt.sensors.cameras import AUTO
from airhilt.sensors.cameras.body_states import states_of
from airhilt.sensors.cameras.dataset.placement import cast, gone_on
from airhilt.sensors.cameras.dataset.scenes import (
    EN_ROUTE,
    PICTURES_PER_WORLD,
    Casting,
    Sitting,
    station_of,
)
from airhilt.sensors.cameras.frame import Frame
from airhilt.sensors.cameras.mounts import local_frame_of
from airhilt.sensors.cameras.scene.builder import light_of, open_scene_renderer
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene_renderer import SceneRenderer
from airhilt.sensors.cameras.snapshot import TICK_S
from airhilt.sim.streams import stream
from airhilt.units import DEGREE, seconds_to_ns
from airhilt.world.actors import build_actors
from airhilt.world.loading import draw
from airhilt.world.mover import goes_on
from airhilt.world.site import ScenarioSite

SPLITS = ("train",) * 8 + ("val", "test")
"""Splits of every ten worlds, in an order by chance."""
RATE_HZ = 10.0
LAST_INSTANT_NS = 100 * 10**9


@dataclass(frozen=True)
class Picture:
    """A frame, and under what conditions it was taken.

    Attributes
    ----------
    actors
        Actors of the numbers in ``frame.instance``, from 1.
    carrier
        The actor that carries the camera; None if it stands.
    world
        Number of the world: pictures of one world share its weather and its light.
    sequence
        Number of the sequence of pictures of one camera, from 1.
    step
        Place in the sequence, from 1.
    about
        What the annotations tell of the picture besides, such as the weather.
    """

    frame: Frame
    actors: tuple[str, ...]
    carrier: str | None
    world: int
    sequence: int
    step: int
    split: str
    about: Mapping[str, Any]


@dataclass(frozen=True)
class Takes:
    """Settings of the pictures of random worlds.

    Attributes
    ----------
    of_world
        Pictures of a world, about.
    sequence
        Pictures that a camera takes one after the other, while all moves.
    empty
        Part of the sequences that have nobody in them.
    """

    of_world: int = PICTURES_PER_WORLD
    sequence: int = 1
    rate_hz: float = RATE_HZ
    empty: float = 0.35

    @property
    def sequences(self) -> int:
        """Sequences of a world."""
        return max(self.of_world // self.sequence, 1)


def random_pictures(
    count: int,
    seed: int = 0,
    airports: Sequence[str] = (),
    renderer: str = AUTO,
    size: tuple[int, int] = (640, 360),
    takes: Takes = Takes(),
    first: int = 0,
) -> Iterator[Picture]:
    """Return pictures of random worlds, to be taken one by one.

    Parameters
    ----------
    airports
        ICAO location indicators, or `scenes.EN_ROUTE`; none: all that there are, which take turns.
    first
        Number of pictures at the beginning that are left out; the others do not change.

    Raises
    ------
    AirhiltError
        There is no such airport, or pictures cannot be drawn.
    """
    places = [place if place == EN_ROUTE else place.upper() for place in airports]
    known = [name.upper() for name in library.names("airports")]
    casting = Casting(places or [*known, EN_ROUTE], size)
    return _shots(casting, count, seed, renderer, takes, first)


def _shots(
    casting: Casting, count: int, seed: int, renderer: str, takes: Takes, first: int
) -> Iterator[Picture]:
    each = takes.sequences * takes.sequence
    for number in range(first // each, -(-count // each)):
        pictures = _world(casting, number, seed, renderer, takes)
        for index, picture in enumerate(pictures, start=number * each):
            if index >= count:
                break
            if index >= first:
                yield picture


def _world(
    casting: Casting, number: int, seed: int, renderer: str, takes: Takes
) -> Iterator[Picture]:
    sitting = casting.sitting(number, seed, "dataset")
    airport = None if sitting.layout is None else sitting.layout.airport.icao
    split = split_of(number, seed)
    with closing(scene_renderer_of(sitting, renderer)) as scene_renderer:
        for turn in range(takes.sequences):
            name = sitting.order[turn % len(sitting.order)]
            draws = stream(seed, f"dataset/shot/{sitting.place}", number, turn)
            bodies = cast(sitting, name, draws, takes.empty)
            begin_ns = int(draws.integers(LAST_INSTANT_NS))
            for step in range(takes.sequence):
                t_s = step / takes.rate_hz
                now = [gone_on(body, t_s) for body in bodies]
                yield Picture(
                    scene_renderer.shoot([name], now, begin_ns + seconds_to_ns(t_s))[0],
                    scene_renderer.actors,
                    sitting.cameras[name].carrier,
                    number,
                    number * takes.sequences + turn + 1,
                    step + 1,
                    split,
                    _about(airport, station_of(name), sitting.light, sitting.weather,
                           sitting.daylight, sitting.cameras[name].imaging),
                )  # fmt: skip


def split_of(world: int, seed: int) -> str:
    """Return the split of a random world."""
    tens, place = divmod(world, len(SPLITS))
    return SPLITS[stream(seed, "dataset/split", tens).permutation(len(SPLITS))[place]]


def _about(
    airport: str | None,
    station: str,
    light: Illumination,
    weather: Weather,
    daylight: Daylight,
    imaging: Imaging,
) -> dict[str, Any]:
    return {
        "airport": airport,
        "camera_kind": station,
        "visibility_m": round(light.visibility_m, 1),
        "rain_mm_h": round(weather.rain_mm_h, 2),
        "cloud_cover": round(weather.cloud_cover, 3),
        "texture": round(light.texture, 3),
        "imaging": imaging.model_dump(exclude_none=True),
        "solar_time_h": round(daylight.solar_time_h, 3),
        "sun_elevation_deg": round(light.sun_elevation_rad / DEGREE, 2),
    }


def scene_renderer_of(sitting: Sitting, renderer: str) -> SceneRenderer:
    """Return the renderer of a sitting; the caller closes it."""
    return SceneRenderer(
        sitting.landscape,
        sitting.light,
        sitting.models,
        sitting.cameras.values(),
        renderer,
        sitting.weather.rain_mm_h,
    )


def scenario_pictures(
    scenario: Scenario,
    count: int,
    seed: int = 0,
    renderer: str = AUTO,
    size: tuple[int, int] | None = None,
    first: int = 0,
) -> Iterator[Picture]:
    """Return pictures of a scenario's own cameras while its actors move, to be taken one by one.

    All cameras look at the same instants, which are spread over the whole scenario; nothing is
    said in it. It is one world, for training, and each camera takes one sequence.

    Raises
    ------
    AirhiltError
        It has no camera, or pictures cannot be drawn.
    """
    realised, _ = draw(scenario, seed)
    if not realised.cameras:
        raise CameraError(
            f"scenario {scenario.name!r} declares no cameras; expected one at least: add it "
            "under 'cameras', or leave --scenario out for random scenes"
        )
    if size is not None:
        width, height = size
        cameras = [
            camera.model_copy(update={"width_px": width, "height_px": height})
            for camera in realised.cameras
        ]
        realised = realised.model_copy(update={"cameras": tuple(cameras)})
    return islice(_moving(realised, count, seed, renderer), first, None)


def _moving(realised: Scenario, count: int, seed: int, renderer: str) -> Iterator[Picture]:
    site = ScenarioSite.of(realised)
    light, local_frame = light_of(realised, site), local_frame_of(site)
    airport = None if site.layout is None else site.layout.airport.icao
    actors = list(build_actors(realised, site, seed, TICK_S).values())
    cameras = {camera.name: camera for camera in realised.cameras}
    names = list(cameras)
    instants = -(-count // len(names))
    ticks = round(realised.duration_s / TICK_S)
    with closing(open_scene_renderer(realised, site, None, renderer)) as scene_renderer:
        tick = 0
        for index in range(instants):
            due = ticks * index // instants
            for _ in range(due - tick):
                for actor in actors:
                    if goes_on(actor.body):
                        actor.body.advance()
            tick = due
            t_ns = seconds_to_ns(tick * TICK_S)
            bodies = states_of(actors, local_frame, site.ground_m, t_ns, t_ns)
            wanted = names[: count - index * len(names)]
            for taken in scene_renderer.shoot(wanted, bodies, t_ns):
                camera = cameras[taken.camera]
                station = "fixed" if camera.mount.type == "fixed" else camera.mount.station
                about = _about(
                    airport,
                    station,
                    light,
                    realised.weather,
                    realised.daylight,
                    camera.imaging,
                )
                yield Picture(
                    taken, scene_renderer.actors, camera.carrier, 0,
                    1 + names.index(taken.camera), 1 + index, SPLITS[0], about,
                )  # fmt: skip
