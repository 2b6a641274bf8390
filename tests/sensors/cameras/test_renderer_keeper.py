"""A process that draws for run after run."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator

import pytest

from airhilt import load
from airhilt.errors import RendererError
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.renderer_link import RendererKeeper
from airhilt.sensors.cameras.renderer_process import RendererProcess
from airhilt.sensors.cameras.scene.bodies import BodyState
from resources import held, linux_only

NOSE, TAIL = "nose-AAL123", "nose-DAL456"
CLEAR = {"visibility_m": 20_000.0}
HAZE = {"visibility_m": 2_000.0}


@pytest.fixture
def keeper() -> Iterator[RendererKeeper]:
    opened = RendererKeeper()
    yield opened
    opened.close()


def meeting(weather: dict[str, float], **size: int) -> Scenario:
    document = load("s02a_headon").model_dump(mode="json")
    document["cameras"] = [
        each | {"width_px": 64, "height_px": 36} | size for each in document["cameras"]
    ]
    return Scenario.model_validate(document | {"weather": weather})


def pictures(scenario: Scenario, keeper: RendererKeeper | None) -> list[bytes]:
    """Return what the cameras of a run see while one aircraft comes nearer."""
    link = None if keeper is None else keeper.link()
    with RendererProcess(scenario, renderer="embree", link=link) as process:
        return [
            frame.colour.tobytes()
            for step in range(6)
            for frame in process.shoot([NOSE, TAIL], bodies(step), step)
        ]


def bodies(step: int) -> list[BodyState]:
    return [
        BodyState("AAL123", 0.0, 9.0 * step, 3000.0, 0.0, 0.0, 0.01 * step, "clean", False),
        BodyState("DAL456", 4.0, 600.0 - 9.0 * step, 3000.0, 3.14, 0.0, 0.0, "clean", False),
    ]


@pytest.mark.slow
def test_each_run_has_the_pictures_that_a_process_of_its_own_draws(keeper: RendererKeeper) -> None:
    for scenario in (meeting(CLEAR), meeting(HAZE), meeting(CLEAR, width_px=96)):
        assert pictures(scenario, keeper) == pictures(scenario, None)


@linux_only
def test_one_process_draws_for_all_runs_and_nothing_piles_up(keeper: RendererKeeper) -> None:
    first = pictures(meeting(CLEAR), keeper)
    process_id, before = keeper.link().process_id, held()
    clear, haze, again = (pictures(meeting(one), keeper) for one in (CLEAR, HAZE, CLEAR))
    assert clear == again == first != haze
    assert keeper.link().process_id == process_id
    assert held() == before


def test_a_process_that_has_died_is_replaced(keeper: RendererKeeper) -> None:
    first = keeper.link()
    with RendererProcess(meeting(CLEAR), renderer="embree", link=first) as process:
        os.kill(first.process_id, signal.SIGKILL)
        with pytest.raises(RendererError, match="has ended"):
            process.shoot([NOSE], bodies(0), 0)
    assert keeper.link().process_id != first.process_id
    assert pictures(meeting(CLEAR), keeper)


@pytest.mark.slow
def test_a_scene_that_cannot_be_opened_does_not_end_the_process(keeper: RendererKeeper) -> None:
    link = keeper.link()
    with pytest.raises(RendererError, match="no renderer named"):
        RendererProcess(meeting(CLEAR), renderer="crayons", link=link)
    assert keeper.link() is link
    assert pictures(meeting(CLEAR), keeper)
