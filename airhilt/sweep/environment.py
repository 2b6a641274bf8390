"""Software that runs a run: with scenario and options it decides the results."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path

from pydantic import BaseModel, ConfigDict

from airhilt import library
from airhilt.errors import AirhiltError
from airhilt.record.folder import versions

PACKAGE_FILES = (".py", ".onnx", ".json", ".csv", ".txt", ".npz")
"""Endings of the files of the package that decide results: code, models and their data."""
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
    return Environment(versions=versions(), code_sha256=_code_sha256(), renderer=taken)


def require_same(expected: Environment, found: Environment, where: str) -> None:
    """Complain about a worker whose runs would differ.

    Raises
    ------
    AirhiltError
        Something differs; the message names the worker and all of it.
    """
    names = sorted(expected.versions.keys() | found.versions.keys())
    differences = [
        f"{name} {found.versions.get(name, 'missing')} instead of "
        f"{expected.versions.get(name, 'none')}"
        for name in names
        if found.versions.get(name) != expected.versions.get(name)
    ]
    if found.renderer != expected.renderer:
        differences.append(
            f"it would draw with {found.renderer or 'nothing'} instead of {expected.renderer} "
            "(--renderer NAME: one that all workers have)"
        )
    if not differences and found.code_sha256 != expected.code_sha256:
        differences.append("other code, models, aircraft or airports of AIRHILT")
    if differences:
        raise AirhiltError(
            f"worker {where}: {'; '.join(differences)}; expected the same software everywhere, or "
            "the rows of one table would not be comparable"
        )


def _code_sha256() -> str:
    digest = hashlib.sha256()
    for root, path in _files():
        content = hashlib.sha256(path.read_bytes()).hexdigest()
        digest.update(f"{path.relative_to(root).as_posix()}\0{content}\n".encode())
    return digest.hexdigest()


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
