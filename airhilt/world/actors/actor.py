"""What all that act in a scenario have in common, and what they need of the run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, Protocol

from airhilt.commands import Command
from airhilt.messages import Advisory, EmitterCategory
from airhilt.scenario.models import ActorSpec
from airhilt.world.mover import Mover

Category = Literal["aircraft", "vehicle", "wildlife"]


class Unable(Exception):
    """An actor cannot do what it was told, in the words in which it would say so."""


@dataclass(frozen=True, slots=True)
class Reaction:
    """What an actor will do about an advisory, and after how long."""

    delay_s: float
    act: Callable[[], bool]
    """Does it; tells whether there still was anything to do. Raises `Unable` for what an advisory
    has put off and cannot be done any more."""
    text: str


class Actor(Protocol):
    """An actor of the scenario with the body that it moves."""

    @property
    def spec(self) -> ActorSpec:
        """As the scenario declares it."""

    @property
    def category(self) -> Category:
        """What it is."""

    @property
    def body(self) -> Mover:
        """What moves."""

    @property
    def bound_runway(self) -> str | None:
        """The runway that it means to use, in the direction in which it will."""

    @property
    def emitter_category(self) -> EmitterCategory:
        """What its transponder says that it is."""

    def command(self, command: Command) -> None:
        """Do as told.

        Raises
        ------
        Unable
            It cannot.
        """

    def hear(self, advisory: Advisory) -> Reaction | None:
        """Return how it will react to an advisory, None if it will not."""

    def attend(self) -> None:
        """Look after what was begun: several times a second."""
