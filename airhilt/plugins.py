"""Members of AIRHILT that come one file each, its own and those of other packages.

A family of members (kinds, engines, sensors, commands ...) has a package, in which every module is
a member, and an entry point group, by which other installed packages add theirs. Both give a name
and an object: the module's attribute, or the object that the entry point names. Nothing is loaded
until somebody asks for it, and nothing because a scenario file says where it lies.
"""

from __future__ import annotations

import pkgutil
import sys
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from importlib.metadata import EntryPoint, EntryPoints, entry_points
from inspect import get_annotations
from pathlib import Path
from typing import Any

from airhilt.errors import AirhiltError
from airhilt.host.library import nearest

States = tuple[tuple[str, int], ...]
"""Folders, each with the time at which it changed."""


@dataclass(frozen=True)
class Family:
    """Members that do the same job.

    Attributes
    ----------
    word
        A member in words, for errors, such as ``kind``.
    group
        Entry point group of members in other packages, such as ``airhilt.kinds``.
    package
        Package whose modules are members; modules that begin with ``_`` or are in ``not_members``
        are not.
    attribute
        Name of the object in each of these modules, such as ``KIND``.
    protocol
        Type of each member; a member with a ``name`` goes by that name alone.
    error
        Raised for a member that does not exist or cannot be loaded.
    """

    word: str
    group: str
    package: str
    attribute: str
    protocol: type[Any] = object
    error: Callable[[str], AirhiltError] = AirhiltError
    not_members: frozenset[str] = frozenset()

    def own(self) -> list[EntryPoint]:
        """Return where the members of AIRHILT are."""
        return [
            EntryPoint(name, f"{self.package}.{name}:{self.attribute}", self.group)
            for name in _modules(_states(import_module(self.package).__path__))
            if not name.startswith("_") and name not in self.not_members
        ]

    def is_own(self, name: str) -> bool:
        """Return whether AIRHILT has a member of that name."""
        return any(point.name == name for point in self.own())

    def names(self) -> list[str]:
        """Return the names of all members, in AIRHILT and in every installed package, sorted."""
        return sorted({point.name for point in self._points()})

    def load(self, name: str) -> Any:
        """Return the object of a member.

        Raises
        ------
        AirhiltError
            There is none of that name, or more than one, or it cannot be loaded. It is of the
            class that the family declares.
        """
        found = [point for point in self._points() if point.name == name]
        if not found:
            raise self.error(f"no {self.word} named {name!r}{nearest(name, self.names())}")
        if len(found) > 1:
            where = ", ".join(point.value for point in found)
            raise self.error(f"there is more than one {self.word} named {name!r}: {where}")
        try:
            member = found[0].load()
            fits = isinstance(member, self.protocol) and getattr(member, "name", name) == name
        except AirhiltError as error:  # It says itself what it lacks.
            raise self.error(str(error)) from error
        except (Exception, SystemExit) as error:  # A script without a guard ends when imported.
            raise self.error(
                f"{self.word} {name!r} cannot be loaded from {found[0].value}: "
                f"{type(error).__name__}: {error}"
            ) from error
        if not fits:
            lacks = ", ".join(missing(member, self.protocol))
            raise self.error(
                f"{found[0].value} is no {self.word} named {name!r}: {member!r}"
                + (f" has no {lacks}" if lacks else "")
            )
        return member

    def origin(self, name: str) -> str:
        """Return name and version of the other package that has a member; empty for AIRHILT's."""
        if self.is_own(name):
            return ""
        found = [point.dist for point in _declared(self.group) if point.name == name and point.dist]
        return f"{found[0].name} {found[0].version}" if found else ""

    def _points(self) -> list[EntryPoint]:
        return [*self.own(), *_declared(self.group)]


@lru_cache
def _modules(folders: States) -> tuple[str, ...]:
    """Return the names of the modules in the folders of a package."""
    return tuple(found.name for found in pkgutil.iter_modules([folder for folder, _ in folders]))


def _declared(group: str) -> EntryPoints:
    """Return the entry points of a group that installed packages declare.

    The metadata of all packages are read once, which takes 7 ms of CPU, and again when one of the
    folders in which packages are installed has changed: a package comes and goes with a folder
    of metadata.
    """
    return _read(group, _states(sys.path))


@lru_cache
def _read(group: str, folders: States) -> EntryPoints:
    return _selection(folders)(group=group)


@lru_cache(maxsize=1)
def _selection(_folders: States) -> Callable[..., EntryPoints]:
    """Return what selects among the entry points of all groups."""
    return entry_points().select


def _states(folders: Iterable[str]) -> States:
    return tuple((folder, _changed_ns(folder)) for folder in folders)


def _changed_ns(folder: str) -> int:
    with suppress(OSError):
        return Path(folder).stat().st_mtime_ns
    return 0


def missing(thing: object, protocol: type[Any]) -> list[str]:
    """Return the public members of a protocol, and of those that it extends, that a thing lacks."""
    parts = [each for each in protocol.__mro__[1:] if getattr(each, "_is_protocol", False)]
    every = (name for part in (protocol, *parts) for name in (*vars(part), *_annotated(part)))
    names = dict.fromkeys(every)
    return [name for name in names if not name.startswith("_") and not hasattr(thing, name)]


def _annotated(part: type[Any]) -> tuple[str, ...]:
    return tuple(get_annotations(part)) if getattr(part, "_is_protocol", False) else ()
