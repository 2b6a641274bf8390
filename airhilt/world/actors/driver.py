"""Driver of a ground vehicle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from airhilt.commands import Command
from airhilt.errors import ScenarioError
from airhilt.messages import Advisory, EmitterCategory, HoldPosition, Recommendation
from airhilt.scenario.models import VehicleSpec
from airhilt.world.actors.actor import Reaction, Unable
from airhilt.world.actors.reactions import FOLLOWED_FROM, ReactionModel
from airhilt.world.mover import Driven
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.kind import Kind


@dataclass(frozen=True)
class Driver:
    """A vehicle of the scenario with its driver, who does what drivers of its kind understand."""

    spec: VehicleSpec
    kind: Kind[Driven]
    body: Driven
    site: ScenarioSite
    reactions: ReactionModel
    category: Literal["vehicle"] = "vehicle"
    bound_runway: None = None
    """None: a vehicle uses a runway only to cross it or to work on it."""

    @property
    def emitter_category(self) -> EmitterCategory:
        """ADS-B emitter category that its transponder sends."""
        return self.kind.emitter_category

    def mesh(self, t_s: float) -> str:
        """Return the name of the mesh that it shows at a time in seconds."""
        return self.kind.mesh_of(self.body, t_s)

    def command(self, command: Command) -> None:
        """Carry out a command; raise `Unable` without a way, or if its kind has no such command."""
        if not isinstance(command, self.kind.understands):
            raise Unable(f"unable, a driver does not {command.action.replace('_', ' ')}")
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
