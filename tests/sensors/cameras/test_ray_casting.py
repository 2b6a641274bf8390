"""Embree and Open3D cast the same rays: what is drawn does not depend on which of them it was."""

from __future__ import annotations

import json
from typing import Any, NamedTuple

import numpy as np
import pytest

from airhilt import load
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.body_states import states_of
from airhilt.sensors.cameras.frame import Frame
from airhilt.sensors.cameras.mounts import local_frame_of
from airhilt.sensors.cameras.raycasting import MISS
from airhilt.sensors.cameras.renderers import FAMILY
from airhilt.sensors.cameras.scene.builder import open_scene_renderer
from airhilt.shapes.mesh import box
from airhilt.units import SECOND_NS
from airhilt.world.actors import build_actors
from airhilt.world.site import ScenarioSite

TICK_S = 0.05
NIGHT = {"date": "2026-05-01", "solar_time_h": 23.0}
TEXTURE = {"appearance": {"texture": 1.0}, "weather": {"cloud_cover": 0.5}}


class Scene(NamedTuple):
    """A scenario at an instant, and the cameras that look at it."""

    name: str
    cameras: tuple[str, ...]
    at_s: float
    changes: dict[str, Any] = {}  # noqa: RUF012

    def scenario(self) -> Scenario:
        """Return the scenario with the changes."""
        document = json.loads(load(self.name).model_dump_json())
        for field, value in self.changes.items():
            document[field] = (document[field] or {}) | value
        return Scenario.model_validate(document)

    def frames(self, renderer: str) -> list[Frame]:
        """Return what the cameras see."""
        scenario = self.scenario()
        site = ScenarioSite.of(scenario)
        actors = build_actors(scenario, site, 0, TICK_S).values()
        for _ in range(round(self.at_s / TICK_S)):
            for actor in actors:
                if actor.body.ended is None:
                    actor.body.advance()
        now_ns = round(self.at_s * SECOND_NS)
        bodies = states_of(actors, local_frame_of(site), site.ground_m, now_ns, now_ns)
        opened = open_scene_renderer(scenario, site, self.cameras, renderer)
        try:
            return opened.shoot(self.cameras, bodies, now_ns)
        finally:
            opened.close()


SCENES = {
    "airport": Scene("s01b_nominal", ("runway_01", "delta_tower"), 60.0),
    "en_route": Scene("s02a_headon", ("nose-AAL123", "nose-DAL456"), 60.0),
    "night": Scene("s01b_nominal", ("runway_01",), 60.0, {"daylight": NIGHT}),
    "rain": Scene("s02a_headon", ("nose-AAL123",), 60.0, {"weather": {"rain_mm_h": 20.0}}),
    "texture": Scene("s01b_nominal", ("runway_01", "delta_tower"), 60.0, TEXTURE),
}


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_embree_and_open3d_give_the_same_picture(scene: Scene) -> None:
    pytest.importorskip("open3d")
    for first, second in zip(scene.frames("embree"), scene.frames("open3d"), strict=True):
        same = first.instance == second.instance
        same &= np.isclose(first.distance_m, second.distance_m, rtol=1e-4, atol=0.0)
        apart = np.abs(first.colour.astype(int) - second.colour).max(axis=2)
        same &= apart <= 1
        assert same.mean() >= 0.999
        assert [one.actor for one in first.sightings] == [two.actor for two in second.sightings]
        for one, two in zip(first.sightings, second.sightings, strict=True):
            assert one.box == two.box
            assert one.pixels == pytest.approx(two.pixels, rel=1e-3, abs=0.1)


@pytest.mark.parametrize("name", ["embree", "open3d"])
def test_rays_meet_the_nearest_triangle(name: str) -> None:
    pytest.importorskip({"embree": "embreex"}.get(name, name))
    block = box((0.5, 0.5, 0.5), 2.0, 2.0, 2.0)
    scene = FAMILY.load(name).scene_builder()(block.corners)
    away = np.array(((0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (0.1, 1.0, 0.1)), dtype=np.float32).T
    eye = np.array((0.0, -11.0, 1.0))
    hits = scene.hits(eye, away)
    assert hits.distance_m == pytest.approx([10.0, np.inf, 10.0])
    assert hits.triangles[1] == MISS
    assert np.array_equal(scene.triangles(eye, away), hits.triangles)
    for ray in (0, 2):
        weights = np.array((1.0 - hits.u[ray] - hits.v[ray], hits.u[ray], hits.v[ray]))
        met = weights @ block.corners[hits.triangles[ray]]
        assert met == pytest.approx(eye + hits.distance_m[ray] * away[:, ray], abs=1e-4)
    sun = np.array((0.0, 0.0, 1.0), dtype=np.float32)
    below = np.array(((0.0, 0.0, -3.0), (5.0, 0.0, -3.0)))
    assert scene.blocked(below, sun).tolist() == [True, False]
