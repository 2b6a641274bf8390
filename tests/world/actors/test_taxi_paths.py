"""Ways over the airport: shortened before a line, out by an exit, and onto a final approach."""

from __future__ import annotations

import math
from functools import cache
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.commands import TaxiCommand
from airhilt.geodesy.positions import RunwayPosition
from airhilt.geodesy.wgs84 import distance_m, onward
from airhilt.units import KNOT
from airhilt.world.actors.actor import Unable
from airhilt.world.actors.final_approach import FinalApproach
from airhilt.world.actors.taxi_paths import (
    exit_for,
    hold_beside,
    taxi_path,
)
from airhilt.world.loading import load
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.ways import shortened
from breadth import examples


@cache
def kdca() -> ScenarioSite:
    return ScenarioSite.of(load("s01a_nominal"))


START = kdca().airport.node("K/D")
legs = st.lists(st.tuples(st.floats(0.0, 6.28), st.floats(1.0, 500.0)), min_size=1, max_size=8)


def way(steps: list[tuple[float, float]]) -> list[tuple[float, float]]:
    path = [START]
    for bearing, length in steps:
        path.append(onward(path[-1], bearing, length))
    return path


def length_m(path: list[tuple[float, float]]) -> float:
    return sum(distance_m(*leg) for leg in pairwise(path))


# --- shortened --------------------------------------------------------------------------------


@examples(50)
@given(legs, st.floats(0.0, 0.99))
def test_a_way_is_shortened_by_what_was_asked(
    steps: list[tuple[float, float]], part: float
) -> None:
    path = way(steps)
    by_m = part * length_m(path)
    short = shortened(path, by_m)
    assert length_m(short) == pytest.approx(length_m(path) - by_m, abs=1e-3)
    assert short[:-1] == path[: len(short) - 1]


@examples(20)
@given(legs, st.floats(1.0, 500.0))
def test_of_a_way_that_is_too_short_its_beginning_is_left(
    steps: list[tuple[float, float]], more_m: float
) -> None:
    path = way(steps)
    assert shortened(path, length_m(path) + more_m) == path[:1]


# --- final approach ---------------------------------------------------------------------------


@examples(60)
@given(
    st.sampled_from(["01", "19", "04", "22", "15", "33"]),
    st.floats(-15_000.0, 3_000.0),
    st.floats(-3_000.0, 3_000.0),
    st.floats(-3.1, 3.1),
)
def test_a_place_off_a_final_approach_is_told_by_its_distances(
    runway: str, along_m: float, right_m: float, angle: float
) -> None:
    final = FinalApproach(kdca().airport, kdca().runway(runway))
    place = kdca().place(
        RunwayPosition(type="runway", runway=runway, along_m=along_m, offset_m=right_m)
    )
    # The frame is flat, the Earth is not: a metre in ten kilometres.
    assert final.before_m(place) == pytest.approx(-along_m, abs=5.0)
    assert final.right_m(place) == pytest.approx(right_m, abs=20.0)
    track = kdca().runway(runway).course_rad + angle
    assert final.angle_rad(track) == pytest.approx(angle, abs=1e-9)
    assert final.angle_rad(track + 2.0 * math.pi) == pytest.approx(angle, abs=1e-9)


# --- exits ------------------------------------------------------------------------------------


@examples(40)
@given(st.sampled_from(["01", "19", "04", "22", "15", "33"]), st.floats(50.0, 180.0))
def test_the_exit_is_the_first_that_a_normal_rollout_makes(runway: str, speed_kt: float) -> None:
    """Touched down 450 m past the threshold, it brakes with 2 m/s2 to what it turns off with."""
    end, speed = kdca().runway(runway), speed_kt * KNOT
    exits = kdca().airport.exits(runway)
    found = exit_for(kdca(), end, speed, None)
    stop_m = 450.0 + (speed**2 - 8.0**2) / 4.0
    made = [way.along_m for way in exits if way.along_m >= stop_m]
    if not made:
        assert found is None
    else:
        assert found.along_m == pytest.approx(min(made), abs=1.0)


def test_where_a_taxiway_crosses_the_runway_it_leaves_towards_the_stands() -> None:
    """M has exits on both sides; the stands lie to the west."""
    found = exit_for(kdca(), kdca().runway("01"), 66.0, "M_west")
    first = exit_for(kdca(), kdca().runway("01"), 63.0, None)
    assert found.position == "M_west"
    assert first.taxiway == "M"
    assert first.position == "M_west"


def test_a_named_exit_is_that_one_and_an_unknown_one_is_told_with_those_there_are() -> None:
    end = kdca().runway("01")
    assert exit_for(kdca(), end, 60.0, "D").taxiway == "D"
    with pytest.raises(Unable, match="runway 01 has no exit Q; there are: B_"):
        exit_for(kdca(), end, 60.0, "Q")


# --- holds and taxi ways ----------------------------------------------------------------------


@pytest.mark.parametrize("name", ["01/19 E", "15/33 G", "04/22 C"])
def test_the_hold_beside_an_actor_is_the_nearest_of_that_runway(name: str) -> None:
    hold = kdca().airport.holds[name]
    here = onward(hold.place, hold.heading_rad, -30.0)
    for ident in hold.runway.split("/"):
        assert hold_beside(kdca(), here, ident) is hold


def test_far_from_every_hold_of_a_runway_there_is_none() -> None:
    hold = kdca().airport.hold("01", "E")
    with pytest.raises(Unable, match="not at a hold-short position of runway 33"):
        hold_beside(kdca(), hold.place, "33")
    with pytest.raises(Unable, match="no runway 36"):
        hold_beside(kdca(), hold.place, "36")


def taxi(to: dict[str, Any], **more: Any) -> TaxiCommand:
    return TaxiCommand.model_validate({"action": "taxi", "to": to, **more})


def test_a_way_ends_where_it_was_told_to() -> None:
    gate = kdca().airport.node("gate_b12")
    path = taxi_path(kdca(), START, taxi({"type": "node", "node": "gate_b12"}), 10.0)
    assert distance_m(path[-1], gate) < 0.01
    assert distance_m(path[0], START) < 0.01


@pytest.mark.parametrize("nose_m", [2.5, 16.8, 35.3])
def test_short_of_a_line_the_nose_stops_three_metres_before_it(nose_m: float) -> None:
    command = taxi({"type": "hold_short", "runway": "01", "taxiway": "D"})
    path = taxi_path(kdca(), kdca().airport.node("gate_b12"), command, nose_m)
    line = kdca().airport.hold("01", "D")
    assert distance_m(path[-1], line.place) == pytest.approx(nose_m + 3.0, abs=0.1)


@pytest.mark.parametrize(
    ("command", "what"),
    [
        (taxi({"type": "node", "node": "K/Z"}), "no taxiway node 'K/Z'"),
        (taxi({"type": "node", "node": "gate_b12"}, via=["Q"]), "no taxiway 'Q'"),
        (taxi({"type": "from_centre", "bearing_deg": 90, "distance_nm": 3}), "nearest taxiway"),
    ],
)
def test_where_no_way_leads_is_said(command: TaxiCommand, what: str) -> None:
    with pytest.raises(Unable, match=what):
        taxi_path(kdca(), START, command, 10.0)


def test_off_the_taxiways_it_is_straight_there() -> None:
    command = taxi({"type": "node", "node": "gate_b12"}, off_taxiways=True)
    path = taxi_path(kdca(), START, command, 10.0)
    assert path == [START, kdca().airport.node("gate_b12")]
