"""Writes docs/licences.md: the licences of what a plain install brings.

python tools/licences.py                 write the page
python tools/licences.py --check         fail if the page lacks a direct dependency or has one more
python tools/licences.py --sbom FILE     write a bill of materials, CycloneDX 1.6 in JSON
"""

from __future__ import annotations

import argparse
import json
import re
import sys
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "licences.md"
DIRECT = "## Direct dependencies"
"""Heading of the table whose names are checked."""
LONGEST_LICENCE = 60
"""Longest text of the field License, in characters, that is a name and not a whole licence."""
SPDX = {
    "Apache 2.0": "Apache-2.0",
    "Apache Software License": "Apache-2.0",
    "BSD": "BSD-3-Clause",
    "BSD License": "BSD-3-Clause",
    "3-Clause BSD License": "BSD-3-Clause",
    "Eclipse Public License 2.0 (EPL-2.0)": "EPL-2.0",
    "MIT License": "MIT",
    "Python Software Foundation License": "PSF-2.0",
}
"""SPDX identifiers by the names that packages give; other names are kept as they are."""
CORRECTED = {
    "contourpy": "BSD-3-Clause",
    "eclipse-zenoh": "EPL-2.0 OR Apache-2.0",
    "embreex": "BSD-2-Clause",
    "espeakng-loader": "MIT",
    "jsbsim": "LGPL-2.1-or-later",
}
"""Licences of packages whose metadata names none, or not the exact one."""
HOMES = {
    "espeakng-loader": "https://github.com/thewh1teagle/espeakng-loader",
    "jiwer": "https://github.com/jitsi/jiwer",
}
"""Homes of packages whose metadata names none."""


@dataclass(frozen=True)
class Component:
    """Third-party software with its licence."""

    name: str
    licence: str
    home: str
    version: str = ""
    """Version that is installed; empty for what a package bundles."""
    inside: str = ""
    """Package that bundles it; empty for a package."""


BUNDLED = (
    Component("Embree", "Apache-2.0", "https://www.embree.org", inside="embreex"),
    Component("oneTBB", "Apache-2.0", "https://github.com/uxlfoundation/oneTBB", inside="embreex"),
    Component(
        "espeak-ng, library and data", "GPL-3.0-or-later",
        "https://github.com/espeak-ng/espeak-ng", inside="espeakng-loader",
    ),
    Component("JSBSim", "LGPL-2.1-or-later", "https://jsbsim.sourceforge.net", inside="jsbsim"),
    Component("OpenBLAS", "BSD-3-Clause", "https://www.openblas.net", inside="numpy, scipy"),
    Component(
        "libgfortran and libquadmath", "GPL-3.0-or-later WITH GCC-exception-3.1",
        "https://gcc.gnu.org", inside="numpy, scipy",
    ),
    Component("GEOS", "LGPL-2.1-or-later", "https://libgeos.org", inside="shapely"),
)  # fmt: skip
"""Parts bundled in wheels under another licence than the metadata of the package says."""

INTRODUCTION = """# Licences

AIRHILT is under the Apache-2.0. A plain install brings the software below. It takes
0.9 GB. The largest parts are pyarrow and pandas (tables of sweeps and of run data), scipy, and
onnxruntime (recogniser and detector), which commands of the README need.

The default voice, espeak-ng, is under the GPL-3.0-or-later. Whoever passes on an environment or an
image with espeak-ng has the duties of that licence. `--tts flite` and `--no-speech` do not use it.

`python tools/licences.py` writes this page from the metadata of the installed packages.
`python tools/licences.py --sbom FILE` writes a bill of materials with versions, as CycloneDX 1.6 in
JSON. Extras bring more. The Docker image has the packages of its base, Debian with Python, too.

## Bundled in wheels

The metadata of these packages does not name it, or not exactly:

| software | in the package | licence | home |
|---|---|---|---|"""


