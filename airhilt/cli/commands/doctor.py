"""The command that says what is installed and what is missing, and how to get it."""

from __future__ import annotations

import importlib.metadata
import json
import platform
import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import click

from airhilt import units
from airhilt._version import __version__
from airhilt.cli.output import echo
from airhilt.cli.parameters import json_array_option
from airhilt.engine_families import FAMILIES
from airhilt.engines import Engine, EngineFamily, Package
from airhilt.errors import AirhiltError
from airhilt.host import library
from airhilt.host.caches import cache_folder, write_problem
from airhilt.plugins import Family

NO_NAME = re.compile(r"[^A-Za-z0-9._-]")
"""Character that ends the name at the beginning of a requirement."""
EMBREE = "embree"
"""Renderer of a plain install."""
OPTIONAL = {"av": "video"}
"""Extras by the package that they bring."""


@dataclass(frozen=True)
class Finding:
    """One thing that was looked for."""

    name: str
    found: str
    """Version or count; empty if it is missing."""
    needed: bool
    remedy: str = ""
    is_broken: bool = False
    """True if it is installed, and does not work."""

    def __str__(self) -> str:
        if self.found:
            return f"ok       {self.name} {self.found}"
        word = "BROKEN" if self.is_broken else "MISSING" if self.needed else "absent"
        return f"{word:7}  {self.name}: {self.remedy}"


def examine() -> list[Finding]:
    """Return what was found, the things that every run needs first."""
    findings = [
        Finding("airhilt", f"{__version__}{_kind()}", needed=True),
        Finding("python", platform.python_version(), needed=True),
        *_packages(),
        *[_library(kind) for kind in ("aircraft", "scenarios")],
        _jsbsim_models(),
        *(_engine(each, name) for each in FAMILIES for name in each.names()),
        *_renderers(),
        *_families(),
        _cache(),
    ]
    return [*findings, *[_package(name, extra) for name, extra in OPTIONAL.items()]]


def _kind() -> str:
    """Return what to add to the version if hot modules were compiled when the wheel was made."""
    return "" if str(units.__file__).endswith(".py") else " (compiled)"


def _packages() -> list[Finding]:
    """Look for the packages that AIRHILT depends on.

    A package with a marker, which is for some machines only, is left out: embreex is one, and its
    renderer is tried.
    """
    try:
        requirements = importlib.metadata.requires("airhilt") or []
    except importlib.metadata.PackageNotFoundError:
        remedy = f"{sys.executable} -m pip install -e . (in the folder of pyproject.toml)"
        return [Finding("metadata of airhilt", "", needed=False, remedy=remedy)]
    needed = [requirement for requirement in requirements if ";" not in requirement]
    return [_package(NO_NAME.split(requirement, 1)[0]) for requirement in needed]


def _package(name: str, extra: str = "") -> Finding:
    """Look for a package; one that an extra of AIRHILT brings is not needed."""
    what = f"'airhilt[{extra}]'" if extra else name
    remedy = f"{sys.executable} -m pip install {what}"
    found = Package(name, extra).found().removeprefix(f"{name} ")
    return Finding(name, found, needed=not extra, remedy=remedy)


def _engine(family: EngineFamily[Any], name: str) -> Finding:
    """Look for what an engine needs, and load it if its name alone is enough for that.

    Every run needs the default of each family.
    """
    title, needed = f"{family.word} {name}", name == family.default
    try:
        engine: Engine[Any] = family.load(name)
    except AirhiltError as error:
        return Finding(title, "", needed, str(error), is_broken=True)
    try:
        if lacks := engine.lacks():
            return Finding(title, "", needed, f"{engine.summary}; {lacks}")
        if engine.accepts("") and not engine.usage:
            family.make(engine, "")
    except AirhiltError as error:
        is_broken = not family.is_own(name)  # Files of AIRHILT's own may be missing.
        return Finding(title, "", needed, str(error), is_broken)
    packages = "".join(f"{requirement.found()}, " for requirement in engine.requires)
    return Finding(title, f"({packages}{engine.summary})", needed)


