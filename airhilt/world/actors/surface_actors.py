"""Drivers of ground vehicles, and wildlife: actors whose kind says how they move."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Generic, Literal, TypeVar

from airhilt.commands import Command
from airhilt.errors import ScenarioError
from airhilt.geodesy.relative_motion import horizontal_distance_m
from airhilt.messages import Advisory, EmitterCategory, HoldPosition, Recommendation
from airhilt.scenario.models import VehicleSpec, WildlifeSpec
from airhilt.world.actors.actor import Actor, Reaction, Unable
from airhilt.world.actors.reactions import FOLLOWED_FROM, ReactionModel
from airhilt.world.mover import Creature, Driven
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.kind import Kind

B = TypeVar("B", Driven, Creature)


@dataclass(frozen=True)
class _SurfaceActor(Generic[B]):
    """An actor whose kind says how its body looks and moves."""

    kind: Kind[B]
    body: B
    site: ScenarioSite

    bound_runway = None
    """None: it uses a runway only to cross it or to work on it."""

    @property
    def emitter_category(self) -> EmitterCategory:
        """ADS-B emitter category that its transponder sends, or would send."""
        return self.kind.emitter_category

    def mesh(self, t_s: float) -> str:
        """Return the name of the mesh that it shows at a time in seconds."""
        return self.kind.mesh_of(self.body, t_s)


@dataclass(frozen=True)
class Driver(_SurfaceActor[Driven]):
    """A vehicle of the scenario with its driver, who does what drivers of its kind understand."""

    spec: VehicleSpec
    reactions: ReactionModel
    category: Literal["vehicle"] = "vehicle"

    def refusal(self, command: Command) -> str | None:
        """Return why the driver cannot carry out a command; None if its kind has such a command."""
        if isinstance(command, self.kind.understands):
            return None
        return f"unable, a driver does not {command.action.replace('_', ' ')}"

    def command(self, command: Command) -> None:
        """Carry out a command; raise `Unable` without a way, or if its kind has no such command."""
        why = self.refusal(command)
        if why is not None:
            raise Unable(why)
        self._carry_out(command)

    def _carry_out(self, command: Command) -> bool:
        try:
            return self.kind.carry_out(self.body, command, self.site)
        except ValueError as error:
            raise Unable(f"unable, {error}") from None
        except ScenarioError as error:
            raise Unable(str(error)) from None

    def hear(self, advisory: Advisory) -> Reaction | None:
        """Return the driver's reaction to an advisory; None if there is none."""
        recommendation = advisory.recommendation
        is_urgent = advisory.active and advisory.severity.rank >= FOLLOWED_FROM.rank
        if recommendation is None or not is_urgent:
            return None
        command = self.kind.command_for(recommendation)
        if command is None or not self.reactions.complies(advisory.id):
            return None
        holds = isinstance(recommendation, HoldPosition)
        does = "holds position" if holds else f"follows {recommendation.action}"
        delay_s = self.reactions.delay_s(advisory, again=False)
        return Reaction(delay_s, lambda: self._carry_out(command), does)

    def follows(self, recommendation: Recommendation) -> bool:
        """Return whether drivers of its kind have a command for such a recommendation."""
        return self.kind.command_for(recommendation) is not None

    def attend(self) -> None:
        """No-op: a driver has no delayed steps."""


@dataclass(frozen=True)
class Animal(_SurfaceActor[Creature]):
    """Animal or flock of the scenario: it follows its plan, and flees from what comes too near."""

    spec: WildlifeSpec
    others: Mapping[str, Actor]
    """All actors of the scenario, itself among them."""
    category: Literal["wildlife"] = "wildlife"

    def refusal(self, command: Command) -> str | None:
        """Return why an animal cannot carry out a command; None if animals do such a thing."""
        if isinstance(command, self.kind.understands):
            return None
        return f"animals do not {command.action.replace('_', ' ')}"

    def command(self, command: Command) -> None:
        """Move as the plan says; raise `Unable` if animals do not do that, or it is no place."""
        why = self.refusal(command)
        if why is not None:
            raise Unable(why)
        try:
            self.kind.carry_out(self.body, command, self.site)
        except (ValueError, ScenarioError) as error:
            raise Unable(str(error)) from None

    def hear(self, advisory: Advisory) -> Reaction | None:  # noqa: ARG002
        """Return None: animals get no advisories."""
        return None

    def follows(self, recommendation: Recommendation) -> bool:  # noqa: ARG002
        """Return False: animals follow no recommendation."""
        return False

    def attend(self) -> None:
        """Flee from a moving aircraft or vehicle that has come too near."""
        within_m = self.spec.startles_within_m
        if within_m <= 0.0 or self.body.startled:
            return
        own = self.body.state
        for other in self.others.values():
            state = other.body.state
            if other.category == "wildlife" or state.ground_speed_m_s < 1.0:
                continue
            if abs(state.altitude_m - own.altitude_m) > within_m:
                continue
            if horizontal_distance_m(own, state) < within_m:
                self.body.startle((state.latitude_rad, state.longitude_rad))
                return
