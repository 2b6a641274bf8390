"""Pictures with the truth about them, as COCO, to train and to judge detectors.

The format is that of T.-Y. Lin et al., Microsoft COCO, ECCV 2014: a folder of pictures and one
``annotations.json``. What COCO has no word for stands beside it under names of AIRHILT's own.
"""

from __future__ import annotations

import io
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from airhilt._version import __version__
from airhilt.errors import CameraError
from airhilt.host import library
from airhilt.host.files import replace_file
from airhilt.imaging.masks import Mask, runs_of
from airhilt.messages import VisibleClass
from airhilt.scenario import Scenario
from airhilt.scenario.models import Daylight, Weather
from airhilt.sensors.cameras import AUTO
from airhilt.sensors.cameras.body_states import states_of
from airhilt.sensors.cameras.dataset.placement import cast
from airhilt.sensors.cameras.dataset.scenes import EN_ROUTE, Casting, Sitting, station_of
from airhilt.sensors.cameras.frame import Frame, Sighting
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

FIRST_CLASSES: tuple[VisibleClass, ...] = ("airplane", "truck", "bird", "deer", "coyote")
"""Classes whose categories have the ids from 1, so that data sets of AIRHILT's own kinds agree.

Classes of other kinds follow in the order of their names."""
QUALITY = 95
"""Quality of the JPEGs; colours are not subsampled."""
FAINTEST_PX = 0.5
"""Least area, in pixels, of a body that is annotated."""
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
    about
        What ``annotations.json`` tells of the picture besides, such as the weather.
    """

    frame: Frame
    actors: tuple[str, ...]
    carrier: str | None
    about: Mapping[str, Any]


def random_pictures(
    count: int,
    seed: int = 0,
    airports: Sequence[str] = (),
    renderer: str = AUTO,
    size: tuple[int, int] = (640, 360),
    empty: float = 0.35,
) -> Iterator[Picture]:
    """Return pictures of random scenes, to be taken one by one.

    Parameters
    ----------
    airports
        ICAO location indicators, or `dataset_scenes.EN_ROUTE`; none: all that there are.
    empty
        Part of the pictures that have nobody in them.

    Raises
    ------
    AirhiltError
        There is no such airport, or pictures cannot be drawn.
    """
    places = [place if place == EN_ROUTE else place.upper() for place in airports]
    known = [name.upper() for name in library.names("airports")]
    casting = Casting(places or [*known, EN_ROUTE], size)
    return _shots(casting, count, seed, renderer, empty)


def _shots(
    casting: Casting, count: int, seed: int, renderer: str, empty: float
) -> Iterator[Picture]:
    taken = number = 0
    while taken < count:
        sitting = casting.sitting(number, stream(seed, f"dataset/{place}", number))
        airport = None if sitting.layout is None else sitting.layout.airport.icao
        with closing(scene_renderer_of(sitting, renderer)) as scene_renderer:
            for turn, name in enumerate(sitting.order[: count - taken]):
                draws = stream(seed, "dataset/shot", number, turn)
                bodies = cast(sitting, name, draws, empty)
                t_ns = int(draws.integers(LAST_INSTANT_NS))
                yield Picture(
                    scene_renderer.shoot([name], bodies, t_ns)[0],
                    scene_renderer.actors,
                    sitting.cameras[name].carrier,
                    _about(airport, station_of(name), sitting.light, sitting.weather,
                           sitting.daylight),
                )  # fmt: skip
        taken += len(sitting.order)
        number += 1


def _about(
    airport: str | None, station: str, light: Illumination, weather: Weather, daylight: Daylight
) -> dict[str, Any]:
    return {
        "airport": airport,
        "camera_kind": station,
        "visibility_m": round(light.visibility_m, 1),
        "rain_mm_h": round(weather.rain_mm_h, 2),
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
) -> Iterator[Picture]:
    """Return pictures of a scenario's own cameras while its actors move, to be taken one by one.

    All cameras look at the same instants, which are spread over the whole scenario; nothing is
    said in it.

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
    return _moving(realised, count, seed, renderer)


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
                about = _about(airport, station, light, realised.weather, realised.daylight)
                yield Picture(taken, scene_renderer.actors, camera.carrier, about)


