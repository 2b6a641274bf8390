"""A kind of another package whose failures name it."""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import Any

from pydantic import BaseModel

from airhilt.commands import Command
from airhilt.errors import AirhiltError, ScenarioError, blaming, shown
from airhilt.geodesy.wgs84 import Place
from airhilt.messages import EmitterCategory, Recommendation, VisibleClass
from airhilt.plugins import missing
from airhilt.shapes.appearance import Appearance
from airhilt.shapes.sizes import Size
from airhilt.world.mover import Creature, Driven
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.kind import Category, Kind


class GuardedKind:
    """A kind of another package: what its methods raise is an error that names kind and method.

    Exceptions that the protocol declares pass unchanged.
    """

    def __init__(self, kind: Kind[Any]) -> None:
        self._kind = kind
        self.name = kind.name
        self.category: Category = kind.category
        self.dimensions: Size = kind.dimensions
        self.label: VisibleClass = kind.label
        self.emitter_category: EmitterCategory = kind.emitter_category
        self.radar_cross_section_m2 = kind.radar_cross_section_m2
        self.understands: tuple[type[BaseModel], ...] = kind.understands

    def appearance(self) -> Appearance:
        """Return its meshes and lights."""
        with self._blaming("appearance"):
            look = self._kind.appearance()
        if not isinstance(look, Appearance):
            raise AirhiltError(
                f"kind {self.name!r}: appearance returned {shown(look)}; expected an Appearance "
                "(airhilt.shapes.appearance)"
            )
        return look

    def mesh_of(self, body: Any, t_s: float) -> str:
        """Return the name of the mesh that a body shows at a time in seconds."""
        with self._blaming("mesh_of"):
            return self._kind.mesh_of(body, t_s)

    def create(self, place: Place, heading_rad: float, **start: Any) -> Any:
        """Return a body of this kind.

        Raises
        ------
        ScenarioError
            The kind failed, or what it returned does not move.
        """
        with self._blaming("create", ScenarioError, ValueError):
            body = self._kind.create(place, heading_rad, **start)
        product = Driven if self.category == "vehicle" else Creature
        if lacks := missing(body, product):
            raise ScenarioError(
                f"kind {self.name!r}: create returned {shown(body)}, which has no "
                f"{', '.join(lacks)}; expected a {product.__name__} (airhilt.world.mover)"
            )
        return body

    def carry_out(self, body: Any, command: Command, site: ScenarioSite) -> bool:
        """Make a body do what one of the commands says that it understands."""
        with self._blaming("carry_out", AirhiltError, ValueError):
            return self._kind.carry_out(body, command, site)

    def command_for(self, recommendation: Recommendation) -> Command | None:
        """Return the command by which a driver follows a recommendation; None: it is ignored."""
        with self._blaming("command_for"):
            return self._kind.command_for(recommendation)

    def _blaming(
        self, method: str, error: type[AirhiltError] = AirhiltError, *declared: type[Exception]
    ) -> AbstractContextManager[None]:
        return blaming(f"kind {self.name!r}: {method} failed", error, *declared)
