"""Protocol of the actors of a scenario."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Literal, Protocol

from airhilt.commands import Command
from airhilt.errors import ScenarioError
from airhilt.messages import Advisory, EmergencyState, EmitterCategory, Recommendation
from airhilt.scenario.models import ActorSpec, Channel
from airhilt.world.mover import Mover

Category = Literal["aircraft", "vehicle", "wildlife"]
Act = Callable[[], None]
"""Action of a command, once it is known that it can be done."""


class Unable(Exception):
    """An actor cannot carry out a command; the text is what it would say on the radio."""


@contextmanager
def saying_unable() -> Iterator[None]:
    """Raise `Unable` for whatever cannot be done."""
    try:
        yield
    except (ValueError, ScenarioError) as error:
        raise Unable(f"unable, {error}") from None


def refusal_by(plan: Callable[[Command], object], command: Command) -> str | None:
    """Return why a command cannot be planned; None if it can."""
    try:
        with saying_unable():
            plan(command)
    except Unable as unable:
        return str(unable)
    return None


def do_nothing() -> None:
    """Do what is done already."""


@dataclass(frozen=True, slots=True)
class Reaction:
    """Action of an actor after an advisory, and the delay of that action."""

    delay_s: float
    act: Callable[[], bool]
    """Carries out the action; returns False if there was nothing left to do. Raises `Unable` for a
    deferred command that cannot be carried out any more."""
    text: str
    responds: bool = True
    """False: the actor does nothing, as its response model says."""
    tells: Callable[[], str] = str
    """Returns what the actor tells its unit that does it now; empty: nothing."""

    @classmethod
    def none(cls, to: str) -> Reaction:
        """Return the reaction of an actor that does not respond to something."""
        return cls(0.0, lambda: False, f"does not respond to {to}", responds=False)


class Actor(Protocol):
    """Actor of the scenario, with the body that it moves."""

    @property
    def spec(self) -> ActorSpec:
        """Declaration of the actor in the scenario."""

    @property
    def category(self) -> Category:
        """Sort of the actor."""

    @property
    def body(self) -> Mover:
        """Aircraft, vehicle or animal that moves."""

    @property
    def bound_runway(self) -> str | None:
        """Runway that it is going to use, in the direction of use."""

    @property
    def emitter_category(self) -> EmitterCategory:
        """ADS-B emitter category that its transponder sends."""

    @property
    def squawk(self) -> str | None:
        """Mode A code that its transponder sends now; None without one that answers radars."""

    @property
    def emergency(self) -> EmergencyState:
        """ADS-B emergency or priority status that its transponder sends now."""

    def mesh(self, t_s: float) -> str:
        """Return the name of the mesh that it shows at a time in seconds."""

    def refusal(self, command: Command) -> str | None:
        """Return why the actor cannot carry out a command now, as it would say; None if it can.

        It changes nothing. What it does not foresee, `command` still raises.
        """

    def command(self, command: Command) -> None:
        """Carry out a command; raise `Unable` if the actor cannot."""

    def hear(self, advisory: Advisory, channel: Channel = "assistant") -> Reaction | None:
        """Return the reaction to an advisory that comes on a channel; None if it asks for none."""

    def follows(self, recommendation: Recommendation) -> bool:
        """Return whether the actor follows recommendations of this kind in any situation."""

    def attend(self) -> None:
        """Take the next step that is due; called several times a second."""
