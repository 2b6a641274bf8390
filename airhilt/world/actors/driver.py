"""Driver of a ground vehicle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from airhilt.commands import Command, ContinueCommand, HoldPositionCommand, TaxiCommand
from airhilt.messages import Advisory, EmitterCategory, HoldPosition
from airhilt.scenario.models import VehicleSpec
from airhilt.units import KNOT
from airhilt.world.actors.actor import Reaction, Unable
from airhilt.world.actors.reactions import FOLLOWED_FROM, ReactionModel
from airhilt.world.actors.taxi_paths import taxi_path
from airhilt.world.mover import Driven
from airhilt.world.site import ScenarioSite


@dataclass(frozen=True)
class Driver:
    """Carries out commands, and stops when an advisory says so."""

    spec: VehicleSpec
    body: Driven
    site: ScenarioSite
    reactions: ReactionModel
    category: Literal["vehicle"] = "vehicle"
    bound_runway: None = None
    """None: a vehicle uses a runway only to cross it or to work on it."""

    @property
    def emitter_category(self) -> EmitterCategory:
        """ADS-B emitter category that its transponder sends."""
        return "C1" if "fire" in self.spec.kind else "C2"

    def command(self, command: Command) -> None:
        """Carry out a command.

        Raises
        ------
        Unable
            There is no way there, or drivers have no such command.
        """
        try:
            self._carry_out(command)
        except ValueError as error:
            raise Unable(f"unable, {error}") from None

    def _carry_out(self, command: Command) -> None:
        match command:
            case TaxiCommand(speed_kt=speed):
                state = self.body.state
                here = (state.latitude_rad, state.longitude_rad)
                nose_m = self.body.dimensions.length_m / 2.0
                path = taxi_path(self.site, here, command, nose_m)
                self.body.drive(path, None if speed is None else speed * KNOT)
            case HoldPositionCommand():
                self.body.stop()
            case ContinueCommand():
                self.body.resume()
            case _:
                raise Unable(f"unable, a driver does not {command.action.replace('_', ' ')}")

    def hear(self, advisory: Advisory) -> Reaction | None:
        """Return the driver's reaction to an advisory; None if there is none."""
        if (
            not advisory.active
            or not isinstance(advisory.recommendation, HoldPosition)
            or advisory.severity.rank < FOLLOWED_FROM.rank
            or not self.reactions.complies(advisory.id)
        ):
            return None
        return Reaction(self.reactions.delay_s(advisory, again=False), self._stop, "holds position")

    def _stop(self) -> bool:
        if self.body.phase != "driving":
            return False
        self.body.stop()
        return True

    def attend(self) -> None:
        """Do nothing: nothing of a driver waits for its moment."""
