"""The driver of a ground vehicle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from airhilt.commands import Command, ContinueCommand, HoldPositionCommand, TaxiCommand
from airhilt.messages import Advisory, EmitterCategory, HoldPosition
from airhilt.scenario.models import VehicleSpec
from airhilt.units import KNOT
from airhilt.world.actors.actor import Reaction, Unable
from airhilt.world.actors.ground_paths import taxi_path
from airhilt.world.actors.reactions import FOLLOWED_FROM, ReactionModel
from airhilt.world.mover import Driven
from airhilt.world.site import ScenarioSite


@dataclass(frozen=True)
class Driver:
    """Drives as told, and stops when an advisory says so."""

    spec: VehicleSpec
    body: Driven
    site: ScenarioSite
    person: ReactionModel
    category: Literal["vehicle"] = "vehicle"
    bound_runway: None = None
    """A vehicle is on runways only to get across or to work there."""

    @property
    def emitter_category(self) -> EmitterCategory:
        """What its transponder says that it is."""
        return "C1" if "fire" in self.spec.kind else "C2"

    def command(self, command: Command) -> None:
        """Do as told.

        Raises
        ------
        Unable
            There is no way there, or it is nothing that a driver does.
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
        """Return how the driver will react to an advisory, None if it is nothing to act on."""
        if (
            not advisory.active
            or not isinstance(advisory.recommendation, HoldPosition)
            or advisory.severity.rank < FOLLOWED_FROM.rank
            or not self.person.complies(advisory.id)
        ):
            return None
        return Reaction(self.person.delay_s(advisory, again=False), self._stop, "holds position")

    def _stop(self) -> bool:
        if self.body.phase != "driving":
            return False
        self.body.stop()
        return True

    def attend(self) -> None:
        """Do nothing: a driver has no plans of its own."""
