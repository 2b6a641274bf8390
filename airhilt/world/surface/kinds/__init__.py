"""The kinds of vehicles and wildlife: one file a kind, each with its `KIND`.

A file in this package needs no registration. A kind outside of it is found by an entry point of
the group ``airhilt.kinds`` that names the object, such as ``drone = "my_package.drone:KIND"``.
Nothing is ever loaded because a scenario file says where it lies.
"""

from __future__ import annotations

import pkgutil
from importlib.metadata import EntryPoint, entry_points
from typing import Any, Literal, Protocol, TypeVar, overload, runtime_checkable

from airhilt.errors import ScenarioError
from airhilt.library import nearest
from airhilt.world.mover import Creature, Driven, Mover, Size
from airhilt.world.surface.runway import Place

ENTRY_POINT_GROUP = "airhilt.kinds"

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


def kind_names() -> list[str]:
    """Return the names of all kinds that can be loaded, sorted."""
    return sorted({point.name for point in _points()})


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
    found = [point for point in _points() if point.name == name]
    if not found:
        raise ScenarioError(f"no kind named {name!r}{nearest(name, kind_names())}")
    if len(found) > 1:
        where = ", ".join(point.value for point in found)
        raise ScenarioError(f"there is more than one kind named {name!r}: {where}")
    kind = _load(found[0])
    if category is not None and kind.category != category:
        raise ScenarioError(f"{name!r} is a kind of {kind.category}; expected one of {category}")
    return kind


def _points() -> list[EntryPoint]:
    """Return where kinds are: the files of this package, and the entry points of others."""
    files = (found.name for found in pkgutil.iter_modules(__path__))
    return [
        *(EntryPoint(name, f"{__name__}.{name}:KIND", ENTRY_POINT_GROUP) for name in files),
        *entry_points(group=ENTRY_POINT_GROUP),
    ]


def _load(point: EntryPoint) -> Kind[Any]:
    try:
        kind = point.load()
    except Exception as error:
        raise ScenarioError(
            f"kind {point.name!r} cannot be loaded from {point.value}: "
            f"{type(error).__name__}: {error}"
        ) from error
    if not isinstance(kind, Kind) or kind.name != point.name:
        raise ScenarioError(f"{point.value} is no kind named {point.name!r}: {kind!r}")
    return kind
