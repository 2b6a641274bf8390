"""A process that draws for run after run."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from airhilt import load
from airhilt.errors import RendererError
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.renderer_process import RendererKeeper, RendererProcess
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
    processes = [] if keeper is None else [keeper.process()]
    with RendererProcess(scenario, renderer="embree", processes=processes) as renderer:
        return [
            bytes(picture.pixels)
            for step in range(6)
            for picture in renderer.take([NOSE, TAIL], bodies(step), step)
        ]


def bodies(step: int) -> list[BodyState]:
    return [
        BodyState("AAL123", 0.0, 9.0 * step, 3000.0, 0.0, 0.0, 0.01 * step, "clean", False),
        BodyState("DAL456", 4.0, 600.0 - 9.0 * step, 3000.0, 3.14, 0.0, 0.0, "clean", False),
    ]


@linux_only
def test_one_process_draws_for_all_runs_and_nothing_piles_up(keeper: RendererKeeper) -> None:
    first = pictures(meeting(CLEAR), keeper)
    process_id, before = keeper.process().process_id, held()
    clear, haze, again = (pictures(meeting(one), keeper) for one in (CLEAR, HAZE, CLEAR))
    assert clear == again == first != haze
    assert keeper.process().process_id == process_id
    assert held() == before


def test_a_process_that_has_died_is_replaced(keeper: RendererKeeper) -> None:
    first = keeper.process()
    renderer = RendererProcess(meeting(CLEAR), renderer="embree", processes=[first])
    first.kill()
    with pytest.raises(RendererError, match="has ended"):
        renderer.take([NOSE], bodies(0), 0)
    assert keeper.process().process_id != first.process_id
    assert pictures(meeting(CLEAR), keeper)
