"""Drivers of ground vehicles, and wildlife: actors whose kind says how they move."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Generic, Literal, TypeVar

from airhilt.commands import (
    BehindCommand,
    Command,
    HoldPositionCommand,
    TaxiCommand,
    TaxiToCommand,
    WildlifeCommand,
)
from airhilt.errors import ScenarioError
from airhilt.geodesy.relative_motion import horizontal_distance_m
from airhilt.messages import Advisory, EmergencyState, EmitterCategory, HoldPosition, Recommendation
from airhilt.scenario.models import Channel, VehicleSpec, WildlifeSpec
from airhilt.world.actors.actor import Act, Actor, Reaction, Unable, refusal_by, saying_unable
from airhilt.world.actors.behind import BehindTraffic
from airhilt.world.actors.ground_bodies import DrivenVehicle
from airhilt.world.actors.ground_operations import GroundOperations
from airhilt.world.actors.reactions import FOLLOWED_FROM, ReactionModel
from airhilt.world.actors.traffic import Traffic
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
    squawk = None
    """None: it does not answer radars."""

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
    actors: Mapping[str, Actor]
    """All actors of the scenario by callsign, itself among them."""
    category: Literal["vehicle"] = "vehicle"

    @property
    def emergency(self) -> EmergencyState:
        """ADS-B emergency or priority status that its transponder sends."""
        return self.spec.transponder.emergency or "none"

    @cached_property
    def _traffic(self) -> Traffic:
        return Traffic(self.spec.callsign, self.actors)

    @cached_property
    def _ground(self) -> GroundOperations:
        return GroundOperations(DrivenVehicle(self.body), self.site, self._traffic)

    @cached_property
    def _behind(self) -> BehindTraffic:
        return BehindTraffic(self._traffic)

    def refusal(self, command: Command) -> str | None:
        """Return why the driver cannot carry out a command; None if the driver can."""
        return refusal_by(self._plan, command)

    def command(self, command: Command) -> None:
        """Carry out a command; raise `Unable` without a way, or if its kind has no such command."""
        self._carry_out(command)

    def _carry_out(self, command: Command) -> bool:
        """Carry out a command; return whether there was anything to do."""
        was_moving = self.body.phase == "driving"
        with saying_unable():
            act = self._plan(command)
            if act is None:
                return self.kind.carry_out(self.body, command, self.site)
            act()
        if isinstance(command, HoldPositionCommand | TaxiCommand | TaxiToCommand):
            self._behind.forget()
        return was_moving or self.body.phase == "driving"

    def _plan(self, command: Command) -> Act | None:
        """Return what carries out a command on the airport; None for one of its kind alone."""
        if not isinstance(command, self.kind.understands):
            aircraft = not isinstance(command, WildlifeCommand)
            raise Unable(
                "unable, this is a vehicle"
                if aircraft
                else f"unable, a driver does not {command.action.replace('_', ' ')}"
            )
        if isinstance(command, BehindCommand):
            self._plan(command.command)
            return self._behind.plan(command)
        return self._ground.plan(command)

    def hear(self, advisory: Advisory, channel: Channel = "assistant") -> Reaction | None:
        """Return the driver's reaction to an advisory; None if it asks for none."""
        recommendation = advisory.recommendation
        is_urgent = advisory.active and advisory.severity.rank >= FOLLOWED_FROM.rank
        if recommendation is None or not is_urgent:
            return None
        command = self.kind.command_for(recommendation)
        if command is None:
            return None
        response = self.reactions.respond(channel, advisory.id, revision=advisory.revision)
        if not response.follows:
            return Reaction.none(recommendation.action)
        holds = isinstance(recommendation, HoldPosition)
        does = "holds position" if holds else f"follows {recommendation.action}"
        return Reaction(
            response.delay_s, lambda: self._carry_out(command), f"{does}{response.manner}"
        )

    def follows(self, recommendation: Recommendation) -> bool:
        """Return whether drivers of its kind have a command for such a recommendation."""
        return self.kind.command_for(recommendation) is not None

    def attend(self) -> None:
        """Take the next step that is due, or raise `Unable`."""
        with saying_unable():
            if (command := self._behind.due()) is not None:
                self._carry_out(command)
            self._ground.attend()


@dataclass(frozen=True)
class Animal(_SurfaceActor[Creature]):
    """Animal or flock of the scenario: it follows its plan, and flees from what comes too near."""

    spec: WildlifeSpec
    others: Mapping[str, Actor]
    """All actors of the scenario, itself among them."""
    category: Literal["wildlife"] = "wildlife"
    emergency: Literal["none"] = "none"
    """It has no transponder."""

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

    def hear(self, advisory: Advisory, channel: Channel = "assistant") -> Reaction | None:  # noqa: ARG002
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
                self.body.startle(state.place)
                return
