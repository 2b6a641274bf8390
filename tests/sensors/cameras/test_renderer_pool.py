"""Several processes that draw for one run."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import closing

import pytest

from airhilt import load
from airhilt.errors import RendererError
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.renderer_link import RendererLink
from airhilt.sensors.cameras.renderer_pool import (
    MOST_PROCESSES,
    RendererPool,
    processes_for,
    shared_out,
)
from airhilt.sensors.cameras.renderer_process import RendererProcess
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
def links() -> Iterator[list[RendererLink]]:
    with closing(RendererLink()) as one, closing(RendererLink()) as other:
        yield [one, other]


def test_each_camera_has_one_process_and_moving_ones_are_shared_out_evenly(
    scenario: Scenario, names: list[str]
) -> None:
    moving = {camera.name for camera in scenario.cameras if camera.carrier is not None}
    shares = shared_out(scenario, 2)
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
def test_a_pool_takes_the_same_pictures_as_one_process(
    scenario: Scenario, names: list[str], links: list[RendererLink]
) -> None:
    bodies, pool = bodies_of(scenario), RendererPool(scenario, links, "embree")
    with RendererProcess(scenario, renderer="embree") as alone:
        assert pool.renderer == alone.renderer
        assert set(pool.own_aircraft) == set(alone.own_aircraft)
        assert pool.prospects(names, bodies, 0).keys() == set(names)
        for wanted in (names, names[::-1], names[1:2], []):
            taken, expected = pool.shoot(wanted, bodies, 7), alone.shoot(wanted, bodies, 7)
            assert [frame.camera for frame in taken] == wanted
            for frame, other in zip(taken, expected, strict=True):
                assert (frame.colour == other.colour).all()
                assert (frame.instance == other.instance).all()
                assert frame.sightings == other.sightings


def test_if_one_process_dies_no_more_pictures_are_drawn(
    scenario: Scenario, names: list[str], links: list[RendererLink]
) -> None:
    pool = RendererPool(scenario, links, "embree")
    os.kill(links[1].process_id, signal.SIGKILL)
    with pytest.raises(RendererError, match=r"has ended \(signal 9\)"):
        pool.shoot(names, bodies_of(scenario), 0)


def test_a_renderer_that_is_unknown_is_refused(
    scenario: Scenario, links: list[RendererLink]
) -> None:
    with pytest.raises(RendererError, match="crayons"):
        RendererPool(scenario, links, "crayons")
