"""Wildlife: it follows its plan, and flees from what comes too near."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from airhilt.commands import Command
from airhilt.errors import ScenarioError
from airhilt.geodesy.relative_motion import horizontal_distance_m
from airhilt.messages import Advisory, EmitterCategory, Recommendation
from airhilt.scenario.models import WildlifeSpec
from airhilt.world.actors.actor import Actor, Reaction, Unable
from airhilt.world.mover import Creature
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.kind import Kind


@dataclass(frozen=True)
class Animal:
    """Animal or flock of the scenario."""

    spec: WildlifeSpec
    kind: Kind[Creature]
    body: Creature
    site: ScenarioSite
    others: Mapping[str, Actor]
    """All actors of the scenario, itself among them."""
    category: Literal["wildlife"] = "wildlife"
    bound_runway: None = None

    @property
    def emitter_category(self) -> EmitterCategory:
        """ADS-B emitter category that a transponder on it would send."""
        return self.kind.emitter_category

    def mesh(self, t_s: float) -> str:
        """Return the name of the mesh that it shows at a time in seconds."""
        return self.kind.mesh_of(self.body, t_s)

    def command(self, command: Command) -> None:
        """Move as the plan says; raise `Unable` if animals do not do that, or it is no place."""
        if not isinstance(command, self.kind.understands):
            raise Unable(f"animals do not {command.action.replace('_', ' ')}")
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
