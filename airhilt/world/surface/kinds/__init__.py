"""The kinds of vehicles and wildlife: one file a kind, each with its `KIND`.

A file in this package needs no registration. A kind outside of it is found by an entry point of
the group ``airhilt.kinds`` that names the object, such as ``drone = "my_package.drone:KIND"``.
A scenario file cannot make AIRHILT load code from a path.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import Any, Literal, cast, overload

from airhilt.errors import AirhiltError, ScenarioError, blaming, shown
from airhilt.messages import VisibleClass
from airhilt.plugins import Family, missing
from airhilt.shapes.appearance import Appearance
from airhilt.world.mover import Creature, Driven
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

    Raises
    ------
    ScenarioError
        There is none, or more than one; it cannot be loaded, or is no kind; or it is one of
        the other category.
    """
    kind: Kind[Any] = FAMILY.load(name)
    if category is not None and kind.category != category:
        raise ScenarioError(f"{name!r} is a kind of {kind.category}; expected one of {category}")
    return kind if FAMILY.is_own(name) else cast(Kind[Any], _GuardedKind(kind))


def animal_labels(more: Iterable[str] = ()) -> tuple[VisibleClass, ...]:
    """Return the labels that animals have in pictures, sorted.

    ``more`` has the names of kinds of wildlife besides those of AIRHILT.

    Raises
    ------
    ScenarioError
        One of them is not there, or is a kind of vehicle.
    """
    own: list[Kind[Any]] = [point.load() for point in FAMILY.own()]
    labels = {kind.label for kind in own if kind.category == "wildlife"}
    return tuple(sorted(labels | {load_kind(name, "wildlife").label for name in more}))


class _GuardedKind:
    """A kind of another package: what its methods raise is an error that names kind and method.

    Exceptions that the protocol declares pass unchanged.
    """

    def __init__(self, kind: Kind[Any]) -> None:
        self._kind = kind

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._kind, name)
        return partial(self._call, name) if callable(value) else value

    def _call(self, method: str, *given: Any, **named: Any) -> Any:
        error = ScenarioError if method == "create" else AirhiltError
        declared = [ValueError] if method in ("create", "carry_out") else []
        with blaming(f"kind {self.name!r}: {method} failed", error, *declared):
            returned = getattr(self._kind, method)(*given, **named)
        what = f"kind {self.name!r}: {method} returned {shown(returned)}"
        product = Driven if self.category == "vehicle" else Creature
        if method == "create" and (lacks := missing(returned, product)):
            raise ScenarioError(
                f"{what}, which has no {', '.join(lacks)}; expected a {product.__name__} "
                "(airhilt.world.mover)"
            )
        if method == "appearance" and not isinstance(returned, Appearance):
            raise AirhiltError(f"{what}; expected an Appearance (airhilt.shapes.appearance)")
        return returned
