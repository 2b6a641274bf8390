"""Several processes that draw for one run."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator
from contextlib import closing

import pytest

from airhilt import load
from airhilt.errors import RendererError
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.mounts import cameras_named
from airhilt.sensors.cameras.renderer_process import (
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


@pytest.mark.parametrize(
    ("cores", "moving", "processes"),
    [(1, 4, 1), (2, 0, 1), (2, 2, 1), (2, 4, 2), (4, 2, 2), (4, 4, 2), (8, 4, 4), (64, 40, 4)],
)
def test_a_process_is_worth_two_cameras_that_move_or_one_with_cores_to_spare(
    scenario: Scenario,
    monkeypatch: pytest.MonkeyPatch,
    cores: int,
    moving: int,
    processes: int,
) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: range(cores))
    fixed = [camera for camera in scenario.cameras if camera.carrier is None]
    carried = [camera for camera in scenario.cameras if camera.carrier is not None]
    cameras = [*fixed, *itertools.islice(itertools.cycle(carried), moving)]
    assert processes_for(scenario.model_copy(update={"cameras": cameras})) == processes


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
