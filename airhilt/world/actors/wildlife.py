"""Wildlife: it follows its plan, and flees from what comes too near."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from airhilt.commands import Command, MoveCommand, StandCommand
from airhilt.errors import ScenarioError
from airhilt.geodesy.relative_motion import relative
from airhilt.geodesy.wgs84 import Place
from airhilt.messages import Advisory
from airhilt.scenario.models import WildlifeSpec
from airhilt.units import FOOT
from airhilt.world.actors.actor import Actor, Reaction, Unable
from airhilt.world.mover import Creature
from airhilt.world.site import ScenarioSite


@dataclass(frozen=True)
class Animal:
    """Animal or flock of the scenario."""

    spec: WildlifeSpec
    body: Creature
    site: ScenarioSite
    others: Mapping[str, Actor]
    """All actors of the scenario, itself among them."""
    category: Literal["wildlife"] = "wildlife"
    bound_runway: None = None
    emitter_category: Literal["A0"] = "A0"

    def command(self, command: Command) -> None:
        """Move as the plan says.

        Raises
        ------
        Unable
            Animals have no such command, or there is no such place.
        """
        match command:
            case StandCommand():
                self.body.stand()
            case MoveCommand(gait=gait, to=to, height_ft=height):
                try:
                    self._move(gait, self.site.place(to), height * FOOT)
                except (ValueError, ScenarioError) as error:
                    raise Unable(str(error)) from None
            case _:
                raise Unable(f"animals do not {command.action.replace('_', ' ')}")

    def _move(self, gait: Literal["walk", "run", "fly"], there: Place, height_m: float) -> None:
        match gait:
            case "walk":
                self.body.walk_to(there)
            case "run":
                self.body.run_to(there)
            case "fly":
                self.body.fly_to(there, height_m)

    def hear(self, advisory: Advisory) -> Reaction | None:  # noqa: ARG002
        """Return None: animals get no advisories."""
        return None

    def attend(self) -> None:
        """Flee from what has come too near and moves."""
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
            if relative(own, state).distance_m < within_m:
                self.body.startle((state.latitude_rad, state.longitude_rad))
                return
