"""Judge a detector on pictures of `airhilt dataset export`, and print its curves.

    airhilt dataset export --out data/test --images 2500 --seed 301 --airport LSZH ...
    airhilt dataset export --out data/empty --images 2000 --seed 302 --empty 1 --airport LSZH ...
    python tools/detector/eval_detector.py data/test data/empty
    python tools/detector/eval_detector.py data/test data/empty --engine yolo:yolov10n.pt --json
    python tools/detector/eval_detector.py --approaches

Only findings count that are sure by themselves. A body counts as found if a box of its class
overlaps its own by half (intersection over union); in the column `loose`, by three tenths. Bodies
under 12 pixels are found by an overlap of a quarter, or where the centres are no farther apart
than half their longest side. Bodies that can hardly be seen (see `detector_data.Body.counts`) are
neither missed nor false when found. Tables by range, visibility and time of day are of airplanes
of 8 pixels and more.

``--approaches`` draws a 737 that comes head-on, at 80 m/s, from 6 km to 300 m, in a visibility
of 10 km, before a camera of 25 degrees and 640 by 360 pixels, and prints from which range it is
found.
"""

from __future__ import annotations

import argparse
import datetime
import json
import math
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

from rich.progress import track

from airhilt.assistant.vision.detector import Detector, Found, Picture
from airhilt.assistant.vision.worker import beside
from airhilt.engine_families import DETECTORS
from airhilt.imaging.boxes import centre, overlap, share_of_smaller
from airhilt.imaging.matching import is_about
from detector_data import CLASSES, LEAST_CONTRAST, Body, Shot, read_folder

FRAMES_A_MINUTE = 960
SMALL_PX = 12.0
STRICT, SMALL = 0.5, 0.25
SIZES_PX = (5.0, 8.0, 12.0, 20.0, 40.0, 80.0, math.inf)
RANGES_M = (0.0, 100.0, 300.0, 700.0, 1500.0, 3000.0, 6000.0, math.inf)
VISIBILITIES_M = (0.0, 1500.0, 3000.0, 5000.0, 10_000.0, 20_000.0, math.inf)
SHOWN = (0.25, 0.5, 0.75, 0.95, math.inf)
SUN_DEG = {"day": (6.0, 90.0), "twilight": (-6.0, 6.0), "night": (-90.0, -6.0)}

CLOSING_M_S = 80.0
FARTHEST_M, NEAREST_M = 6000.0, 300.0
RATE_HZ = 4.0


@dataclass
class Tally:
    """Counts of bodies that were found and missed."""

    bodies: int = 0
    found: int = 0
    loose: int = 0

    def add(self, strict: bool, loose: bool) -> None:
        """Count a body."""
        self.bodies += 1
        self.found += strict
        self.loose += loose

    def as_dict(self) -> dict[str, Any]:
        """Return counts and shares."""
        shares = {
            name: round(count / self.bodies, 4) if self.bodies else None
            for name, count in (("recall", self.found), ("loose", self.loose))
        }
        return {"bodies": self.bodies, **shares}


@dataclass
class Judgement:
    """Results of a detector on some pictures."""

    tables: dict[str, dict[str, Tally]] = field(default_factory=dict)
    true: int = 0
    false: int = 0
    empty_pictures: int = 0
    empty_false: int = 0

    def count(self, table: str, row: str, strict: bool, loose: bool) -> None:
        """Count a body in a row of a table."""
        self.tables.setdefault(table, {}).setdefault(row, Tally()).add(strict, loose)

    def as_dict(self) -> dict[str, Any]:
        """Return everything, for JSON."""
        tables = {
            name: {row: tally.as_dict() for row, tally in table.items()}
            for name, table in self.tables.items()
        }
        found = self.true + self.false
        return {
            "precision": round(self.true / found, 4) if found else None,
            "empty_pictures": self.empty_pictures,
            "false_in_empty_pictures": self.empty_false,
            "false_per_960_empty_pictures": (
                round(FRAMES_A_MINUTE * self.empty_false / self.empty_pictures, 2)
                if self.empty_pictures
                else None
            ),
            **tables,
        }


def strictly(body: Body, found: Found) -> bool:
    """Return whether a box is that of a body, whatever its class, and lies well about it."""
    return hits(body, found, STRICT)


