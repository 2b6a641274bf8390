"""Checks of commands: whether their actor can carry them out at all."""

from __future__ import annotations

import typing
from collections.abc import Iterator

from airhilt.commands import AircraftCommand, VehicleCommand
from airhilt.scenario.models import Scenario
from airhilt.scenario.problems import Problem
from airhilt.world.checks.walk import commands_of


def misdirected_commands(scenario: Scenario) -> Iterator[Problem]:
    """Yield commands that actors of this sort do not carry out."""
    fitting = {
        "aircraft": typing.get_args(AircraftCommand),
        "vehicle": typing.get_args(VehicleCommand),
        "wildlife": (),
    }
    kinds = {actor.callsign: actor.type for actor in scenario.actors}
    for path, callsign, command in commands_of(scenario):
        kind = kinds.get(callsign)
        if kind is not None and not isinstance(command, fitting[kind]):
            known = ", ".join(
                str(typing.get_args(model.model_fields["action"].annotation)[0])
                for model in fitting[kind]
            )
            yield Problem(
                f"{path}/action",
                f"found {command.action!r}, which no {kind} does; expected "
                f"{known or 'nothing: nobody tells an animal what to do'}",
            )
