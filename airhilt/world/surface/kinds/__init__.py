"""The kinds of vehicles and wildlife: one file a kind, each with its `KIND`.

A file in this package needs no registration. A kind outside of it is found by an entry point of
the group ``airhilt.kinds`` that names the object, such as ``drone = "my_package.drone:KIND"``.
A scenario file cannot make AIRHILT load code from a path.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal, overload

from airhilt.errors import ScenarioError
from airhilt.messages import VisibleClass
from airhilt.plugins import Family
from airhilt.world.mover import Creature, Driven
from airhilt.world.surface.guarded_kind import GuardedKind
from airhilt.world.surface.kind import Category, Kind

FAMILY = Family("kind", "airhilt.kinds", __name__, "KIND", Kind, ScenarioError)


@overload
def load_kind(name: str) -> Kind[Any]: ...
@overload
def load_kind(name: str, category: Literal["vehicle"]) -> Kind[Driven]: ...
@overload
def load_kind(name: str, category: Literal["wildlife"]) -> Kind[Creature]: ...
def load_kind(name: str, category: Category | None = None) -> Kind[Any]:
    """Return the kind of that name, such as ``follow_me``; one of another package is guarded.

    Parameters
    ----------
    category
        The category that it must have, if given.

    Raises
    ------
    ScenarioError
        There is none, or more than one; it cannot be loaded, or is no kind; or it is one of
        the other category.
    """
    kind: Kind[Any] = FAMILY.load(name)
    if category is not None and kind.category != category:
        raise ScenarioError(f"{name!r} is a kind of {kind.category}; expected one of {category}")
    return kind if FAMILY.is_own(name) else GuardedKind(kind)


def animal_labels(more: Iterable[str] = ()) -> tuple[VisibleClass, ...]:
    """Return the labels that animals have in pictures, sorted.

    Parameters
    ----------
    more
        Names of kinds of wildlife besides those of AIRHILT.

    Raises
    ------
    ScenarioError
        One of them is not there, or is a kind of vehicle.
    """
    own: list[Kind[Any]] = [point.load() for point in FAMILY.own()]
    labels = {kind.label for kind in own if kind.category == "wildlife"}
    return tuple(sorted(labels | {load_kind(name, "wildlife").label for name in more}))
