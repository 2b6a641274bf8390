"""Software that runs a run: with scenario and options it decides the results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from pydantic import BaseModel, ConfigDict

from airhilt.errors import AirhiltError
from airhilt.host import library
from airhilt.record.folder import versions
from airhilt.sweep.other_packages import PACKAGE_FILES, files_sha256, other_packages, package_sha256

NOT_RESULTS = ("cli", "library", "report", "sweep")
"""Parts of the package that decide no results, and its copy of `LIBRARY`."""
LIBRARY = ("aircraft", "airports")
"""Kinds of files that scenarios refer to by name."""


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
    others = other_packages()
    return Environment(
        versions=versions(),
        code_sha256=_code_sha256(),
        renderer=taken,
        packages={name: each.version for name, each in others.items()},
        packages_sha256={name: package_sha256(each) for name, each in others.items()},
    )


def require_same(expected: Environment, found: Environment, where: str) -> None:
    """Complain about a worker whose runs would differ.

    Raises
    ------
    AirhiltError
        Something differs; the message names the worker and all of it.
    """
    differences = [
        *_different_versions(expected.versions, found.versions),
        *_different_versions(expected.packages, found.packages),
    ]
    if found.renderer != expected.renderer:
        differences.append(
            f"it would draw with {found.renderer or 'nothing'} instead of {expected.renderer} "
            "(--renderer NAME: one that all workers have)"
        )
    if not differences and found.code_sha256 != expected.code_sha256:
        differences.append("other code, models, aircraft or airports of AIRHILT")
    if not differences and found.packages_sha256 != expected.packages_sha256:
        names = [
            name
            for name, code in found.packages_sha256.items()
            if code != expected.packages_sha256.get(name)
        ]
        differences.append(f"other code of {', '.join(sorted(names))}")
    if differences:
        raise AirhiltError(
            f"worker {where}: {'; '.join(differences)}; expected the same software everywhere, or "
            "the rows of one table would not be comparable"
        )


def _different_versions(expected: Mapping[str, str], found: Mapping[str, str]) -> list[str]:
    return [
        f"{name} {found.get(name, 'missing')} instead of {expected.get(name, 'none')}"
        for name in sorted(expected.keys() | found.keys())
        if found.get(name) != expected.get(name)
    ]


def _code_sha256() -> str:
    return files_sha256(_files())


def _files() -> Iterator[tuple[Path, Path]]:
    """Yield folder and path of each file that decides results."""
    package = Path(__file__).resolve().parents[1]
    for path in sorted(package.rglob("*")):
        if path.suffix in PACKAGE_FILES and path.relative_to(package).parts[0] not in NOT_RESULTS:
            yield package, path
    for kind in LIBRARY:
        folder = library.folder(kind)
        for path in sorted(folder.rglob("*.json")):
            yield folder, path
