"""Checks of commands: whether their actor understands them at all."""

from __future__ import annotations

import typing
from collections.abc import Iterator

from pydantic import BaseModel

from airhilt.commands import AircraftCommand, Command
from airhilt.errors import AirhiltError
from airhilt.scenario.models import ActorSpec, AircraftSpec, Scenario, WildlifeSpec
from airhilt.scenario.problems import Problem
from airhilt.world.checks.walk import commands_of
from airhilt.world.surface.kinds import load_kind


def misdirected_commands(scenario: Scenario) -> Iterator[Problem]:
    """Yield commands that actors of this sort do not carry out."""
    actors = {actor.callsign: actor for actor in scenario.actors}
    for path, callsign, command in commands_of(scenario):
        actor = actors.get(callsign)
        if actor is None:
            continue  # Named elsewhere.
        if isinstance(actor, WildlifeSpec):
            yield _misdirected(
                path, command, "wildlife", "nothing: nobody tells an animal what to do"
            )
        else:
            yield from _not_understood(path, command, actor)
    for index, actor in enumerate(scenario.actors):
        if isinstance(actor, WildlifeSpec):
            for number, planned in enumerate(actor.plan):
                path = f"actors/{index}/plan/{number}/command"
                yield from _not_understood(path, planned.command, actor)


def _not_understood(path: str, command: Command, actor: ActorSpec) -> Iterator[Problem]:
    try:
        understood = _understood_by(actor)
    except AirhiltError:
        return  # Named elsewhere.
    if not isinstance(command, understood):
        known = ", ".join(
            str(typing.get_args(model.model_fields["action"].annotation)[0]) for model in understood
        )
        yield _misdirected(path, command, actor.type, known or "nothing")


def _misdirected(path: str, command: Command, sort: str, expected: str) -> Problem:
    return Problem(
        f"{path}/action", f"found {command.action!r}, which no {sort} does; expected {expected}"
    )


def _understood_by(actor: ActorSpec) -> tuple[type[BaseModel], ...]:
    if isinstance(actor, AircraftSpec):
        return typing.get_args(AircraftCommand)
    return load_kind(actor.kind, actor.type).understands
