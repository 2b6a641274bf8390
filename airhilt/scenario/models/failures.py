"""Failures of people and equipment in a scenario."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from airhilt.quantities import Count, Number, TimeS
from airhilt.scenario.models.base import MOST_COMMANDS, Callsign, Identifier, Model
from airhilt.scenario.models.conditions import Condition
from airhilt.scenario.models.radio import ScriptedCommand


class ReadbackWrong(Model):
    """A crew or driver reads back, and does, something else than the call told it."""

    type: Literal["readback_wrong"]
    line: Identifier = Field(description="the readback")
    text: str = Field(min_length=1, max_length=500, description="words that are said instead")
    commands: tuple[ScriptedCommand, ...] = Field(
        max_length=MOST_COMMANDS, description="commands that are carried out instead"
    )


class NotReceived(Model):
    """An actor does not hear a line."""

    type: Literal["not_received"]
    line: Identifier
    actor: Callsign


class CallsignConfused(Model):
    """The commands of a line for one actor are taken by another actor."""

    type: Literal["callsign_confused"]
    line: Identifier
    meant: Callsign
    taken_by: Callsign
    text: str | None = Field(
        default=None,
        min_length=1,
        max_length=500,
        description="words that are said instead, where they cause the confusion",
    )
    commands: tuple[ScriptedCommand, ...] | None = Field(
        default=None,
        max_length=MOST_COMMANDS,
        description="what taken_by does instead; null: the commands that were meant for the other",
    )


class Delayed(Model):
    """A line is said late."""

    type: Literal["delayed"]
    line: Identifier
    by_s: Number = Field(gt=0.0, le=600.0)


class Dropped(Model):
    """A line is never said."""

    type: Literal["dropped"]
    line: Identifier


class Ignored(Model):
    """An actor hears a line and does not do what it says."""

    type: Literal["ignored"]
    line: Identifier
    actor: Callsign


class Blocked(Model):
    """A line is said without listening first, over whatever is being said."""

    type: Literal["blocked"]
    line: Identifier


class StuckMicrophone(Model):
    """The transmitter of an actor stays on, on all its frequencies: nobody else is heard."""

    type: Literal["stuck_microphone"]
    actor: Callsign
    at_s: TimeS
    for_s: Number = Field(gt=0.0, le=3600.0)


class EngineFailure(Model):
    """An engine stops."""

    type: Literal["engine_failure"]
    actor: Callsign
    engine: Count = Field(ge=0, le=7, description="from the left, beginning with 0")
    when: Condition


Failure = Annotated[
    ReadbackWrong
    | NotReceived
    | CallsignConfused
    | Delayed
    | Dropped
    | Ignored
    | Blocked
    | StuckMicrophone
    | EngineFailure,
    Field(discriminator="type"),
]
