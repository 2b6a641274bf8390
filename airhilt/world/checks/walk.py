"""Ways through a scenario: all models in it, and all commands, with their paths."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from airhilt.commands import Command
from airhilt.scenario.models import (
    CallsignConfused,
    ReadbackWrong,
    Scenario,
    WildlifeSpec,
)


def models_of(value: Any, path: str = "") -> Iterator[tuple[str, BaseModel]]:
    """Yield all models inside a value, with their paths."""
    if isinstance(value, BaseModel):
        yield path, value
        for name in type(value).model_fields:
            yield from models_of(getattr(value, name), f"{path}/{name}".strip("/"))
    elif isinstance(value, tuple):
        for index, entry in enumerate(value):
            yield from models_of(entry, f"{path}/{index}")


def commands_of(scenario: Scenario) -> Iterator[tuple[str, str, Command]]:
    """Yield the path, the callsign and the command of all that actors are told, in file order."""
    for index, actor in enumerate(scenario.actors):
        if not isinstance(actor, WildlifeSpec):
            for number, command in enumerate(actor.commands):
                yield f"actors/{index}/commands/{number}", actor.callsign, command
    for index, line in enumerate(scenario.radio.lines):
        for number, scripted in enumerate(line.commands):
            path = f"radio/lines/{index}/commands/{number}/command"
            yield path, scripted.actor, scripted.command
    for index, failure in enumerate(scenario.failures):
        if isinstance(failure, ReadbackWrong | CallsignConfused):
            for number, scripted in enumerate(failure.commands or ()):
                path = f"failures/{index}/commands/{number}/command"
                yield path, scripted.actor, scripted.command