def declared() -> list[Requirement]:
    """Return the default dependencies of pyproject.toml."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return [Requirement(each) for each in project["dependencies"]]


def installed(requirements: Iterable[Requirement]) -> dict[str, Component]:
    """Return the packages that requirements bring, with their own dependencies, by name.

    Raises
    ------
    PackageNotFoundError
        One is not installed.
    """
    components: dict[str, Component] = {}
    waiting = list(requirements)
    while waiting:
        requirement = waiting.pop()
        name = canonicalize_name(requirement.name)
        is_for_here = requirement.marker is None or requirement.marker.evaluate({"extra": ""})
        if name in components or not is_for_here:
            continue
        package = distribution(name)
        components[name] = Component(name, licence(package), home(package), package.version)
        waiting += [Requirement(each) for each in package.requires or []]
    return dict(sorted(components.items()))


def licence(package: Distribution) -> str:
    """Return the licence of a package, as an SPDX expression where its metadata allows."""
    fields = package.metadata
    if corrected := CORRECTED.get(canonicalize_name(fields["Name"])):
        return corrected
    if expression := _field(package, "License-Expression"):
        return expression
    text = _field(package, "License").strip()
    if text and "\n" not in text and len(text) <= LONGEST_LICENCE and "opyright" not in text:
        return SPDX.get(text, text)
    classifiers = [
        each.rpartition(" :: ")[2]
        for each in fields.get_all("Classifier") or []
        if each.startswith("License ::")
    ]
    return " AND ".join(SPDX.get(each, each) for each in classifiers) or "unknown"


def _field(package: Distribution, name: str) -> str:
    return next(iter(package.metadata.get_all(name) or []), "")


def home(package: Distribution) -> str:
    """Return the address of a package's home, or of its source; empty if neither is named."""
    fields = package.metadata
    named = dict(each.split(", ", 1) for each in fields.get_all("Project-URL") or [])
    places = {label.lower(): address for label, address in named.items()}
    words = ("homepage", "home", "source", "source code", "repository", "github")
    found = [places[word] for word in words if word in places]
    known = HOMES.get(canonicalize_name(fields["Name"]), "")
    return next(iter([*found, *filter(None, [_field(package, "Home-page")])]), known)


def page() -> str:
    """Return docs/licences.md."""
    direct_names = {canonicalize_name(each.name) for each in declared()}
    components = installed(declared())
    direct = [each for name, each in components.items() if name in direct_names]
    others = [each for name, each in components.items() if name not in direct_names]
    bundled = [
        f"| {each.name} | {each.inside} | {each.licence} | {each.home} |" for each in BUNDLED
    ]
    lines = [INTRODUCTION, *bundled, "", DIRECT, "", *_table(direct), ""]
    return "\n".join([*lines, "## What they bring", "", *_table(others), ""])


def _table(components: Iterable[Component]) -> list[str]:
    rows = [f"| {each.name} | {each.licence} | {each.home} |" for each in components]
    return ["| package | licence | home |", "|---|---|---|", *rows]


def problems(text: str) -> list[str]:
    """Return in which direct dependencies a page differs from pyproject.toml."""
    section = text.partition(DIRECT)[2].partition("\n## ")[0]
    listed = set(re.findall(r"^\| ([a-z0-9-]+) \|", section, re.MULTILINE)) - {"package"}
    names = {canonicalize_name(each.name) for each in declared()}
    missing = [f"{name} is missing" for name in sorted(names - listed)]
    return missing + [f"{name} is no direct dependency" for name in sorted(listed - names)]


def bill_of_materials() -> dict[str, object]:
    """Return all components as a CycloneDX 1.6 document."""
    packages = [
        {
            "type": "library",
            "name": each.name,
            "version": each.version,
            "purl": f"pkg:pypi/{each.name}@{each.version}",
            "licenses": [{"license": {"name": each.licence}}],
        }
        for each in installed(declared()).values()
    ]
    bundled = [
        {
            "type": "library",
            "name": each.name,
            "licenses": [{"license": {"name": each.licence}}],
            "properties": [{"name": "airhilt:bundled-in", "value": each.inside}],
        }
        for each in BUNDLED
    ]
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "components": [*packages, *bundled],
    }


def main() -> None:
    """Write the page or a bill of materials, or check the page."""
    parser = argparse.ArgumentParser(description="Writes docs/licences.md.")
    parser.add_argument("--check", action="store_true", help="compare the names, write nothing")
    parser.add_argument("--sbom", type=Path, help="write a CycloneDX bill of materials to a file")
    options = parser.parse_args()
    try:
        if options.check:
            if found := problems(PAGE.read_text(encoding="utf-8")):
                sys.exit(f"{PAGE.name}: {', '.join(found)}; run python tools/licences.py")
        elif options.sbom:
            document = json.dumps(bill_of_materials(), indent=2) + "\n"
            options.sbom.write_text(document, encoding="utf-8")
        else:
            PAGE.write_text(page(), encoding="utf-8")
    except PackageNotFoundError as error:
        sys.exit(f"{error}; install AIRHILT with its dependencies first")


if __name__ == "__main__":
    main()
