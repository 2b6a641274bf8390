"""What is done on the ground when told, at every airport that ships and at imported ones."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from pydantic import TypeAdapter

from airhilt.commands import Command
from airhilt.geodesy.positions import GeodeticPosition
from airhilt.geodesy.wgs84 import Place, azimuth, distance_m, onward
from airhilt.units import DEGREE
from airhilt.world.actors.actor import Unable
from airhilt.world.actors.ground_operations import GroundOperations
from airhilt.world.actors.traffic import Traffic
from airhilt.world.mover import SurfaceState
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.airport import Airport, load_airport
from airhilt.world.surface.importer import import_airport
from airhilt.world.surface.layout import Hold, Layout
from breadth import examples

COMMAND = TypeAdapter(Command)
TABLES = Path(__file__).parent.parent / "surface" / "ourairports"
SHIPPED = ("KDCA", "EHAM", "KSFO", "LSZH", "RJTT")
IMPORTED = ("KPAO", "LSZH")
STEP_M = 5.0
"""Distance between two looks at a walker, in m."""


@cache
def site(name: str, *, is_imported: bool = False) -> ScenarioSite:
    airport: Airport = (
        import_airport(
            name, TABLES / "runways.csv", TABLES / "airport-frequencies.csv", year=2025.0
        )
        if is_imported
        else load_airport(name)
    )
    layout = Layout(airport)
    latitude, longitude = layout.local_frame.to_place(0.0, 0.0)
    centre = GeodeticPosition(
        type="geodetic", lat_deg=latitude / DEGREE, lon_deg=longitude / DEGREE
    )
    return ScenarioSite(centre, layout.elevation_m, layout)


SITES = [site(name) for name in SHIPPED] + [site(name, is_imported=True) for name in IMPORTED]
sites = st.sampled_from(SITES)


class Walker:
    """A body that goes exactly along its path, as far as a test lets it."""

    braking_m_s2 = 1.5
    is_airborne = False
    is_rolling_out = False
    busy = ""

    def __init__(self, place: Place, heading_rad: float, length_m: float) -> None:
        self.place, self.heading_rad, self.length_m = place, heading_rad, length_m
        self.path: list[Place] = []
        self.held = False

    @property
    def state(self) -> SurfaceState:
        return SurfaceState(*self.place, 0.0, 0.0, 0.0, 0.0, 0.0, self.heading_rad)

    @property
    def is_moving(self) -> bool:
        return bool(self.path) and not self.held

    @property
    def can_resume(self) -> bool:
        return bool(self.path)

    def go(self, path: Sequence[Place], speed_m_s: float | None) -> None:
        self.path, self.held = list(path), False

    def stop(self) -> None:
        self.held = True

    def resume(self) -> None:
        self.held = False

    def step(self) -> None:
        """Go on by a few metres."""
        while self.is_moving:
            away_m = distance_m(self.place, self.path[0])
            if away_m < 0.01:
                self.path.pop(0)
                continue
            self.heading_rad = azimuth(self.place, self.path[0])
            part = min(STEP_M / away_m, 1.0)
            north, east = (b - a for a, b in zip(self.place, self.path[0], strict=True))
            self.place = self.place[0] + part * north, self.place[1] + part * east
            return


class Ground:
    """A walker on an airport, with what it is told and where it has been."""

    def __init__(
        self, at: ScenarioSite, place: Place, heading_rad: float = 0.0, length_m: float = 6.0
    ) -> None:
        self.airport = at.airport
        self.walker = Walker(place, heading_rad, length_m)
        self.operations = GroundOperations(self.walker, at, Traffic("OPS1", {}))

    @classmethod
    def at_hold(cls, at: ScenarioSite, hold: Hold) -> Ground:
        """Return somebody who stands before a hold line."""
        here = onward(hold.place, hold.heading_rad, -6.0)
        return cls(at, here, hold.heading_rad)

    def tell(self, action: str, **arguments: Any) -> None:
        act = self.operations.plan(COMMAND.validate_python({"action": action, **arguments}))
        assert act is not None
        act()

    def walk(self) -> Iterator[set[str]]:
        """Go on until it stands; yield the runways in whose protected area it is on the way."""
        for _ in range(10_000):
            self.operations.attend()
            if not self.walker.is_moving:
                return
            self.walker.step()
            yield self.on_runways()
        raise AssertionError("it never comes to a stand")

    def go(self) -> set[str]:
        """Go on until it stands; return the runways that it has been on."""
        return set().union(*self.walk())

    def on_runways(self) -> set[str]:
        """Return the runways in whose protected area its nose or its middle is."""
        frame, walker = self.airport.local_frame, self.walker
        east, north = frame.to_local(walker.place)
        half_m = walker.length_m / 2.0
        nose = (
            east + half_m * math.sin(walker.heading_rad),
            north + half_m * math.cos(walker.heading_rad),
        )
        strips = self.airport.strips.values()
        return {one.name for one in strips if one.protects(nose) or one.protects((east, north))}

    def nodes_on(self, taxiway: str) -> set[str]:
        """Return the nodes of a taxiway."""
        edges = self.airport.airport.taxiways.edges
        return {node for edge in edges if edge.taxiway == taxiway for node in edge.nodes}

    def is_right_of(self, strip: str) -> bool:
        """Return whether it is to the right of a runway, seen along its first direction."""
        end = self.airport.strips[strip].ends[0]
        return math.sin(azimuth(end.start, self.walker.place) - end.course_rad) > 0.0

    def nearest_hold(self) -> Hold:
        """Return the hold nearest to its nose."""
        return min(self.airport.holds.values(), key=self.nose_to_m)

    def nose_to_m(self, hold: Hold) -> float:
        walker = self.walker
        nose = onward(walker.place, walker.heading_rad, walker.length_m / 2.0)
        return distance_m(nose, hold.place)


def junctions(airport: Layout) -> list[str]:
    """Return stands and junctions, where actors may begin."""
    kinds = {node.name: node.kind for node in airport.airport.taxiways.nodes}
    used = {node for edge in airport.airport.taxiways.edges for node in edge.nodes}
    return [name for name, kind in kinds.items() if kind in ("stand", "junction") and name in used]


# --- to taxi ----------------------------------------------------------------------------------


@st.composite
def taxiing(draw: st.DrawFn) -> tuple[Ground, dict[str, Any]]:
    """Return somebody at a place of an airport, and a taxi clearance."""
    at = draw(sites)
    airport = at.airport
    start = draw(st.sampled_from(junctions(airport)))
    heading_rad, length_m = draw(st.floats(0.0, 6.28)), draw(st.sampled_from([6.0, 34.0]))
    to = draw(
        st.one_of(
            st.fixed_dictionaries(
                {
                    "runway": st.sampled_from(
                        [e.ident for s in airport.strips.values() for e in s.ends]
                    )
                }
            ),
            st.fixed_dictionaries({"place": st.sampled_from(list(airport.stands))}),
            st.fixed_dictionaries(
                {"place": st.sampled_from([e.taxiway for e in airport.airport.taxiways.edges])}
            ),
        )
    )
    return Ground(at, airport.node(start), heading_rad, length_m), to


@examples(100)
@given(taxiing())
def test_nobody_enters_a_runway_before_it_is_told_to_cross(
    case: tuple[Ground, dict[str, Any]],
) -> None:
    ground, to = case
    try:
        ground.tell("taxi_to", **to)
    except Unable:
        assume(False)
    allowed = ground.on_runways()
    for _ in range(10):
        for on in ground.walk():
            assert on <= allowed
            allowed = on or allowed
        if ground.operations.has_arrived:
            return
        with pytest.raises(Unable, match="unable, holding short of runway"):
            ground.tell("continue")
        ground.tell("cross")
        allowed = {ground.nearest_hold().runway}
    raise AssertionError("it never arrives")


@examples(100)
@given(taxiing())
def test_a_taxi_clearance_leads_to_where_it_says(case: tuple[Ground, dict[str, Any]]) -> None:
    ground, to = case
    airport = ground.airport
    try:
        ground.tell("taxi_to", **to)
    except Unable:
        assume(False)
    while not ground.operations.has_arrived:
        ground.go()
        if not ground.operations.has_arrived:
            ground.tell("cross")
    if "runway" in to:
        hold = ground.nearest_hold()
        assert hold.runway == airport.strip_of(to["runway"]).name
        assert ground.nose_to_m(hold) < 8.0
        airport.entry_path(hold, to["runway"])
    elif to["place"] in airport.stands:
        assert distance_m(ground.walker.place, airport.node(to["place"])) < 3.0
    else:
        nodes = ground.nodes_on(to["place"])
        away_m = min(distance_m(ground.walker.place, airport.node(node)) for node in nodes)
        assert away_m <= ground.walker.length_m + 4.0


@pytest.mark.parametrize(
    ("command", "why"),
    [
        ({"action": "taxi_to", "place": "gate a3"}, "unable, no gate a3 at KDCA, there is gate a"),
        ({"action": "taxi_to", "place": "the pub"}, "unable, no the pub at KDCA"),
        ({"action": "taxi_to", "runway": "36"}, "unable, no runway 36 at KDCA, there is 33"),
        ({"action": "taxi_to", "runway": "01", "via": ["Q"]}, "unable, no taxiway Q at KDCA"),
        (
            {"action": "taxi_to", "runway": "01", "place": "C"},
            "unable, C does not lead to runway 01",
        ),
        ({"action": "taxi_to", "runway": "01", "cross": ["15"]}, "unable, runway 15 is not on our"),
        ({"action": "hold_short", "taxiway": "Q"}, "unable, no taxiway Q at KDCA"),
        ({"action": "hold_short"}, "say again, hold short of what"),
        ({"action": "cross", "runway": "01"}, "unable, not at a hold-short position of runway 01"),
        ({"action": "enter", "runway": "01"}, "unable, not at a hold-short position of runway 01"),
        ({"action": "vacate"}, "unable, not on a runway"),
        ({"action": "continue"}, "unable, no further clearance"),
        ({"action": "push_back"}, "unable, no tug here"),
        ({"action": "follow", "whom": "company Embraer"}, "unable, company Embraer not in sight"),
    ],
)
def test_what_cannot_be_done_from_a_stand_is_said(command: dict[str, Any], why: str) -> None:
    ground = Ground(site("KDCA"), site("KDCA").airport.node("gate_b12"), 1.5)
    with pytest.raises(Unable, match=why):
        ground.tell(**command)
    assert ground.walker.path == []


# --- to hold short ----------------------------------------------------------------------------


def test_who_stands_at_a_hold_line_holds_short_there_without_a_name() -> None:
    ground = Ground.at_hold(site("KDCA"), site("KDCA").airport.hold("01", "A"))
    ground.tell("hold_short")
    assert ground.go() == set()


@examples(60)
@given(st.data(), sites)
def test_told_to_hold_short_of_a_taxiway_on_its_way_it_stops_before_it(
    data: st.DataObject, at: ScenarioSite
) -> None:
    airport = at.airport
    ground = Ground(at, airport.node(data.draw(st.sampled_from(airport.stands))))
    ground.tell("taxi_to", runway=data.draw(st.sampled_from(ends_of(airport))))
    taxiways = {edge.taxiway for edge in airport.airport.taxiways.edges} - {"ramp"}
    taxiway = data.draw(st.sampled_from(sorted(taxiways)))
    try:
        ground.tell("hold_short", taxiway=taxiway)
    except Unable as unable:
        assume("not on our way" not in str(unable) and "past" not in str(unable))
        raise
    begun = ground.walker.place
    ground.go()
    while ground.nose_to_m(ground.nearest_hold()) < 5.0:
        ground.tell("cross")
        ground.go()
    nodes = ground.nodes_on(taxiway)
    away_m = min(distance_m(ground.walker.place, airport.node(node)) for node in nodes)
    assert away_m > 20.0 or distance_m(ground.walker.place, begun) < 1.0
    ground.tell("continue")
    assert ground.walker.is_moving


def ends_of(airport: Layout) -> list[str]:
    return [end.ident for strip in airport.strips.values() for end in strip.ends]


def test_a_way_that_was_given_over_a_runway_stops_before_it_when_told() -> None:
    ground = Ground(site("KDCA"), site("KDCA").airport.node("K/E"), 1.5)
    ground.tell("taxi", to={"type": "node", "node": "01/19 at E"})
    walk = ground.walk()
    next(walk)
    ground.tell("hold_short", runway="19")
    assert ground.go() == set()
    assert ground.nearest_hold().name == "01/19 E"
    ground.tell("cross", runway="01", at="E")
    assert ground.go() == {"01/19"}
    with pytest.raises(Unable, match="unable, already on runway 01"):
        ground.tell("hold_short", runway="01")


def test_what_has_been_passed_is_held_short_of_no_more() -> None:
    ground = Ground(site("KDCA"), site("KDCA").airport.node("gate_b12"), 4.6)
    ground.tell("taxi_to", runway="01")
    for taxiway in ("E", "F"):
        with pytest.raises(Unable, match=f"unable, taxiway {taxiway} is not on our way"):
            ground.tell("hold_short", taxiway=taxiway)
    ground.go()
    ground.tell("cross", runway="04")
    walk = ground.walk()
    while "04/22" not in next(walk):
        pass
    while "04/22" in next(walk):
        pass
    with pytest.raises(Unable, match="unable, past taxiway D"):
        ground.tell("hold_short", taxiway="D")
    with pytest.raises(Unable, match="unable, past runway 22"):
        ground.tell("hold_short", runway="22")
    ground.tell("hold_short", runway="01")


def test_who_holds_its_position_goes_on_only_when_told() -> None:
    ground = Ground(site("KDCA"), site("KDCA").airport.node("gate_b12"), 4.6)
    ground.tell("taxi_to", runway="01")
    next(ground.walk())
    ground.tell("hold_position")
    ground.tell("hold_short", taxiway="B")
    assert ground.go() == set()
    assert not ground.walker.is_moving
    ground.tell("continue")
    assert ground.walker.is_moving


# --- over runways -----------------------------------------------------------------------------


@examples(60)
@given(st.data(), sites)
def test_from_a_hold_it_crosses_to_beyond_the_other_one_or_says_that_no_way_leads_there(
    data: st.DataObject, at: ScenarioSite
) -> None:
    airport = at.airport
    hold = data.draw(st.sampled_from(list(airport.holds.values())))
    ground = Ground.at_hold(at, hold)
    runway = hold.runway.split("/")[0]
    try:
        ground.tell("cross", runway=runway)
    except Unable as unable:
        assert f"does not lead across runway {runway}" in str(unable)  # noqa: PT017
        return
    was_right = ground.is_right_of(hold.runway)
    assert ground.go() == {hold.runway}
    assert ground.on_runways() == set()
    assert ground.is_right_of(hold.runway) != was_right


@examples(60)
@given(st.data(), sites)
def test_who_enters_a_runway_stays_there_and_leaves_it_when_told(
    data: st.DataObject, at: ScenarioSite
) -> None:
    hold = data.draw(st.sampled_from(list(at.airport.holds.values())))
    ground = Ground.at_hold(at, hold)
    ground.tell("enter", runway=hold.runway.split("/")[1])
    ground.go()
    assert hold.runway in ground.on_runways()
    exit_name = data.draw(st.sampled_from([None, hold.taxiway]))
    ground.tell("vacate", exit=exit_name)
    assert ground.go() >= {hold.runway}
    assert hold.runway not in ground.on_runways()
