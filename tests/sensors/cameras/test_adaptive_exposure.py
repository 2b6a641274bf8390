"""A camera with adaptive exposure: when it leaves exposures out, and what it says of them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt import load
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.scene.bodies import BodyState, aircraft_model
from airhilt.sensors.cameras.scene.builder import open_scene_renderer
from airhilt.sensors.cameras.scene_renderer import SceneRenderer
from airhilt.sensors.cameras.sensor import Exposures
from airhilt.units import SECOND_NS
from airhilt.world.site import ScenarioSite

NOSE = "nose-AAL123"
"""Camera of 640 pixels and 25 degrees: a 737 that comes covers two pixels from 20 km."""
LENS = {"width_px": 64, "height_px": 36, "horizontal_fov_deg": 2.5}
"""As many pixels per degree, and fewer of them."""
SHAPES = aircraft_model("737").shapes


def encounter(**weather: float) -> Scenario:
    """Return two aircraft at FL350, with a small camera on the nose of one."""
    document = load("s02a_headon").model_dump(mode="json")
    document["cameras"] = [document["cameras"][0] | LENS]
    document["weather"] |= weather
    return Scenario.model_validate(document)


def open_renderer(scenario: Scenario) -> SceneRenderer:
    return open_scene_renderer(scenario, ScenarioSite.of(scenario), renderer="embree")


@pytest.fixture(scope="module")
def clear() -> Iterator[SceneRenderer]:
    opened = open_renderer(encounter(visibility_m=60_000.0))
    yield opened
    opened.close()


def flying(actor: str, ahead_m: float, heading_rad: float, lit: bool = False) -> BodyState:
    """Return a 737 so far north of the origin."""
    shape = next(iter(SHAPES))
    return BodyState(actor, 0.0, ahead_m, 10_600.0, heading_rad, 0.07, 0.0, shape, lit)


def before(renderer: SceneRenderer, ahead_m: float, lit: bool = False) -> bool:
    """Return whether the camera has a body before it that comes from so far ahead."""
    bodies = [flying("AAL123", 0.0, 0.0), flying("DAL456", ahead_m, np.pi, lit)]
    return renderer.prospects([NOSE], bodies, 0)[NOSE].has_body


# --- what makes a camera expose at its rate ---------------------------------------------------


@pytest.mark.parametrize(
    ("ahead_m", "is_body"),
    [(10_000.0, True), (17_000.0, True), (24_000.0, False), (-5_000.0, False)],
)
def test_a_body_counts_once_the_box_about_it_covers_two_pixels(
    clear: SceneRenderer, ahead_m: float, is_body: bool
) -> None:
    assert before(clear, ahead_m) is is_body


def test_a_body_that_the_fog_hides_does_not_count() -> None:
    renderer = open_renderer(encounter(visibility_m=1500.0))
    assert not before(renderer, 10_000.0)
    assert before(renderer, 900.0)
    renderer.close()


def test_the_aircraft_that_carries_the_camera_does_not_count(clear: SceneRenderer) -> None:
    alone = [flying("AAL123", 0.0, 0.0)]
    assert not clear.prospects([NOSE], alone, 0)[NOSE].has_body


def test_a_light_counts_from_where_it_can_be_seen() -> None:
    """A detector may find an aircraft at night by its lights, which are seen farther than it."""
    document = encounter(visibility_m=60_000.0).model_dump(mode="json")
    document["daylight"]["solar_time_h"] = 0.0
    renderer = open_renderer(Scenario.model_validate(document))
    assert before(renderer, 24_000.0, lit=True)
    renderer.close()


def test_rain_falls_in_a_picture_as_if_none_before_had_been_left_out() -> None:
    renderers = [open_renderer(encounter(rain_mm_h=4.0, visibility_m=5000.0)) for _ in range(2)]
    alone = [flying("AAL123", 0.0, 0.0)]
    for number in range(4):
        (full,) = renderers[0].shoot([NOSE], alone, number)
        if number in (1, 2):
            assert not renderers[1].prospects([NOSE], alone, number)[NOSE].has_body
        else:
            (adaptive,) = renderers[1].shoot([NOSE], alone, number)
    np.testing.assert_array_equal(full.colour, adaptive.colour)
    for renderer in renderers:
        renderer.close()


# --- the grid of exposures --------------------------------------------------------------------


@given(rate_hz=st.floats(0.2, 60.0), second=st.integers(0, 2000))
def test_one_exposure_of_the_grid_begins_each_second(rate_hz: float, second: int) -> None:
    exposures = Exposures(rate_hz, 250)
    first = max(int(second * rate_hz) - 2, 0)
    inside = [
        seq
        for seq in range(first, first + int(rate_hz) + 6)
        if (exposures.end_ns(seq) - 250) // SECOND_NS == second
    ]
    assert [seq for seq in inside if exposures.begins_second(seq)] == inside[:1]