def loosely(body: Body, found: Found) -> bool:
    """Return whether a box is that of a body, whatever its class, as runs are judged."""
    return is_about(found.box, body.box)


def hits(body: Body, found: Found, least: float) -> bool:
    """Return whether boxes overlap as much, or are about the same where they are small."""
    if body.size_px < SMALL_PX:
        apart = math.dist(centre(body.box), centre(found.box))
        return apart <= 0.5 * body.size_px or overlap(body.box, found.box) >= SMALL
    return overlap(body.box, found.box) >= least


def matched(
    bodies: Sequence[Body], found: Sequence[Found], is_of: Callable[[Body, Found], bool]
) -> tuple[set[int], set[int]]:
    """Return which bodies are found, and by which boxes; the surest box chooses first."""
    seen: set[int] = set()
    used: set[int] = set()
    for index, each in enumerate(found):
        fitting = [
            number
            for number, body in enumerate(bodies)
            if number not in seen and CLASSES[body.label] == each.label and is_of(body, each)
        ]
        if fitting:
            best = max(fitting, key=lambda number: overlap(bodies[number].box, each.box))
            seen.add(best)
            used.add(index)
    return seen, used


def surely_found(engine: Detector, picture: Picture) -> list[Found]:
    """Return what of a picture counts by itself."""
    return [each for each in engine.detect(picture) if each.confidence >= engine.threshold]


def found_in(engine: Detector, shot: Shot, picture: Picture) -> list[Found]:
    """Return what of a shot counts by itself, seen as a picture, beside the own aircraft."""
    return beside(shot.own_aircraft(), surely_found(engine, picture))


def judge(engine: Detector, shots: Sequence[Shot]) -> Judgement:
    """Return what a detector finds in pictures, and what it does not.

    Parts of the aircraft that carries the camera are left out, as a vision worker does.
    """
    judgement = Judgement()
    for shot in track(shots, "pictures", transient=True, disable=not sys.stderr.isatty()):
        found = found_in(engine, shot, shot.picture())
        strict, used = matched(shot.bodies, found, strictly)
        loose, _ = matched(shot.bodies, found, loosely)
        judgement.true += sum(shot.bodies[number].counts for number in strict)
        for index, each in enumerate(found):
            if index not in used and not on_faint(shot.bodies, each):
                judgement.false += 1
                judgement.empty_false += not shot.bodies
        judgement.empty_pictures += not shot.bodies
        for number, body in enumerate(shot.bodies):
            _count(judgement, shot, body, number in strict, number in loose)
    return judgement


def on_faint(bodies: Sequence[Body], found: Found) -> bool:
    """Return whether a box lies on a body that can hardly be seen."""
    return any(
        not body.counts and (hits(body, found, 0.1) or share_of_smaller(body.box, found.box) > 0.5)
        for body in bodies
    )


def _count(judgement: Judgement, shot: Shot, body: Body, strict: bool, loose: bool) -> None:
    name = CLASSES[body.label]
    if not body.counts:
        if body.contrast < LEAST_CONTRAST:
            judgement.count("left_out", f"contrast below {LEAST_CONTRAST:g} levels", strict, loose)
        return
    size = _row(body.size_px, SIZES_PX, "px")
    judgement.count("class_from_8_px" if body.size_px >= 8.0 else "class_below_8_px",
                    name, strict, loose)  # fmt: skip
    judgement.count("airplane_by_size" if body.label == 0 else "others_by_size",
                    size, strict, loose)  # fmt: skip
    if body.label == 0 and body.size_px >= 8.0:
        judgement.count("airplane_by_range", _row(body.range_m, RANGES_M, "m"), strict, loose)
        visibility = _row(shot.about["visibility_m"], VISIBILITIES_M, "m")
        judgement.count("airplane_by_visibility", visibility, strict, loose)
        sun = shot.about["sun_elevation_deg"]
        hour = next(name for name, (low, high) in SUN_DEG.items() if low <= sun < high)
        judgement.count("airplane_by_time_of_day", hour, strict, loose)
        judgement.count("airplane_by_camera", shot.about["camera_kind"], strict, loose)
    if body.label == 0 and body.size_px >= 20.0:
        shown = _row(body.visible_fraction, SHOWN, "shown")
        judgement.count("airplane_over_20_px_by_part", shown, strict, loose)