def _families() -> list[Finding]:
    """Load the members of the families that are no engines; every run needs AIRHILT's sensors."""
    from airhilt.cli.main import COMMANDS
    from airhilt.report.page_section import load_member
    from airhilt.report.sections import FAMILY as SECTIONS
    from airhilt.report.sweeps.sections import FAMILY as SWEEP_SECTIONS
    from airhilt.sensors.base import FAMILY as SENSORS
    from airhilt.sensors.base import load_sensor_type
    from airhilt.world.surface.kinds import FAMILY as KINDS

    sensors = [point.name for point in SENSORS.own()]
    return [
        *_members(SENSORS, load_sensor_type, needed=sensors),
        *_members(KINDS, KINDS.load),
        *_members(SECTIONS, partial(load_member, SECTIONS)),
        *_members(SWEEP_SECTIONS, partial(load_member, SWEEP_SECTIONS)),
        *_members(COMMANDS, COMMANDS.load),
    ]


def _members(
    family: Family, load: Callable[[str], object], needed: Sequence[str] = ()
) -> list[Finding]:
    """Load all members of a family: a line on those that can be used, and one on each other."""
    usable, broken = [], []
    for name in family.names():
        try:
            load(name)
            usable.append(name)
        except AirhiltError as error:
            title = f"{family.word} {name}"
            broken.append(Finding(title, "", name in needed, str(error), is_broken=True))
    found = f"({len(usable)}: {', '.join(usable)})"
    return [Finding(f"{family.word}s", found, needed=False), *broken]


def _renderers() -> list[Finding]:
    """Let each renderer of camera pictures draw something; the one of a plain install first."""
    from airhilt.errors import RendererError
    from airhilt.sensors.cameras.renderer_process import probe
    from airhilt.sensors.cameras.renderers import FAMILY

    findings = []
    for name in sorted(FAMILY.names(), key=lambda name: name != EMBREE):
        title, needed = f"renderer {name}", name == EMBREE
        try:
            probe(name)
            findings.append(Finding(title, "(draws)", needed))
        except RendererError as error:
            is_broken = not FAMILY.is_own(name)  # The library of AIRHILT's own may be missing.
            findings.append(Finding(title, "", needed, str(error), is_broken))
    return findings


def _library(kind: str) -> Finding:
    names = library.names(kind)
    found = f"({len(names)}: {', '.join(names)})" if names else ""
    return Finding(kind, found, needed=True, remedy="install airhilt again, its files are missing")


def _cache() -> Finding:
    """Look whether later runs can have what earlier ones have made."""
    folder = cache_folder()
    problem = write_problem(folder)
    remedy = f"{problem}; runs make everything anew; set XDG_CACHE_HOME to a folder of yours"
    found = "" if problem else f"({folder}; airhilt cache shows it)"
    return Finding("cache", found, needed=False, remedy=remedy)


def _jsbsim_models() -> Finding:
    """Look for the models that aircraft/ names in the installed JSBSim."""
    import jsbsim

    from airhilt.world.flight import load_aircraft_type

    models = Path(jsbsim.get_default_root_dir()) / "aircraft"
    missing = [
        name
        for name in library.names("aircraft")
        if not (models / load_aircraft_type(name).jsbsim_model).is_dir()
    ]
    return Finding(
        "JSBSim models",
        "" if missing else "(all that aircraft/ names)",
        needed=True,
        remedy=f"{', '.join(missing)}: not in the installed JSBSim; install jsbsim again",
    )


@click.command(
    epilog="""\b
Examples:
  airhilt doctor
  airhilt doctor --json
"""
)
@json_array_option
def doctor(as_json: bool) -> None:
    """Say what is installed, what is missing or broken, and how to get it.

    Exit code 1 if something is missing that every run needs, or something installed is broken.
    """
    findings = examine()
    if as_json:
        click.echo(json.dumps([asdict(finding) for finding in findings], indent=2))
    else:
        for finding in findings:
            echo(finding)
    if any(finding.is_broken or (finding.needed and not finding.found) for finding in findings):
        sys.exit(1)


COMMAND = doctor
