"""An ordinary call is always obeyed; how an urgent one is, the response model says."""

from __future__ import annotations

from functools import partial

import pytest

from airhilt.messages import Advisory, Climb, Evidence, Severity
from airhilt.scenario.models import Channels, ResponseModel, Responses
from airhilt.sim import Priority
from airhilt.units import SECOND_NS, seconds_to_ns
from conversations import CLEARANCE, KHZ, READBACK, TOWER, World, line

AT_ONCE = Channels(assistant=Responses(median_s=1.0, sigma=0.0))
NEVER = Channels(
    assistant=Responses(median_s=1.0, sigma=0.0),
    controller=Responses(median_s=3.0, sigma=0.0, no_response=1.0),
)
AFTER_3_S = Channels(
    assistant=Responses(median_s=1.0, sigma=0.0), controller=Responses(median_s=3.0, sigma=0.0)
)
HELLO = line("hello", 1, "AAL123", TOWER, "Hello.")


def world_of(crews: Channels) -> World:
    """Return a world in which somebody has called a unit whose controller reacts after 5 s."""
    prompt = {"reaction_median_s": 5.0, "reaction_sigma": 0.0}
    model = ResponseModel(crews=crews, drivers=AT_ONCE, controllers=AT_ONCE.assistant)
    return World(HELLO, CLEARANCE, controllers={TOWER: prompt}, crews=model)


def advised(world: World, at_s: float) -> World:
    """Let the controller be advised that a crew climbs."""
    up = Climb(sense="climb", altitude_ft=34_000.0, vertical_rate_fpm=1500.0)
    advisory = Advisory(
        t_ns=seconds_to_ns(at_s), id="decision-1", revision=0, recipient="ATC",
        recipients=("ATC",), kind="loss_of_separation", severity=Severity.WARNING,
        traffic=("AAL123", "DAL456"), message="traffic", t_ready_ns=0,
        evidence=Evidence(sources=("adsb",)), recommendations={"AAL123": up},
    )  # fmt: skip
    take = partial(world.conversation.take, "advisory/ATC", advisory, b"")
    world.director.at(advisory.t_ns, take, Priority.SCRIPT)
    return world


@pytest.mark.parametrize("crews", [AT_ONCE, NEVER, AFTER_3_S])
def test_an_ordinary_call_is_obeyed_whatever_the_response_model(crews: Channels) -> None:
    world = world_of(crews).run_until(60.0)
    ((callsign, command, at_s),) = world.done
    assert (callsign, command.altitude_ft) == ("AAL123", 33_000.0)
    assert at_s == pytest.approx(world.spoken("clearance").t_end_ns / SECOND_NS + 2.0)


def test_an_urgent_call_is_obeyed_after_the_time_of_the_response_model() -> None:
    world = advised(world_of(AFTER_3_S), 30.0).run_until(60.0)
    (_, (callsign, command, at_s)) = world.done
    assert (callsign, command.altitude_ft) == ("AAL123", 34_000.0)
    urgent = world.spoken("controller.Washington_Center.1")
    assert at_s == pytest.approx(urgent.t_end_ns / SECOND_NS + 3.0)


def test_who_does_not_respond_to_an_urgent_call_is_told_of_once() -> None:
    world = advised(world_of(NEVER), 30.0).run_until(60.0)
    texts = [told for _, told, _ in world.done if isinstance(told, str)]
    assert texts == ["does not respond to altitude (controller.Washington_Center.1)"]
    assert len(world.done) == 2


def test_a_crew_that_does_not_know_the_frequency_of_a_unit_asks_for_it_and_stays() -> None:
    contact = {"action": "contact", "unit": "Nowhere Ground"}
    commands = [*CLEARANCE["commands"], {"actor": "AAL123", "command": contact}]
    world = World({**CLEARANCE, "commands": commands}, READBACK).run_until(60.0)
    question = world.spoken("clearance.contact")
    assert question.text == "Washington Center, American one twenty three, say frequency."
    assert question.frequency_khz == KHZ
    assert [command.action for _, command, _ in world.done] == ["altitude"]
