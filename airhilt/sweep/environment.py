"""Software that runs a run: with scenario and options it decides the results."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from contextlib import suppress
from importlib.metadata import distributions
from importlib.util import find_spec
from pathlib import Path

from pydantic import BaseModel, ConfigDict

from airhilt.errors import AirhiltError
from airhilt.host import library
from airhilt.host.files import sha256
from airhilt.record.folder import versions

NOT_RESULTS = ("cli", "library", "report", "sweep")
"""Parts of the package that decide no results, and its copy of `LIBRARY`."""
LIBRARY = ("aircraft", "airports")
"""Kinds of files that scenarios refer to by name."""
GROUPS = "airhilt."
"""Beginning of the groups of entry points by which packages add something."""
OWN = "airhilt"
"""Name of AIRHILT's own distribution."""
PACKAGE_FILES = (".py", ".onnx", ".json", ".csv", ".txt", ".npz")
"""Endings of the files of a package that decide results: code, models and their data."""


class Environment(BaseModel):
    """Software of one process; runs of one sweep have the same."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    versions: dict[str, str]
    """Versions of AIRHILT, Python, and the packages that decide results."""
    code_sha256: str
    """SHA-256 of AIRHILT's code and models, and of its aircraft and airports."""
    renderer: str
    """Renderer that draws; empty without cameras."""
    packages: dict[str, str] = {}
    """Versions of the other packages that add something to AIRHILT, by their names."""
    packages_sha256: dict[str, str] = {}
    """SHA-256 of their code and data, by their names."""


def environment(renderer: str) -> Environment:
    """Return the environment of this process.

    Parameters
    ----------
    renderer
        Renderer that the runs ask for, ``auto`` included; empty without cameras.

    Raises
    ------
    RendererError
        It cannot draw here.
    """
    taken = ""
    if renderer:
        from airhilt.sensors.cameras.renderers import require_renderer

        taken = require_renderer(renderer)
    packages = _other_packages()
    return Environment(
        versions=versions(),
        code_sha256=_sha256_of(_own_files()),
        renderer=taken,
        packages={name: version for name, (version, _) in packages.items()},
        packages_sha256={
            name: _sha256_of(each for module in modules for each in _files_of_module(module))
            for name, (_, modules) in packages.items()
        },
    )


def require_same(expected: Environment, found: Environment, where: str) -> None:
    """Complain about a worker whose runs would differ.

    Raises
    ------
    AirhiltError
        Something differs; the message names the worker and all of it.
    """
    differences = [
        f"{name} {theirs.get(name, 'missing')} instead of {own.get(name, 'none')}"
        for own, theirs in (
            (expected.versions, found.versions),
            (expected.packages, found.packages),
        )
        for name in sorted(own.keys() | theirs.keys())
        if theirs.get(name) != own.get(name)
    ]
    if found.renderer != expected.renderer:
        differences.append(
            f"it would draw with {found.renderer or 'nothing'} instead of {expected.renderer} "
            "(--renderer NAME: one that all workers have)"
        )
    if not differences and found.code_sha256 != expected.code_sha256:
        differences.append("other code, models, aircraft or airports of AIRHILT")
    if not differences and found.packages_sha256 != expected.packages_sha256:
        other = dict(found.packages_sha256.items() - expected.packages_sha256.items())
        differences.append(f"other code of {', '.join(sorted(other))}")
    if differences:
        raise AirhiltError(
            f"worker {where}: {'; '.join(differences)}; expected the same software everywhere, or "
            "the rows of one table would not be comparable"
        )


def _own_files() -> Iterator[tuple[Path, Path]]:
    """Yield folder and path of each file that decides results."""
    package = Path(__file__).resolve().parents[1]
    for path in sorted(package.rglob("*")):
        if path.suffix in PACKAGE_FILES and path.relative_to(package).parts[0] not in NOT_RESULTS:
            yield package, path
    for kind in LIBRARY:
        folder = library.folder(kind)
        for path in sorted(folder.rglob("*.json")):
            yield folder, path


def _other_packages() -> dict[str, tuple[str, list[str]]]:
    """Return the packages that declare an entry point of AIRHILT's, by their names, sorted.

    Each has its version, and the modules at the top level that its entry points name.
    """
    found: dict[str, tuple[str, list[str]]] = {}
    for each in distributions():
        points = [point for point in each.entry_points if point.group.startswith(GROUPS)]
        if points and each.name != OWN and each.name not in found:  # The first is imported.
            modules = {point.module.partition(".")[0] for point in points}
            found[each.name] = each.version, sorted(modules)
    return dict(sorted(found.items()))


def _sha256_of(files: Iterable[tuple[Path, Path]]) -> str:
    """Return the SHA-256 of files, each given after the folder to which its name is relative."""
    digest = hashlib.sha256()
    for root, path in files:
        digest.update(f"{path.relative_to(root).as_posix()}\0{sha256(path)}\n".encode())
    return digest.hexdigest()


def _files_of_module(module: str) -> Iterator[tuple[Path, Path]]:
    """Yield folder and path of the files of a module or package; nothing of it is imported."""
    spec = None
    with suppress(ImportError, ValueError):  # What cannot be imported says so when it is asked for.
        spec = find_spec(module)
    if spec is None:
        return
    for place in spec.submodule_search_locations or [spec.origin or module]:
        root = Path(place)
        for path in sorted(root.rglob("*")) if root.is_dir() else [root]:
            if path.suffix in PACKAGE_FILES and path.is_file():
                yield root if root.is_dir() else root.parent, path
