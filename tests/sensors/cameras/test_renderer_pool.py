"""Several processes that draw for one run."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import closing

import pytest

from airhilt import load
from airhilt.errors import RendererError
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.mounts import cameras_named
from airhilt.sensors.cameras.renderer_process import (
    MOST_PROCESSES,
    RendererProcess,
    processes_for,
    shared_out,
    start_renderer,
)
from opening_bodies import bodies_of

SIZE = {"width_px": 160, "height_px": 90}


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    document = load("s01a_intersecting").model_dump(mode="json")
    document["cameras"] = [camera | SIZE for camera in document["cameras"]]
    return Scenario.model_validate(document)


@pytest.fixture(scope="module")
def names(scenario: Scenario) -> list[str]:
    return [camera.name for camera in scenario.cameras]


@pytest.fixture
def pool(scenario: Scenario) -> Iterator[RendererProcess]:
    with closing(start_renderer()) as one, closing(start_renderer()) as other:
        yield RendererProcess(scenario, renderer="embree", processes=[one, other])


def test_each_camera_has_one_process_and_moving_ones_are_shared_out_evenly(
    scenario: Scenario, names: list[str]
) -> None:
    moving = {camera.name for camera in scenario.cameras if camera.carrier is not None}
    shares = shared_out(cameras_named(scenario, names).values(), 2)
    assert sorted(name for share in shares for name in share) == sorted(names)
    counts = [len(moving.intersection(share)) for share in shares]
    assert max(counts) - min(counts) <= 1


def test_half_of_the_cores_draw_and_not_more_than_cameras_move(
    scenario: Scenario, monkeypatch: pytest.MonkeyPatch
) -> None:
    moving = sum(camera.carrier is not None for camera in scenario.cameras)
    for cores in (1, 2, 4, 64):
        monkeypatch.setattr(os, "sched_getaffinity", lambda _, cores=cores: range(cores))
        assert processes_for(scenario) == max(min(cores // 2, moving, MOST_PROCESSES), 1)
    fixed = [camera for camera in scenario.cameras if camera.carrier is None]
    assert processes_for(scenario.model_copy(update={"cameras": fixed})) == 1


@pytest.mark.slow
def test_two_processes_take_the_same_pictures_as_one(
    scenario: Scenario, names: list[str], pool: RendererProcess
) -> None:
    bodies = bodies_of(scenario)
    with RendererProcess(scenario, renderer="embree") as alone:
        assert pool.renderer == alone.renderer
        assert set(pool.own_aircraft) == set(alone.own_aircraft)
        assert pool.prospects(names, bodies, 0).keys() == set(names)
        for wanted in (names, names[::-1], names[1:2], []):
            taken, expected = pool.take(wanted, bodies, 7), alone.take(wanted, bodies, 7)
            assert [picture.camera for picture in taken] == wanted
            for picture, other in zip(taken, expected, strict=True):
                assert picture.pixels == other.pixels
                assert picture.sightings == other.sightings


def test_if_one_process_dies_no_more_pictures_are_drawn(
    scenario: Scenario, names: list[str], pool: RendererProcess
) -> None:
    pool.processes[1].kill()
    with pytest.raises(RendererError, match=r"has ended \(signal 9\)"):
        pool.take(names, bodies_of(scenario), 0)
