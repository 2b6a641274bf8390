"""The shapes of an airport, which its diagram and the plan view of a report both draw."""

from __future__ import annotations

import math
import re
from itertools import pairwise

import pytest

from airhilt.report.airport import ReportAirport
from airhilt.world.surface.airport import load_airport
from airhilt.world.surface.chart import as_svg
from airhilt.world.surface.ground_plan import GroundPlan, ground_plan
from airhilt.world.surface.layout import Layout


@pytest.fixture(scope="module")
def layout() -> Layout:
    return Layout(load_airport("kdca"))


@pytest.fixture(scope="module")
def plan(layout: Layout) -> GroundPlan:
    return ground_plan(layout)


def test_a_runway_is_as_long_and_wide_as_its_file_says(plan: GroundPlan) -> None:
    (runway,) = (one for one in plan.runways if one.name == "01/19")
    assert math.dist(*runway.centreline) == pytest.approx(runway.ends[0].length_m, abs=1.0)
    assert len(runway.pavement) == 4
    sides = sorted(math.dist(a, b) for a, b in pairwise(runway.pavement))
    assert sides[0] == pytest.approx(runway.width_m, abs=0.5)


def test_a_hold_line_is_wider_than_its_taxiway_and_never_too_short_to_see(plan: GroundPlan) -> None:
    hold = plan.holds[0]
    assert math.dist(*hold.ends()) == pytest.approx(32.0)
    assert math.dist(*hold.ends(least_half_m=100.0)) == pytest.approx(200.0)
    assert math.dist(*hold.ends(least_half_m=1.0)) == pytest.approx(32.0)


def test_a_direction_of_a_runway_is_found_by_its_ident(plan: GroundPlan) -> None:
    end = plan.runway_end("19")
    assert end is not None
    assert end.threshold[1] > end.far_end[1]
    assert plan.runway_end("36") is None


def test_the_diagram_and_the_report_draw_the_same_shapes(layout: Layout, plan: GroundPlan) -> None:
    document, page = as_svg(layout), ReportAirport("kdca").as_json()
    for style, shapes, drawn in (
        ("building", plan.buildings, page["buildings"]),
        ("water", plan.water, page["water"]),
        ("runway", plan.runways, page["runways"]),
        ("hold", plan.holds, page["holds"]),
    ):
        in_diagram = re.findall(f'<[a-z]+ class="{style}" [^>]*><title>', document)
        assert len(in_diagram) == len(drawn) == len(shapes)
    assert {taxiway["name"] for taxiway in page["taxiways"]} == set(plan.taxiways)
