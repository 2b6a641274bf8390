"""Real aircraft and vehicles that taxi, follow, give way and wait for each other at KDCA."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from pydantic import TypeAdapter

from airhilt.commands import Command
from airhilt.geodesy.relative_motion import horizontal_distance_m
from airhilt.geodesy.wgs84 import distance_m
from airhilt.scenario.models import ActorSpec
from airhilt.world.actors import Actor, Unable, build_actors
from airhilt.world.loading import load
from airhilt.world.site import ScenarioSite

COMMAND = TypeAdapter(Command)
SPEC = TypeAdapter(ActorSpec)
TICK_S = 0.05


def at_node(node: str, heading_deg: float) -> dict[str, Any]:
    return {
        "type": "standing",
        "position": {"type": "node", "node": node},
        "heading_deg": heading_deg,
    }


def at_hold(runway: str, taxiway: str) -> dict[str, Any]:
    return {"type": "hold_short", "runway": runway, "taxiway": taxiway}


def on_final(distance_nm: float) -> dict[str, Any]:
    return {"type": "final", "runway": "01", "distance_nm": distance_nm}


class Field:
    """Actors at an airport, moved without a run."""

    def __init__(self, **begins: tuple[str, dict[str, Any]]) -> None:
        specs = [
            SPEC.validate_python(
                {
                    "type": "vehicle" if kind == "follow_me" else "aircraft",
                    "callsign": callsign,
                    "icao24": f"{index:06x}",
                    "kind" if kind == "follow_me" else "aircraft": kind,
                    "initial": initial,
                }
            )
            for index, (callsign, (kind, initial)) in enumerate(begins.items(), 1)
        ]
        scenario = load("s01b_ground_nominal").model_copy(update={"actors": tuple(specs)})
        self.site = ScenarioSite.of(scenario)
        self.actors: dict[str, Actor] = build_actors(scenario, self.site, 1, TICK_S)
        self.said: list[str] = []

    def tell(self, callsign: str, action: str, **arguments: Any) -> None:
        self.actors[callsign].command(COMMAND.validate_python({"action": action, **arguments}))

    def run(self, limit_s: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Move on, at most so long; return whether it became true."""
        for tick in range(round(limit_s / TICK_S)):
            for actor in self.actors.values():
                actor.body.advance()
            if tick % 2:
                for actor in self.actors.values():
                    try:
                        actor.attend()
                    except Unable as unable:
                        self.said.append(str(unable))
                if until():
                    return True
        return False

    def phase(self, callsign: str) -> str:
        return self.actors[callsign].body.phase

    def stands(self, callsign: str) -> Callable[[], bool]:
        return lambda: self.phase(callsign) in ("standing", "lined_up")

    def on(self, callsign: str) -> set[str]:
        """Return the runways in whose protected area the middle of an actor is."""
        state, airport = self.actors[callsign].body.state, self.site.airport
        at = airport.local_frame.to_local((state.latitude_rad, state.longitude_rad))
        return {strip.name for strip in airport.strips.values() if strip.protects(at)}

    def is_on(self, callsign: str, *runways: str) -> Callable[[], bool]:
        return lambda: self.on(callsign) == set(runways)

    def away_m(self, one: str, other: str) -> float:
        states = (self.actors[each].body.state for each in (one, other))
        return horizontal_distance_m(*states)


def test_an_airliner_and_a_car_hold_short_and_cross_when_told() -> None:
    field = Field(
        AAL1=("737", at_node("K/gate_b18", 175.0)),
        OPS1=("follow_me", at_node("vehicle_base", 85.0)),
    )
    for callsign in ("AAL1", "OPS1"):
        field.tell(callsign, "taxi_to", runway="33", via=["K"])
        assert field.run(150.0, field.stands(callsign))
        assert field.on(callsign) == set()
        with pytest.raises(Unable, match="holding short of runway 04"):
            field.tell(callsign, "continue")
        field.tell(callsign, "cross", runway="04")
        assert field.run(60.0, field.is_on(callsign, "04/22"))
        assert field.run(60.0, field.is_on(callsign))


@pytest.mark.parametrize("kind", ["737", "c172p"])
def test_backtracking_it_turns_at_the_beginning_and_takes_off(kind: str) -> None:
    field = Field(AAL1=(kind, at_hold("01", "D")))
    field.tell("AAL1", "backtrack", runway="01")
    assert field.run(300.0, field.stands("AAL1"))
    assert field.phase("AAL1") == "lined_up"
    with pytest.raises(Unable, match="lined up on runway 01"):
        field.tell("AAL1", "take_off", runway="19")
    field.tell("AAL1", "take_off", runway="01")
    assert field.run(60.0, lambda: not field.actors["AAL1"].body.on_ground)


def test_after_the_landing_it_leaves_where_it_is_told_and_taxies_on() -> None:
    field = Field(AAL1=("737", on_final(1.5)))
    field.tell("AAL1", "land", runway="01")
    field.tell("AAL1", "vacate", exit="N")
    assert field.run(120.0, lambda: field.phase("AAL1") == "rollout")
    field.tell("AAL1", "taxi_to", runway="15")
    assert field.run(120.0, lambda: field.on("AAL1") == set())
    state, airport = field.actors["AAL1"].body.state, field.site.airport
    left_at = (state.latitude_rad, state.longitude_rad)
    nearest = min(airport.holds.values(), key=lambda hold: distance_m(hold.place, left_at))
    assert nearest.name == "01/19 N"
    assert field.run(120.0, lambda: field.phase("AAL1") == "taxi")


