"""An aircraft of the scenario, with its crew."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from airhilt.commands import Command
from airhilt.messages import Advisory, EmitterCategory, Recommendation
from airhilt.scenario.models import AircraftSpec
from airhilt.world.actors.actor import Reaction
from airhilt.world.actors.crew import Crew
from airhilt.world.flight.aircraft import Aircraft

GEAR_DOWN_BELOW_M = 600.0
"""Height above the ground below which the gear is down, in m: on a glide path of 3 degrees, that is
11 km before the threshold."""
EMITTER_CATEGORIES: dict[str, EmitterCategory] = {
    "jet": "A3",
    "heavy_jet": "A5",
    "piston_single": "A1",
    "piston_twin": "A1",
}


def mesh_at(height_agl_m: float) -> str:
    """Return the name of the mesh that an aircraft shows at a height above the ground, in m."""
    return "gear" if height_agl_m < GEAR_DOWN_BELOW_M else "clean"


@dataclass(frozen=True)
class Flight:
    """One aircraft of the scenario, with its crew."""

    spec: AircraftSpec
    body: Aircraft
    crew: Crew
    category: Literal["aircraft"] = "aircraft"

    @property
    def bound_runway(self) -> str | None:
        """Runway that the crew is going to use."""
        return self.crew.runway_operations.bound_runway

    @property
    def emitter_category(self) -> EmitterCategory:
        """ADS-B emitter category that its transponder sends."""
        return EMITTER_CATEGORIES[self.body.kind.category]

    def mesh(self, t_s: float) -> str:  # noqa: ARG002
        """Return the name of its mesh: with the gear down near the ground, or clean."""
        return mesh_at(self.body.state.height_agl_m)

    def command(self, command: Command) -> None:
        """Give a command to the crew.

        Raises
        ------
        Unable
            The crew cannot carry it out.
        """
        self.crew.command(command)

    def hear(self, advisory: Advisory) -> Reaction | None:
        """Return the crew's reaction to an advisory; None if there is none."""
        return self.crew.hear(advisory)

    def follows(self, recommendation: Recommendation) -> bool:  # noqa: ARG002
        """Return True: a crew follows every kind of recommendation."""
        return True

    def attend(self) -> None:
        """Let the crew go on with what waits for its moment."""
        self.crew.attend()
