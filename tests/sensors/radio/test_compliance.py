"""An ordinary call is always obeyed; how an urgent one is, the response model says."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from airhilt.commands import TurnCommand
from airhilt.scenario.models import Channels, ResponseModel, Responses, ScriptedCommand
from airhilt.sensors.radio.compliance import COMPLY_AFTER_S, Compliance
from airhilt.sensors.radio.radio_call import RadioCall, Speakers
from conversations import CLEARANCE, KHZ, READBACK, World, radio_context

AT_ONCE = Channels(assistant=Responses(median_s=1.0, sigma=0.0))
NEVER = Channels(
    assistant=Responses(median_s=1.0, sigma=0.0),
    controller=Responses(median_s=3.0, sigma=0.0, no_response=1.0),
)
AFTER_3_S = Channels(
    assistant=Responses(median_s=1.0, sigma=0.0), controller=Responses(median_s=3.0, sigma=0.0)
)
TURN = TurnCommand(action="turn", degrees=30.0)


def done(crews: Channels, *, is_urgent: bool) -> list[tuple[Any, ...]]:
    """Return what a crew does after a call that it has taken."""
    world = World()
    model = ResponseModel(crews=crews, drivers=AT_ONCE, controllers=AT_ONCE.assistant)
    scenario = world.scenario.model_copy(update={"crews": model})
    seats = SimpleNamespace(has_person=lambda _actor: False)
    context = radio_context(
        director=world.director, world=world, seats=seats, scenario=scenario, seed=1
    )
    call = RadioCall("c-1", 119_100, "TWR", "AAL123", "", is_urgent=is_urgent)
    turns = 2 * (ScriptedCommand(actor="AAL123", command=TURN),)
    Compliance(context, cast(Speakers, None)).comply(call, "AAL123", turns)
    world.run()
    return cast(list[tuple[Any, ...]], world.done)


@pytest.mark.parametrize("crews", [AT_ONCE, NEVER, AFTER_3_S])
def test_an_ordinary_call_is_obeyed_whatever_the_response_model(crews: Channels) -> None:
    assert done(crews, is_urgent=False) == 2 * [("AAL123", TURN, COMPLY_AFTER_S)]


def test_an_urgent_call_is_obeyed_after_the_time_of_the_response_model() -> None:
    assert done(AFTER_3_S, is_urgent=True) == 2 * [("AAL123", TURN, 3.0)]


def test_who_does_not_respond_to_an_urgent_call_is_told_of_once() -> None:
    assert done(NEVER, is_urgent=True) == [("AAL123", "does not respond to turn (c-1)", 0.0)]


def test_a_crew_that_does_not_know_the_frequency_of_a_unit_asks_for_it_and_stays() -> None:
    contact = {"action": "contact", "unit": "Nowhere Ground"}
    commands = [*CLEARANCE["commands"], {"actor": "AAL123", "command": contact}]
    world = World({**CLEARANCE, "commands": commands}, READBACK).run_until(60.0)
    question = world.spoken("clearance.contact")
    assert question.text == "Washington Centre, American one twenty three, say frequency."
    assert question.frequency_khz == KHZ
    assert [command.action for _, command, _ in world.done] == ["altitude"]