def test_it_lines_up_behind_the_aircraft_that_lands() -> None:
    field = Field(AAL1=("737", at_hold("01", "A")), N5=("c172p", on_final(1.0)))
    field.tell("N5", "land", runway="01")
    line_up = {"action": "line_up", "runway": "01"}
    with pytest.raises(Unable, match="unable, landing airbus not in sight"):
        field.tell("AAL1", "behind", whom="landing airbus", traffic="landing", command=line_up)
    field.tell("AAL1", "behind", whom="the landing cessna", traffic="landing", command=line_up)
    assert field.run(120.0, lambda: field.phase("AAL1") == "line_up")
    assert field.phase("N5") in ("flare", "rollout")
    assert field.away_m("AAL1", "N5") > 50.0


def test_it_follows_at_a_distance_and_waits_before_a_runway() -> None:
    field = Field(
        AAL1=("737", at_node("K/gate_d38", 175.0)),
        OPS1=("follow_me", at_node("K/gate_b12", 175.0)),
    )
    field.tell("OPS1", "taxi_to", runway="01", cross=["04"])
    field.tell("AAL1", "follow", whom="the car")
    nearest = [1e9]

    def has_stopped() -> bool:
        nearest[0] = min(nearest[0], field.away_m("AAL1", "OPS1"))
        return False

    field.run(200.0, has_stopped)
    assert field.on("AAL1") == set()
    assert nearest[0] > 60.0
    state, hold = field.actors["AAL1"].body.state, field.site.airport.hold("04", "J_north")
    assert distance_m((state.latitude_rad, state.longitude_rad), hold.place) < 30.0


def test_who_is_to_follow_lets_the_other_leave_its_stand_and_pass_first() -> None:
    field = Field(
        AAL1=("737", at_node("gate_b12", 85.0)),
        OPS1=("follow_me", at_node("fire_station", 85.0)),
    )
    field.tell("AAL1", "taxi_to", runway="01")
    field.tell("OPS1", "follow", whom="the 737")
    assert not field.run(20.0, lambda: field.phase("OPS1") == "driving")
    nearest = [1e9]

    def has_come_near() -> bool:
        nearest[0] = min(nearest[0], field.away_m("AAL1", "OPS1"))
        return False

    field.run(100.0, has_come_near)
    state = field.actors["OPS1"].body.state
    assert nearest[0] > 40.0
    assert field.away_m("AAL1", "OPS1") < 150.0
    assert distance_m(state.place, field.site.airport.node("fire_station")) > 100.0


def test_it_takes_the_next_exit_where_another_stands_at_its_own() -> None:
    field = Field(AAL1=("737", on_final(1.0)), AAL2=("737", on_final(4.0)))
    for callsign in ("AAL1", "AAL2"):
        field.tell(callsign, "land", runway="01")
    assert field.run(240.0, lambda: all(field.stands(each)() for each in ("AAL1", "AAL2")))
    assert field.said == ["unable M, traffic there"]
    assert field.on("AAL1") == field.on("AAL2") == set()
    assert field.away_m("AAL1", "AAL2") > 60.0


def test_it_gives_way_until_the_other_has_passed() -> None:
    field = Field(
        AAL1=("737", at_node("K/gate_b18", 175.0)),
        OPS1=("follow_me", at_node("K/gate_b12", 355.0)),
    )
    field.tell("AAL1", "taxi_to", runway="01")
    field.tell("AAL1", "give_way", to="vehicle")
    assert not field.run(20.0, lambda: field.phase("AAL1") == "taxi")
    field.tell("OPS1", "taxi_to", place="gate D38")
    assert field.run(60.0, lambda: field.phase("AAL1") == "taxi")
    assert field.away_m("AAL1", "OPS1") > 50.0


def test_who_is_meant_is_asked_when_two_could_be() -> None:
    field = Field(
        AAL1=("737", at_node("K/gate_b18", 175.0)),
        AAL2=("737", at_node("gate_a2", 85.0)),
        DAL3=("737", at_node("gate_b12", 85.0)),
    )
    with pytest.raises(Unable, match="say again, which 737"):
        field.tell("AAL1", "give_way", to="737")
    for words in ("company 737", "American 2", "AAL2", "the Delta", "delta 3"):
        field.tell("AAL1", "give_way", to=words)


@pytest.mark.parametrize(
    "command",
    [
        {"action": "line_up", "runway": "01"},
        {"action": "take_off", "runway": "01"},
        {"action": "land", "runway": "01"},
        {"action": "backtrack", "runway": "01"},
        {"action": "altitude", "altitude_ft": 3000},
        {"action": "push_back"},
    ],
)
def test_a_driver_refuses_what_is_for_aircraft(command: dict[str, Any]) -> None:
    driver = Field(OPS1=("follow_me", at_hold("01", "D"))).actors["OPS1"]
    assert driver.refusal(COMMAND.validate_python(command)) == "unable, this is a vehicle"
