"""Kinds of vehicles and wildlife: all that AIRHILT needs to know about one, in one object."""

from __future__ import annotations

import math
from typing import ClassVar, Literal, Protocol, TypeVar, runtime_checkable

from pydantic import BaseModel

from airhilt.commands import (
    BehindCommand,
    Command,
    ContactCommand,
    ContinueCommand,
    CrossCommand,
    EnterCommand,
    FollowCommand,
    GiveWayCommand,
    HoldPositionCommand,
    HoldShortCommand,
    MoveCommand,
    StandCommand,
    TaxiCommand,
    TaxiToCommand,
    TurnAtCommand,
    VacateCommand,
)
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.wgs84 import Place
from airhilt.messages import EmitterCategory, HoldPosition, Recommendation, VisibleClass
from airhilt.shapes.appearance import Appearance
from airhilt.shapes.lights import vehicle_lights
from airhilt.shapes.mesh import Mesh
from airhilt.shapes.sizes import Size
from airhilt.shapes.vehicles import van
from airhilt.units import FOOT
from airhilt.world.mover import Creature, Driven, Mover
from airhilt.world.site import ScenarioSite

Category = Literal["vehicle", "wildlife"]
VehiclePhase = Literal["standing", "driving", "stopping"]
M = TypeVar("M", bound=Mover)

BODY = "body"
"""Name of the mesh of a kind that has only one."""
REACH_M = 50_000.0
"""Greatest distance of a place to go to, in m."""


@runtime_checkable
class Kind(Protocol[M]):
    """One kind of vehicle or wildlife.

    The bodies of a ``vehicle`` are `Driven`, those of ``wildlife`` are a `Creature`. `DrivenKind`
    and `CreatureKind` have what most kinds of either have in common.
    """

    @property
    def name(self) -> str:
        """Name of its file or entry point."""

    @property
    def category(self) -> Category:
        """Sort of actor: one with a driver, or wildlife."""

    @property
    def dimensions(self) -> Size:
        """Size of one that stands on the ground."""

    @property
    def label(self) -> VisibleClass:
        """Class that truth and detectors give it in pictures, such as ``truck``."""

    @property
    def emitter_category(self) -> EmitterCategory:
        """ADS-B emitter category that its transponder sends."""

    @property
    def radar_cross_section_m2(self) -> float:
        """Radar cross section, in square metres."""

    @property
    def understands(self) -> tuple[type[BaseModel], ...]:
        """Classes of the commands that it can be given."""

    def appearance(self) -> Appearance:
        """Return its meshes and lights."""

    def mesh_of(self, body: M, t_s: float) -> str:
        """Return the name of the mesh that a body shows at a time in seconds."""

    def create(
        self,
        place: Place,
        heading_rad: float,
        *,
        ground_m: float,
        tick_s: float,
        seed: int = 0,
        height_m: float = 0.0,
    ) -> M:
        """Return a body of this kind.

        Parameters
        ----------
        place, heading_rad
            Place of its middle, and its true heading.
        ground_m
            Height of the ground above WGS84.
        tick_s
            Time by which it advances.
        seed
            Seed of all that is random in it.
        height_m
            Height of its lowest point above the ground.

        Raises
        ------
        ValueError
            It cannot begin like that.
        """

    def carry_out(self, body: M, command: Command, site: ScenarioSite) -> bool:
        """Make a body do what one of the commands says that it understands.

        Returns
        -------
        bool
            True if there was anything to do.

        Raises
        ------
        ValueError, ScenarioError
            It cannot be done; the message says why.
        """

    def command_for(self, recommendation: Recommendation) -> Command | None:
        """Return the command by which a driver follows a recommendation; None: it is ignored."""


class DrivenKind:
    """Common part of the kinds of vehicles: drivers, who keep to the airport's ways.

    The driver of any kind carries out the commands about ways, such as `TaxiToCommand`; a kind
    carries out what it understands besides. A driver follows the recommendation to hold position. A
    kind that says nothing else about its looks is a van.
    """

    category: ClassVar[Literal["vehicle"]] = "vehicle"
    understands: ClassVar[tuple[type[BaseModel], ...]] = (
        TaxiCommand,
        TaxiToCommand,
        HoldPositionCommand,
        ContinueCommand,
        HoldShortCommand,
        TurnAtCommand,
        CrossCommand,
        EnterCommand,
        VacateCommand,
        FollowCommand,
        GiveWayCommand,
        BehindCommand,
        ContactCommand,
    )
    dimensions: Size

    def appearance(self) -> Appearance:
        """Return a van of its size, with a beacon and headlamps."""
        return vehicle_appearance(van(self.dimensions), self.dimensions)

    def mesh_of(self, body: Driven, t_s: float) -> str:  # noqa: ARG002
        """Return the name of its only mesh."""
        return BODY

    def carry_out(self, body: Driven, command: Command, site: ScenarioSite) -> bool:  # noqa: ARG002
        """Raise ValueError: a driver moves the body along ways, and has no other commands."""
        raise ValueError(f"a driver does not {command.action.replace('_', ' ')}")

    def command_for(self, recommendation: Recommendation) -> Command | None:
        """Return the command to hold position, if that is recommended."""
        if isinstance(recommendation, HoldPosition):
            return HoldPositionCommand(action="hold_position")
        return None


class CreatureKind:
    """Common part of the kinds of wildlife: they move by their plan, and follow no advisories."""

    category: ClassVar[Literal["wildlife"]] = "wildlife"
    emitter_category: ClassVar[EmitterCategory] = "A0"
    understands: ClassVar[tuple[type[BaseModel], ...]] = (MoveCommand, StandCommand)

    def mesh_of(self, body: Creature, t_s: float) -> str:  # noqa: ARG002
        """Return the name of its only mesh."""
        return BODY

    def carry_out(self, body: Creature, command: Command, site: ScenarioSite) -> bool:
        """Move to a place, or stand; errors as of `Kind.carry_out`."""
        match command:
            case StandCommand():
                body.stand()
            case MoveCommand(gait="walk", to=to):
                body.walk_to(site.place(to))
            case MoveCommand(gait="run", to=to):
                body.run_to(site.place(to))
            case MoveCommand(to=to, height_ft=height):
                body.fly_to(site.place(to), height * FOOT)
            case _:
                raise ValueError(f"animals do not {command.action.replace('_', ' ')}")
        return True

    def command_for(self, recommendation: Recommendation) -> Command | None:  # noqa: ARG002
        """Return None: nobody talks to animals."""
        return None


def vehicle_appearance(mesh: Mesh, size: Size) -> Appearance:
    """Return the appearance of a vehicle of one mesh, with a beacon and headlamps."""
    return Appearance({BODY: mesh}, lambda t_s, _: vehicle_lights(size, t_s))


def within_reach(local_frame: LocalFrame, place: Place) -> tuple[float, float]:
    """Return east and north of a place to go to, from the origin of a local frame.

    Raises
    ------
    ValueError
        The place is farther away than `REACH_M`, or is none.
    """
    east, north = local_frame.to_local(place)
    if not math.hypot(east, north) <= REACH_M:
        raise ValueError(
            f"({math.degrees(place[0]):.4f}, {math.degrees(place[1]):.4f}) degrees is not "
            f"within {REACH_M / 1000.0:.0f} km"
        )
    return east, north
