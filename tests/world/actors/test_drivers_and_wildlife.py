"""Drivers and animals of real scenarios, told, advised and startled."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pydantic import TypeAdapter

from airhilt import load
from airhilt.commands import Command
from airhilt.geodesy.wgs84 import distance_m
from airhilt.messages import Advisory, Evidence, GoAround, HoldPosition, Severity
from airhilt.units import KNOT
from airhilt.world.actors import Actor, Unable, build_actors
from airhilt.world.actors.surface_actors import Driver
from airhilt.world.actors.triggers import Triggers
from airhilt.world.site import ScenarioSite

COMMAND = TypeAdapter(Command)


def cast_of(name: str, **changed: Any) -> dict[str, Any]:
    scenario = load(name)
    actors = tuple(
        actor.model_copy(update=changed) if actor.callsign in ("OPS1", "DEER1") else actor
        for actor in scenario.actors
        if actor.type != "aircraft"
    )
    scenario = scenario.model_copy(update={"actors": actors})
    return build_actors(scenario, ScenarioSite.of(scenario), 0, 0.05)


def tell(actor: Actor, action: str, **arguments: Any) -> None:
    actor.command(COMMAND.validate_python({"action": action, **arguments}))


def advance(actor: Actor, seconds: float) -> None:
    for _ in range(round(seconds * 20)):
        actor.body.advance()


def advisory(recommendation: object, active: bool = True) -> Advisory:
    return Advisory(
        id="r-1", revision=0, recipient="OPS1", recipients=("OPS1",), kind="runway_conflict",
        severity=Severity.WARNING, active=active, traffic=("AAL1", "OPS1"), message="",
        recommendation=recommendation, evidence=Evidence(sources=("adsb",)), t_ready_ns=0,
    )  # fmt: skip


@pytest.fixture
def driver() -> Driver:
    driver = cast_of("s01b_nominal")["OPS1"]
    assert isinstance(driver, Driver)
    return driver


def test_a_driver_drives_to_the_hold_and_stops_before_the_line(driver: Driver) -> None:
    site = driver.site
    tell(driver, "taxi", to={"type": "hold_short", "runway": "01", "taxiway": "D"})
    assert driver.body.phase == "driving"
    advance(driver, 120.0)
    state, line = driver.body.state, site.airport.hold("01", "D").place
    away = distance_m((state.latitude_rad, state.longitude_rad), line)
    assert driver.body.phase == "standing"
    assert away == pytest.approx(driver.body.dimensions.length_m / 2 + 3.0, abs=0.1)


def test_a_driver_stops_when_advised_to_hold_and_goes_on_when_told(driver: Driver) -> None:
    tell(driver, "taxi", to={"type": "node", "node": "01/19 at D"})
    advance(driver, 3.0)
    reaction = driver.hear(advisory(HoldPosition(runway="01")))
    assert 0.5 < reaction.delay_s < 15.0
    assert reaction.act()
    advance(driver, 10.0)
    assert driver.body.phase == "standing"
    assert not reaction.act()
    tell(driver, "continue")
    assert driver.body.phase == "driving"


def test_a_driver_takes_no_notice_of_what_is_not_for_drivers(driver: Driver) -> None:
    assert driver.hear(advisory(GoAround(runway="01"))) is None
    assert driver.hear(advisory(HoldPosition(runway="01"), active=False)) is None


def test_a_driver_who_never_complies_does_not(driver: Driver) -> None:
    never = load("s01b_nominal").actors[1].driver.model_copy(update={"compliance": 0.0})
    stubborn = cast_of("s01b_nominal", driver=never)["OPS1"]
    assert not stubborn.hear(advisory(HoldPosition(runway="01"))).responds


def test_a_driver_says_what_it_cannot_do(driver: Driver) -> None:
    with pytest.raises(Unable, match="unable, this is a vehicle"):
        tell(driver, "take_off", runway="01")
    with pytest.raises(Unable, match="no taxi route"):
        tell(driver, "taxi", to={"type": "node", "node": "01/19 at D"}, via=["H"])


def test_a_deer_walks_where_its_plan_says_and_hears_nobody() -> None:
    deer = cast_of("s01c_deer_undetected")["DEER1"]
    assert deer.hear(advisory(HoldPosition(runway="01"))) is None
    planned = deer.spec.plan[0]
    before = deer.body.state
    deer.command(planned.command)
    advance(deer, 20.0)
    after = deer.body.state
    walked = distance_m(
        (before.latitude_rad, before.longitude_rad), (after.latitude_rad, after.longitude_rad)
    )
    assert 10.0 < walked < 40.0
    with pytest.raises(Unable, match="animals do not land"):
        tell(deer, "land", runway="01")


def test_a_deer_that_startles_flees_what_comes_near_and_moves() -> None:
    actors = cast_of("s01b_nominal")
    wild = cast_of("s01c_nominal", startles_within_m=60.0)["DEER1"]
    car = actors["OPS1"]
    wild.others["OPS1"] = car
    wild.attend()
    assert not wild.body.startled
    state = car.body.state
    car.body.state = state._replace(
        latitude_rad=wild.body.state.latitude_rad + math.radians(0.0003),
        longitude_rad=wild.body.state.longitude_rad,
    )
    wild.attend()
    assert not wild.body.startled  # It stands.
    car.body.state = car.body.state._replace(velocity_north_m_s=-8.0)
    wild.attend()
    assert wild.body.startled


def test_what_waits_is_done_once_as_soon_as_it_is_true() -> None:
    done: list[str] = []
    triggers = Triggers()
    triggers.once(lambda now_ns: now_ns >= 5, lambda: done.append("a"))
    triggers.once(
        lambda now_ns: now_ns >= 3, lambda: triggers.once(lambda _: True, lambda: done.append("b"))
    )
    for now_ns in range(8):
        triggers.evaluate(now_ns)
    assert done == ["b", "a"]


def test_a_driver_who_has_no_way_to_go_on_with_says_so(driver: Driver) -> None:
    with pytest.raises(Unable, match="no further clearance"):
        tell(driver, "continue")


def test_a_driver_drives_across_the_grass_if_told_and_no_faster_than_told(driver: Driver) -> None:
    before = driver.body.state
    tell(driver, "taxi", to={"type": "node", "node": "K/E"}, off_taxiways=True, speed_kt=10.0)
    speeds = []
    for _ in range(20 * 200):
        driver.body.advance()
        speeds.append(driver.body.state.ground_speed_m_s)
    end = driver.site.airport.node("K/E")
    after = driver.body.state
    assert distance_m((after.latitude_rad, after.longitude_rad), end) < 0.5
    assert distance_m((before.latitude_rad, before.longitude_rad), end) > 50.0
    assert max(speeds) == pytest.approx(10.0 * KNOT, rel=1e-6)


def test_an_animal_told_to_go_where_nothing_is_or_to_fly_says_so() -> None:
    deer = cast_of("s01c_deer_undetected")["DEER1"]
    with pytest.raises(Unable, match="no taxiway node 'K/Z'"):
        tell(deer, "move", gait="walk", to={"type": "node", "node": "K/Z"})
    with pytest.raises(Unable, match="a deer does not fly"):
        tell(deer, "move", gait="fly", to={"type": "node", "node": "K/D"})
    assert deer.body.phase == "standing"


def test_what_passes_high_above_or_is_an_animal_too_startles_nobody() -> None:
    wild = cast_of("s01c_nominal", startles_within_m=60.0)["DEER1"]
    fleeing = wild.body.state._replace(velocity_north_m_s=-8.0)
    other = cast_of("s01c_nominal")["DEER1"]
    other.body.state = fleeing
    wild.others["DEER2"] = other
    wild.attend()
    assert not wild.body.startled
    car = cast_of("s01b_nominal")["OPS1"]
    wild.others["OPS1"] = car
    car.body.state = fleeing._replace(altitude_m=fleeing.altitude_m + 61.0)
    wild.attend()
    assert not wild.body.startled
    car.body.state = fleeing
    wild.attend()
    assert wild.body.startled


def test_an_animal_stands_still_when_its_plan_says_so() -> None:
    deer = cast_of("s01c_deer_undetected")["DEER1"]
    tell(deer, "move", gait="run", to={"type": "node", "node": "K/D"})
    advance(deer, 5.0)
    assert deer.body.phase == "running"
    tell(deer, "stand")
    advance(deer, 10.0)
    assert deer.body.phase == "standing"


def test_of_two_that_come_true_at_once_the_one_that_waited_longer_is_done_first() -> None:
    done: list[str] = []
    triggers = Triggers()
    for name in "abc":
        triggers.once(lambda now_ns: now_ns >= 3, lambda name=name: done.append(name))  # type: ignore[misc]
    for now_ns in range(5):
        triggers.evaluate(now_ns)
    assert done == ["a", "b", "c"]