def _row(value: float, edges: Sequence[float], unit: str) -> str:
    low, high = next(pair for pair in pairwise(edges) if value < pair[1])
    return f"over {low:g} {unit}" if math.isinf(high) else f"{low:g} to {high:g} {unit}"


# --- approaches ---------------------------------------------------------------------------


def approaches(engine: Detector, renderer: str) -> dict[str, dict[str, float | None]]:
    """Return for each camera the ranges from which an airliner that comes near is found."""
    return {
        name: _ranges(engine, frames)
        for name, frames in (
            ("ground camera, day", _before_ground_camera(renderer, 10.0)),
            ("ground camera, twilight", _before_ground_camera(renderer, 18.9)),
            ("nose camera, day", _before_nose_camera(renderer, 10.0)),
            ("nose camera, twilight", _before_nose_camera(renderer, 18.9)),
        )
    }


def _ranges(engine: Detector, frames: Iterator[Any]) -> dict[str, float | None]:
    away: list[float] = []
    seen: list[bool] = []
    pixels: list[float] = []
    for frame in frames:
        sighting = next((s for s in frame.sightings if s.actor == "737"), None)
        if sighting is None:
            continue
        body = Body(0, tuple(sighting.box), sighting.range_m, 1.0, 1.0, 255.0)
        found = [each for each in surely_found(engine, frame.colour) if each.label == "airplane"]
        away.append(sighting.range_m)
        pixels.append(body.size_px)
        seen.append(any(loosely(body, each) for each in found))
    often = [sum(seen[max(index - 4, 0) : index + 1]) >= 3 for index in range(len(seen))]
    first = next((index for index, found in enumerate(seen) if found), None)
    kept = next((index for index, found in enumerate(often) if found), None)
    gaps = [index for index, found in enumerate(often) if not found]
    always = gaps[-1] + 1 if gaps else 0
    held = always if always < len(seen) else None

    def at(values: list[float], index: int | None) -> float | None:
        return None if index is None else round(values[index], 1)

    return {
        "first_m": at(away, first),
        "first_px": at(pixels, first),
        "three_of_five_m": at(away, kept),
        "held_to_the_end_m": at(away, held),
        "held_px": at(pixels, held),
        "found": round(sum(seen) / len(seen), 3),
    }


def _steps() -> list[float]:
    count = round((FARTHEST_M - NEAREST_M) / CLOSING_M_S * RATE_HZ)
    return [FARTHEST_M - index * CLOSING_M_S / RATE_HZ for index in range(count + 1)]


def _shoot(
    renderer: str, world: Any, light: Any, camera: Any, bodies: Callable[[float], list[Any]]
) -> Iterator[Any]:

    from airhilt.sensors.cameras.scene.bodies import aircraft_model
    from airhilt.sensors.cameras.scene_renderer import SceneRenderer

    models = {"737": aircraft_model("737"), "own": aircraft_model("737")}
    scene_renderer = SceneRenderer(world, light, models, [camera], renderer)
    try:
        for index, away in enumerate(_steps()):
            yield scene_renderer.shoot([camera.name], bodies(away), round(index / RATE_HZ * 1e9))[0]
    finally:
        scene_renderer.close()


def _light(latitude_rad: float, solar_time_h: float, en_route: bool) -> Any:
    from airhilt.scenario.models import Daylight, Weather
    from airhilt.scenario.models.scene import Appearance
    from airhilt.sensors.cameras.scene.builder import air_and_sun

    day = Daylight(date=datetime.date(2026, 5, 1), solar_time_h=solar_time_h)
    weather, texture = Weather(visibility_m=10_000.0), Appearance().texture
    return air_and_sun(weather, day, texture, latitude_rad, en_route)


