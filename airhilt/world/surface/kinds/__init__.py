"""The kinds of vehicles and wildlife: one file a kind, each with its `KIND`.

A file in this package needs no registration. A kind outside of it is found by an entry point of
the group ``airhilt.kinds`` that names the object, such as ``drone = "my_package.drone:KIND"``.
Nothing is ever loaded because a scenario file says where it lies.
"""

from __future__ import annotations

from typing import Any, Literal, Protocol, TypeVar, overload, runtime_checkable

from airhilt.errors import ScenarioError
from airhilt.geodesy.wgs84 import Place
from airhilt.plugins import Family
from airhilt.shapes.sizes import Size
from airhilt.world.mover import Creature, Driven, Mover

Category = Literal["vehicle", "wildlife"]
M_co = TypeVar("M_co", bound=Mover, covariant=True)


@runtime_checkable
class Kind(Protocol[M_co]):
    """What a kind is: its name, and how one of it is made.

    The movers of a ``vehicle`` are `Driven`, those of ``wildlife`` are a `Creature`.
    """

    @property
    def name(self) -> str:
        """That of its file or entry point."""

    @property
    def category(self) -> Category:
        """Whether somebody drives it."""

    @property
    def dimensions(self) -> Size:
        """Of one that stands on the ground."""

    def create(
        self,
        place: Place,
        heading_rad: float,
        *,
        ground_m: float,
        tick_s: float,
        seed: int = 0,
        height_m: float = 0.0,
    ) -> M_co:
        """Return one at a place.

        Parameters
        ----------
        place, heading_rad
            Of its middle.
        ground_m
            Height of the ground above WGS84.
        tick_s
            By which it advances.
        seed
            Of all that is random in it.
        height_m
            Of its lowest point above the ground.

        Raises
        ------
        ValueError
            It cannot begin like that.
        """


FAMILY = Family("kind", "airhilt.kinds", __name__, "KIND", Kind, ScenarioError)


def kind_names() -> list[str]:
    """Return the names of all kinds that can be loaded, sorted."""
    return FAMILY.names()


@overload
def load_kind(name: str) -> Kind[Mover]: ...
@overload
def load_kind(name: str, category: Literal["vehicle"]) -> Kind[Driven]: ...
@overload
def load_kind(name: str, category: Literal["wildlife"]) -> Kind[Creature]: ...
def load_kind(name: str, category: Category | None = None) -> Kind[Mover]:
    """Return the kind of that name, such as ``follow_me``.

    Parameters
    ----------
    category
        That it must have, if given.

    Raises
    ------
    ScenarioError
        There is none, or more than one; it cannot be loaded, or is no kind; or it is one of
        the other category.
    """
    kind: Kind[Any] = FAMILY.load(name)
    if category is not None and kind.category != category:
        raise ScenarioError(f"{name!r} is a kind of {kind.category}; expected one of {category}")
    return kind