def export(pictures: Iterable[Picture], folder: Path, about: Mapping[str, Any]) -> dict[str, int]:
    """Write pictures and the truth about them, and return how many bodies of each class there are.

    If the export stops early, the annotations of the pictures written so far are complete. Nothing
    is written before the first picture.

    Raises
    ------
    AirhiltError
        The folder is not empty or cannot be written, or pictures cannot be drawn.
    """
    images: list[dict[str, Any]] = []
    annotations: list[dict[str, Any]] = []
    labels: list[VisibleClass] = []
    try:
        if folder.exists() and any(folder.iterdir()):
            raise CameraError(f"{folder} is not empty; expected a new folder: choose another --out")
        try:
            for number, picture in enumerate(pictures, start=1):
                name = f"images/{number:06}.jpg"
                _write_jpeg(folder / name, picture)
                images.append(_image(number, name, picture))
                for sighting in picture.frame.sightings:
                    if sighting.pixels >= FAINTEST_PX:
                        labels.append(sighting.label)
                        annotations.append(_annotation(len(labels), number, picture, sighting))
        finally:
            if images:
                classes = _classes(labels)
                for annotation, label in zip(annotations, labels, strict=True):
                    annotation["category_id"] = classes.index(label) + 1
                document = {
                    "info": {"description": "AIRHILT", "version": __version__, **about},
                    "images": images,
                    "annotations": annotations,
                    "categories": [
                        {"id": number, "name": name} for number, name in enumerate(classes, start=1)
                    ],
                }
                data = json.dumps(document, separators=(",", ":")).encode()
                replace_file(folder / "annotations.json", data)
    except OSError as error:
        raise CameraError(
            f"{folder}: cannot be written: {error.strerror}; make room, or choose another --out"
        ) from None
    return {name: labels.count(name) for name in _classes(labels)}


def _write_jpeg(path: Path, picture: Picture) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    buffer = io.BytesIO()
    image = Image.fromarray(picture.frame.colour)
    image.save(buffer, format="JPEG", quality=QUALITY, subsampling=0)
    replace_file(path, buffer.getvalue())


def _classes(found: Iterable[VisibleClass]) -> tuple[VisibleClass, ...]:
    """Return the classes of a data set; a category's id is its place here, from 1."""
    return (*FIRST_CLASSES, *sorted(set(found) - set(FIRST_CLASSES)))


def _image(number: int, name: str, picture: Picture) -> dict[str, Any]:
    lens = picture.frame.view.intrinsics
    own = {}
    if picture.carrier is not None:
        number_of_own = picture.actors.index(picture.carrier) + 1
        own = {"own_aircraft": run_lengths(picture.frame.instance == number_of_own)}
    return {
        "id": number,
        "file_name": name,
        "width": lens.width_px,
        "height": lens.height_px,
        "camera": picture.frame.camera,
        "horizontal_fov_deg": round(lens.horizontal_fov_rad / DEGREE, 3),
        **picture.about,
        **own,
    }


def _annotation(identity: int, image: int, picture: Picture, sighting: Sighting) -> dict[str, Any]:
    left, top, right, bottom = sighting.box
    actor = picture.actors.index(sighting.actor) + 1
    return {
        "id": identity,
        "image_id": image,
        "bbox": [round(value, 2) for value in (left, top, right - left, bottom - top)],
        "area": round(sighting.pixels, 2),
        "segmentation": run_lengths(picture.frame.instance == actor),
        "iscrowd": 0,
        "actor": sighting.actor,
        "range_m": round(sighting.range_m, 1),
        "visible_fraction": round(sighting.visible_fraction, 3),
        "truncation": round(sighting.truncation, 3),
        "transmission": round(sighting.transmission, 4),
    }


def run_lengths(mask: Mask) -> dict[str, list[int]]:
    """Return a mask as COCO's uncompressed run lengths: column by column, the first one free."""
    counts = runs_of(np.ascontiguousarray(mask.T)) or (mask.size,)
    return {"size": list(mask.shape), "counts": list(counts)}
