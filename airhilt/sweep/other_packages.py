"""Packages that add something to AIRHILT by entry points: their code decides results too."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import distributions
from importlib.util import find_spec
from pathlib import Path

from airhilt.host.files import sha256

GROUPS = "airhilt."
"""Beginning of the groups of entry points by which packages add something."""
OWN = "airhilt"
"""Name of AIRHILT's own distribution."""
PACKAGE_FILES = (".py", ".onnx", ".json", ".csv", ".txt", ".npz")
"""Endings of the files of a package that decide results: code, models and their data."""


@dataclass(frozen=True)
class OtherPackage:
    """An installed package that adds something, with the modules that its entry points name."""

    version: str
    modules: frozenset[str]


def other_packages() -> dict[str, OtherPackage]:
    """Return the packages that declare an entry point of AIRHILT's, by their names, sorted."""
    found: dict[str, OtherPackage] = {}
    for each in distributions():
        points = [point for point in each.entry_points if point.group.startswith(GROUPS)]
        if points and each.name != OWN and each.name not in found:  # The first is imported.
            modules = frozenset(point.module.partition(".")[0] for point in points)
            found[each.name] = OtherPackage(each.version, modules)
    return dict(sorted(found.items()))


def package_sha256(package: OtherPackage) -> str:
    """Return the SHA-256 of the files of a package; nothing of it is imported."""
    return files_sha256(
        found for module in sorted(package.modules) for found in _files_of_module(module)
    )


def files_sha256(files: Iterable[tuple[Path, Path]]) -> str:
    """Return the SHA-256 of files, each given after the folder to which its name is relative."""
    digest = hashlib.sha256()
    for root, path in files:
        digest.update(f"{path.relative_to(root).as_posix()}\0{sha256(path)}\n".encode())
    return digest.hexdigest()


def _files_of_module(module: str) -> Iterator[tuple[Path, Path]]:
    """Yield folder and path of the files of a module or package at the top level."""
    spec = None
    with suppress(ImportError, ValueError):  # What cannot be imported says so when it is asked for.
        spec = find_spec(module)
    if spec is None:
        return
    for place in spec.submodule_search_locations or ():
        folder = Path(place)
        for path in sorted(folder.rglob("*")):
            if path.suffix in PACKAGE_FILES and path.is_file():
                yield folder, path
    if spec.submodule_search_locations is None and spec.origin:
        yield Path(spec.origin).parent, Path(spec.origin)