def _before_ground_camera(renderer: str, solar_time_h: float) -> Iterator[Any]:
    """Yield pictures of a camera beside the threshold of Zürich's runway 14."""
    from airhilt.imaging.view import Intrinsics, Pose
    from airhilt.sensors.cameras.mounts import Camera
    from airhilt.sensors.cameras.scene.bodies import BodyState
    from airhilt.sensors.cameras.scene.landscape import airport_landscape
    from airhilt.world.surface.airport import load_airport
    from airhilt.world.surface.layout import Layout

    layout = Layout(load_airport("LSZH"))
    light = _light(layout.local_frame.origin[0], solar_time_h, False)
    end = layout.runway("14")
    east, north = layout.local_frame.to_local(end.threshold)
    sin, cos = math.sin(end.course_rad), math.cos(end.course_rad)
    at = east + 45.0 * cos, north - 45.0 * sin, 6.0
    pose = Pose.of(at, end.course_rad + math.pi, math.radians(3.0))
    camera = Camera("ground", Intrinsics(640, 360, math.radians(25.0)), pose)

    def bodies(away: float) -> list[Any]:
        up = 18.0 + away * math.tan(end.glide_path_rad)
        place = east - away * sin, north - away * cos, up
        shape = "gear" if up < 600.0 else "clean"
        return [BodyState("737", *place, end.course_rad, 0.03, 0.0, shape, True)]

    yield from _shoot(renderer, airport_landscape(layout, light), light, camera, bodies)


def _before_nose_camera(renderer: str, solar_time_h: float) -> Iterator[Any]:
    """Yield pictures from the nose of an aircraft at 1000 m, above open country."""
    from airhilt.imaging.view import Intrinsics
    from airhilt.sensors.cameras.mounts import Camera, station_mount
    from airhilt.sensors.cameras.scene.bodies import BodyState
    from airhilt.sensors.cameras.scene.landscape import open_country
    from airhilt.world.flight.aircraft_type import load_aircraft_type

    light = _light(math.radians(47.0), solar_time_h, True)
    mount = station_mount("nose", "own", "nose", load_aircraft_type("737"))
    camera = Camera("nose", Intrinsics(640, 360, math.radians(25.0)), mount)

    def bodies(away: float) -> list[Any]:
        own = BodyState("own", 0.0, -0.5 * away, 1000.0, 0.0, 0.03, 0.0, "clean", True)
        other = BodyState("737", 40.0, 0.5 * away, 1030.0, math.pi, 0.03, 0.0, "clean", True)
        return [own, other]

    yield from _shoot(renderer, open_country(light, "held out", 600.0), light, camera, bodies)


# --- what is printed ----------------------------------------------------------------------


def table(title: str, rows: dict[str, dict[str, Any]]) -> str:
    """Return rows of numbers as lines."""
    columns = list(next(iter(rows.values())))
    width = max(len(title), *(len(name) for name in rows))
    lines = [f"{title:{width}}  " + "  ".join(f"{name:>10}" for name in columns)]
    for name in sorted(rows, key=_order):
        values = (rows[name][column] for column in columns)
        cells = ("-" if value is None else f"{value:g}" for value in values)
        lines.append(f"{name:{width}}  " + "  ".join(f"{cell:>10}" for cell in cells))
    return "\n".join(lines)


def _order(row: str) -> tuple[float, str]:
    numbers = [float(word) for word in row.split() if word.replace(".", "").isdigit()]
    return (numbers[0] if numbers else 0.0) + (0.5 if row.startswith("over") else 0.0), row


def main() -> None:
    """Judge, and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", type=Path, metavar="DATA")
    parser.add_argument("--engine", default="embedded", help="as for airhilt cosim --detector")
    parser.add_argument("--approaches", action="store_true", help="draw and judge approaches")
    parser.add_argument("--renderer", default="moderngl")
    parser.add_argument("--json", action="store_true", dest="as_json")
    given = parser.parse_args()
    if not given.folders and not given.approaches:
        parser.error("nothing to judge: give folders of airhilt dataset export, or --approaches")
    engine = DETECTORS.create(given.engine)
    result: dict[str, Any] = {"engine": engine.name}
    if given.folders:
        shots = [shot for folder in given.folders for shot in read_folder(folder)]
        result |= {"pictures": len(shots), **judge(engine, shots).as_dict()}
    if given.approaches:
        result["approaches"] = approaches(engine, given.renderer)
    if given.as_json:
        print(json.dumps(result, indent=2))
        return
    for name, value in result.items():
        if isinstance(value, dict):
            print("\n" + table(name.replace("_", " "), value))
        else:
            print(f"{name.replace('_', ' ')}: {value}")


if __name__ == "__main__":
    main()
