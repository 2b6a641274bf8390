"""Runs that share pictures have those that each would have drawn alone."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from airhilt import load
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.frame import CameraPicture, PictureSource
from airhilt.sensors.cameras.renderer_process import RendererProcess
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.shared_pictures import SharedPictures
from breadth import mostly_slow

CAMERAS = ("nose_aal123", "tail_aal123", "runway_01")
WEATHER: dict[str, dict[str, Any]] = {
    "day": {},
    "night in rain": {
        "weather": {"visibility_m": 4000.0, "rain_mm_h": 8.0},
        "daylight": {"solar_time_h": 22.0},
    },
}
STEPS = 14
APART = 8
"""Step at which some runs leave the others."""


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "airhilt" / "pictures"


def field(**changes: Any) -> Scenario:
    """Return a landing before small cameras: on nose and tail, and beside the runway."""
    document = load("s01a_intersecting").model_dump(mode="json")
    small = {"width_px": 96, "height_px": 54}
    document["cameras"] = [each | small for each in document["cameras"] if each["name"] in CAMERAS]
    return Scenario.model_validate(document | changes)


@pytest.fixture(scope="module", params=mostly_slow(WEATHER, "day"))
def scenario(request: pytest.FixtureRequest) -> Scenario:
    return field(**WEATHER[request.param])


@pytest.fixture(scope="module")
def process(scenario: Scenario) -> Iterator[RendererProcess]:
    with RendererProcess(scenario, renderer="embree", shares_pictures=True) as opened:
        yield opened


@pytest.fixture
def alone(scenario: Scenario) -> Iterator[RendererProcess]:
    with RendererProcess(scenario, renderer="embree") as opened:
        yield opened


class Shown(NamedTuple):
    """All of a picture that can be compared."""

    camera: str
    sha256: str
    pixels: bytes
    sightings: tuple[object, ...]


def taken(source: PictureSource, aside_m: float = 0.0) -> list[CameraPicture]:
    """Let a run take its pictures; in the end the landing aircraft flies aside of its path."""
    found = []
    for step in range(STEPS):
        aside = aside_m if step >= APART else 0.0
        bodies = [
            BodyState("AAL123", aside - 40.0, 12.0 * step - 900.0, 60.0 - 0.6 * step,
                      0.05, 0.03, 0.05 * step, "gear", True),
            BodyState("DAL456", 0.0, -200.0 + step, 4.0, 4.6, 0.0, 0.0, "gear", False),
        ]  # fmt: skip
        names, t_ns = list(CAMERAS), round(step / 16 * 1e9)
        if step % 5 == 2:  # An exposure is left out.
            source.prospects(names[:1], bodies, t_ns)
            names = names[1:]
        found += source.take(names, bodies, t_ns)
    return found


def shown(pictures: Sequence[CameraPicture]) -> list[Shown]:
    return [Shown(each.camera, each.sha256, bytes(each.pixels), each.sightings)
            for each in pictures]  # fmt: skip


def test_what_is_found_what_is_drawn_and_what_is_drawn_later_are_what_a_run_alone_draws(
    alone: RendererProcess, process: RendererProcess, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = shown(taken(alone))
    assert shown(taken(SharedPictures(process))) == expected
    with monkeypatch.context() as patch:
        patch.setattr(process, "ask", None)  # Nothing is drawn.
        found = taken(SharedPictures(process))
    assert [each.sha256 for each in found] == [each.sha256 for each in expected]
    assert [each.sightings for each in found] == [each.sightings for each in expected]
    assert len({each.sha256 for each in found}) > STEPS
    # Pixels in any order.
    assert shown(found[::-1]) == expected[::-1]


@pytest.mark.slow
def test_a_run_that_leaves_the_others_draws_what_it_would_have_drawn_alone(
    alone: RendererProcess, process: RendererProcess
) -> None:
    others = taken(SharedPictures(process))
    expected = shown(taken(alone, aside_m=25.0))
    assert expected[-3:] != shown(others)[-3:]
    assert shown(taken(SharedPictures(process), aside_m=25.0)) == expected
