"""A kind of another package whose failures name it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel

from airhilt.commands import Command
from airhilt.errors import AirhiltError, ScenarioError, failure_in, shown
from airhilt.geodesy.wgs84 import Place
from airhilt.messages import EmitterCategory, Recommendation, VisibleClass
from airhilt.plugins import missing
from airhilt.shapes.appearance import Appearance
from airhilt.shapes.sizes import Size
from airhilt.world.mover import Creature, Driven
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.kind import Category, Kind


@dataclass(frozen=True)
class GuardedKind:
    """A kind of another package: what its methods raise is an error that names kind and method.

    What a method may raise by the protocol passes as it is.
    """

    kind: Kind[Any]

    @property
    def name(self) -> str:
        """Name of its entry point."""
        return self.kind.name

    @property
    def category(self) -> Category:
        """Sort of actor."""
        return self.kind.category

    @property
    def dimensions(self) -> Size:
        """Size of one that stands on the ground."""
        return self.kind.dimensions

    @property
    def label(self) -> VisibleClass:
        """Class that truth and detectors give it in pictures."""
        return self.kind.label

    @property
    def emitter_category(self) -> EmitterCategory:
        """ADS-B emitter category that its transponder sends."""
        return self.kind.emitter_category

    @property
    def radar_cross_section_m2(self) -> float:
        """Radar cross section, in square metres."""
        return self.kind.radar_cross_section_m2

    @property
    def understands(self) -> tuple[type[BaseModel], ...]:
        """Classes of the commands that it can be given."""
        return self.kind.understands

    def appearance(self) -> Appearance:
        """Return its meshes and lights."""
        with self._guard("appearance"):
            look = self.kind.appearance()
        if not isinstance(look, Appearance):
            raise AirhiltError(
                f"kind {self.name!r}: appearance returned {shown(look)}; expected an Appearance "
                "(airhilt.shapes.appearance)"
            )
        return look

    def mesh_of(self, body: Any, t_s: float) -> str:
        """Return the name of the mesh that a body shows at a time in seconds."""
        with self._guard("mesh_of"):
            return self.kind.mesh_of(body, t_s)

    def create(
        self,
        place: Place,
        heading_rad: float,
        *,
        ground_m: float,
        tick_s: float,
        seed: int = 0,
        height_m: float = 0.0,
    ) -> Any:
        """Return a body of this kind.

        Raises
        ------
        ScenarioError
            It failed, or what it returned does not move.
        """
        with self._guard("create", ScenarioError, ValueError):
            body = self.kind.create(
                place,
                heading_rad,
                ground_m=ground_m,
                tick_s=tick_s,
                seed=seed,
                height_m=height_m,
            )
        product = Driven if self.category == "vehicle" else Creature
        if lacks := missing(body, product):
            raise ScenarioError(
                f"kind {self.name!r}: create returned {shown(body)}, which has no "
                f"{', '.join(lacks)}; expected a {product.__name__} (airhilt.world.mover)"
            )
        return body

    def carry_out(self, body: Any, command: Command, site: ScenarioSite) -> bool:
        """Make a body do what one of the commands says that it understands."""
        with self._guard("carry_out", AirhiltError, ValueError):
            return self.kind.carry_out(body, command, site)

    def command_for(self, recommendation: Recommendation) -> Command | None:
        """Return the command by which a driver follows a recommendation; None: it is ignored."""
        with self._guard("command_for"):
            return self.kind.command_for(recommendation)

    @contextmanager
    def _guard(
        self,
        method: str,
        error: type[AirhiltError] = AirhiltError,
        *declared: type[Exception],
    ) -> Iterator[None]:
        """Raise what a method raises as an error that names it, unless the protocol declares it."""
        passes: tuple[type[Exception], ...] = (AirhiltError, *declared)
        try:
            yield
        except passes:
            raise
        except Exception as cause:
            raise error(f"kind {self.name!r}: {method} failed: {failure_in(cause)}") from cause
