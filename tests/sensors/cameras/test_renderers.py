"""All renderers draw the same picture of one scene, and tell the same truth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest

from airhilt import load
from airhilt.errors import CameraError
from airhilt.geodesy.positions import RunwayPosition
from airhilt.imaging.view import Intrinsics, Pose
from airhilt.sensors.cameras.frame import Frame
from airhilt.sensors.cameras.mounts import Camera, Mount, cameras_of, local_frame_of
from airhilt.sensors.cameras.scene.bodies import (
    BodyState,
    aircraft_model,
    kind_model,
)
from airhilt.sensors.cameras.scene.builder import landscape_of, light_of
from airhilt.sensors.cameras.scene_renderer import SceneRenderer
from airhilt.units import DEGREE
from airhilt.world.site import ScenarioSite

PACKAGES = {"embree": "embreex", "open3d": "open3d", "moderngl": "moderngl"}
INSTALLED = [name for name, package in PACKAGES.items() if find_spec(package)]
RENDERERS = [
    pytest.param(name, marks=pytest.mark.skipif(name not in INSTALLED, reason="is not installed"))
    for name in PACKAGES
]
MODELS = {
    "737": aircraft_model("737"),
    "c310": aircraft_model("c310"),
    "fire_truck": kind_model("fire_truck"),
    "deer": kind_model("deer"),
}


class Airfield:
    """Washington in detail, under clouds, with four bodies on and about runway 01."""

    def __init__(self) -> None:
        self.scenario = load("s01b_nominal")
        self.site = ScenarioSite.of(self.scenario)
        light = light_of(self.scenario, self.site)
        self.light = replace(light, texture=1.0, clouds=0.4)
        self.landscape = landscape_of(self.scenario, self.site, self.light)
        known = cameras_of(self.scenario, self.site)
        lens = Intrinsics(640, 360, 40.0 * DEGREE)
        nose = Mount("c310", Pose.of((0.0, 4.5, 0.5), 0.0, -0.04), sees_own_aircraft=False)
        tail = Mount("c310", Pose.of((0.0, -3.7, 2.6), 0.0, -0.12), sees_own_aircraft=True)
        self.cameras = [
            known["runway_01"],
            Camera("nose", lens, nose),
            Camera("tail", lens, tail),
        ]
        self.bodies = [
            self.on_runway("737", 900.0, 20.0, turned=1.2),
            self.on_runway("fire_truck", 500.0, 20.0, turned=0.7),
            self.on_runway("deer", 250.0, -5.0, turned=1.0),
            self.on_runway("c310", -150.0, 0.0, up_m=35.0, roll=0.05),
        ]

    def on_runway(
        self,
        name: str,
        along_m: float,
        offset_m: float,
        turned: float = 0.0,
        up_m: float = 0.0,
        roll: float = 0.0,
    ) -> BodyState:
        assert self.site.layout is not None
        position = RunwayPosition(type="runway", runway="01", along_m=along_m, offset_m=offset_m)
        east, north = local_frame_of(self.site).to_local(self.site.place(position))
        kind = MODELS[name].aircraft
        wheels = 0.0 if kind is None else kind.dimensions.wheel_height_offset_m
        heading = self.site.layout.runway("01").course_rad + turned
        *_, shape = MODELS[name].shapes
        return BodyState(name, east, north, up_m + wheels, heading, 0.0, roll, shape, True)

    def scene_renderer(self, renderer: str) -> SceneRenderer:
        return SceneRenderer(self.landscape, self.light, MODELS, self.cameras, renderer)


@pytest.fixture(scope="module")
def airfield() -> Airfield:
    return Airfield()


@pytest.fixture(scope="module")
def drawing(airfield: Airfield) -> Iterator[dict[str, SceneRenderer]]:
    opened = {name: airfield.scene_renderer(name) for name in INSTALLED}
    yield opened
    for scene_renderer in opened.values():
        scene_renderer.close()


@pytest.fixture(scope="module")
def frames(airfield: Airfield, drawing: dict[str, SceneRenderer]) -> list[Frame]:
    """Pictures of all cameras, drawn by Embree."""
    names = [camera.name for camera in airfield.cameras]
    return drawing["embree"].shoot(names, airfield.bodies, 0)


@pytest.fixture(scope="module")
def pairs(
    airfield: Airfield, drawing: dict[str, SceneRenderer], frames: list[Frame]
) -> list[tuple[Frame, Frame]]:
    if "moderngl" not in drawing:
        pytest.skip("moderngl is not installed")
    names = [camera.name for camera in airfield.cameras]
    return list(zip(frames, drawing["moderngl"].shoot(names, airfield.bodies, 0), strict=True))


def test_boxes_and_visible_parts_agree(pairs: list[tuple[Frame, Frame]]) -> None:
    for first, second in pairs:
        for one, other in zip(first.sightings, second.sightings, strict=True):
            assert one.actor == other.actor
            assert np.abs(np.subtract(one.box, other.box)).max() < 1.5
            assert one.pixels == pytest.approx(other.pixels, rel=0.05, abs=1.0)


def test_colours_and_distances_agree(pairs: list[tuple[Frame, Frame]]) -> None:
    for first, second in pairs:
        difference = np.abs(first.colour.astype(int) - second.colour)
        assert difference.mean() < 0.3
        assert (difference.max(axis=2) > 24).mean() < 0.005
        bodies = (first.instance == second.instance) & (first.instance > 0)
        assert not bodies.any() or difference[bodies].mean() < 1.0
        sky = np.isinf(first.distance_m)
        assert (sky != np.isinf(second.distance_m)).mean() < 0.001
        both = ~sky & ~np.isinf(second.distance_m)
        ratio = first.distance_m[both] / second.distance_m[both]
        assert (np.abs(ratio - 1.0) > 0.02).mean() < 0.005


def test_the_pixels_of_a_body_lie_in_its_box_and_at_its_distance(
    drawing: dict[str, SceneRenderer], frames: list[Frame]
) -> None:
    actors, compared = drawing["embree"].actors, 0
    for frame in frames:
        for sighting in frame.sightings:
            body = frame.instance == actors.index(sighting.actor) + 1
            rows, columns = np.nonzero(body)
            if len(rows):
                assert sighting.box.left - 1.0 <= columns.min()
                assert columns.max() <= sighting.box.right + 1.0
                assert sighting.box.top - 1.0 <= rows.min()
                assert rows.max() <= sighting.box.bottom + 1.0
                reach_m = 8.0 if sighting.actor == "fire_truck" else 30.0
                assert np.abs(frame.distance_m[body] - sighting.range_m).max() < reach_m
                compared += 1
    assert compared >= 4


@pytest.mark.parametrize("renderer", RENDERERS)
def test_a_body_darkens_the_ground_below_it(
    airfield: Airfield, drawing: dict[str, SceneRenderer], renderer: str
) -> None:
    low = airfield.on_runway("737", 250.0, 0.0, turned=1.2, up_m=15.0)
    shots = [drawing[renderer].shoot(["runway_01"], there, 0)[0] for there in ([], [low])]
    darker = (shots[0].colour.astype(int) - shots[1].colour).min(axis=2)
    body = np.pad(shots[1].instance > 0, 2)
    beside = np.lib.stride_tricks.sliding_window_view(body, (5, 5)).any(axis=(2, 3))
    assert (darker[~beside] > 8).sum() > 100


@pytest.mark.parametrize("renderer", RENDERERS)
def test_the_own_aircraft_is_lit_anew_when_it_turns(
    airfield: Airfield, drawing: dict[str, SceneRenderer], renderer: str
) -> None:
    carrier = airfield.bodies[3]
    turned = carrier._replace(heading_rad=carrier.heading_rad + 2.0)
    shots = [drawing[renderer].shoot(["tail"], [body], 0)[0] for body in (carrier, turned)]
    own = (shots[0].instance > 0) & (shots[1].instance > 0)
    change = np.abs(shots[0].colour[own].astype(int) - shots[1].colour[own])
    assert change.mean() > 3.0


def test_more_actors_than_pictures_tell_apart_are_refused(airfield: Airfield) -> None:
    crowd = {f"deer{number}": MODELS["deer"] for number in range(256)}
    with pytest.raises(CameraError, match=r"256 actors, .* at most 255 apart; .*--no-cameras"):
        SceneRenderer(airfield.landscape, airfield.light, crowd, [], "embree")


def test_a_tail_camera_sees_its_own_aircraft_and_does_not_report_it(
    drawing: dict[str, SceneRenderer], frames: list[Frame]
) -> None:
    _, nose, tail = frames
    own = drawing["embree"].actors.index("c310") + 1
    assert (tail.instance == own).mean() > 0.02
    assert not (nose.instance == own).any()
    assert all(s.actor != "c310" for s in (*tail.sightings, *nose.sightings))


@pytest.mark.parametrize("renderer", RENDERERS)
def test_the_mask_of_the_own_aircraft_covers_it_and_little_more(
    airfield: Airfield, drawing: dict[str, SceneRenderer], renderer: str
) -> None:
    scene_renderer = drawing[renderer]
    own = scene_renderer.actors.index("c310") + 1
    mask = scene_renderer.own_aircraft("tail")
    for shape in MODELS["c310"].shapes:
        bodies = [*airfield.bodies[:3], airfield.bodies[3]._replace(shape=shape)]
        seen = scene_renderer.shoot(["tail"], bodies, 0)[0].instance == own
        assert mask[seen].all()
        assert seen.sum() > 0.7 * mask.sum()
    assert not scene_renderer.own_aircraft("nose").any()
    assert not scene_renderer.own_aircraft("runway_01").any()


@pytest.mark.parametrize("renderer", RENDERERS)
def test_a_picture_in_which_nothing_has_changed_is_the_last_one(
    airfield: Airfield, drawing: dict[str, SceneRenderer], renderer: str
) -> None:
    scene_renderer = drawing[renderer]
    bodies = [airfield.bodies[3]]
    shots = [
        scene_renderer.shoot(["nose", "tail"], there, 0)
        for there in ([*airfield.bodies], bodies, bodies)
    ]
    emptied, again = shots[1:]
    for first, second in zip(emptied, again, strict=True):
        assert second.unchanged
        assert second.colour is first.colour
    moved = [bodies[0]._replace(heading_rad=bodies[0].heading_rad + 0.01)]
    for before, turned in zip(again, scene_renderer.shoot(["nose", "tail"], moved, 0), strict=True):
        assert not turned.unchanged
        assert (turned.colour != before.colour).any()
    filled = scene_renderer.shoot(["nose"], airfield.bodies, 0)[0]
    assert not filled.unchanged
    assert filled.sightings


@pytest.mark.parametrize("renderer", RENDERERS)
def test_what_is_too_far_to_leave_a_trace_is_told_with_no_pixels(
    airfield: Airfield, drawing: dict[str, SceneRenderer], renderer: str
) -> None:
    camera = airfield.cameras[0]
    assert isinstance(camera.at, Pose)
    ahead = camera.at.rotation[:, 1]
    far = np.asarray(camera.at.position_m) + 60_000.0 * ahead
    bird = airfield.bodies[2]._replace(
        east_m=float(far[0]), north_m=float(far[1]), up_m=float(far[2])
    )
    empty = drawing[renderer].shoot(["runway_01"], [], 0)[0]
    frame = drawing[renderer].shoot(["runway_01"], [bird], 0)[0]
    assert np.array_equal(frame.colour, empty.colour)
    (sighting,) = frame.sightings
    assert sighting.pixels == 0.0
    assert sighting.visible_fraction == 0.0
    assert sighting.range_m == pytest.approx(60_000.0, rel=0.01)
    assert sighting.box.area > 0.0


@pytest.mark.parametrize("renderer", RENDERERS)
def test_what_stands_before_a_body_takes_from_what_is_seen_of_it(
    airfield: Airfield, drawing: dict[str, SceneRenderer], renderer: str
) -> None:
    truck, camera = airfield.bodies[1], airfield.cameras[0]
    assert isinstance(camera.at, Pose)
    eye = np.asarray(camera.at.position_m)
    there = np.asarray((truck.east_m, truck.north_m, truck.up_m))
    nearer = eye + 0.8 * (there - eye)
    hiding = airfield.bodies[0]._replace(
        east_m=float(nearer[0]), north_m=float(nearer[1]), up_m=2.0, shape="gear"
    )
    frame = drawing[renderer].shoot(["runway_01"], [truck, hiding], 0)[0]
    seen = {sighting.actor: sighting for sighting in frame.sightings}
    assert seen["fire_truck"].visible_fraction < 0.6
    assert seen["737"].visible_fraction == pytest.approx(1.0, abs=0.02)
