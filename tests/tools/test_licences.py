"""tools/licences.py writes the licences of a plain install."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import licences
from paths import ROOT

ESPEAK = "GPL-3.0-or-later"


def test_the_page_names_every_direct_dependency_and_the_licence_of_the_default_voice() -> None:
    text = licences.PAGE.read_text()
    assert licences.problems(text) == []
    assert f"| espeak-ng, library and data | espeakng-loader | {ESPEAK} |" in text


def test_a_missing_and_a_surplus_dependency_are_named() -> None:
    text = licences.PAGE.read_text().replace("| numpy |", "| numpty |")
    assert licences.problems(text) == ["numpy is missing", "numpty is no direct dependency"]


def test_the_bill_of_materials_has_the_packages_and_what_they_bundle(tmp_path: Path) -> None:
    file = tmp_path / "sbom.json"
    command = [sys.executable, str(ROOT / "tools" / "licences.py"), "--sbom", str(file)]
    subprocess.run(command, check=True)
    bill = json.loads(file.read_text())
    assert (bill["bomFormat"], bill["specVersion"]) == ("CycloneDX", "1.6")
    components = {each["name"]: each for each in bill["components"]}
    assert components["numpy"]["purl"] == f"pkg:pypi/numpy@{components['numpy']['version']}"
    assert components["starlette"]["licenses"] == [{"license": {"name": "BSD-3-Clause"}}]
    voice = components["espeak-ng, library and data"]
    assert voice["licenses"] == [{"license": {"name": ESPEAK}}]
    assert voice["properties"] == [{"name": "airhilt:bundled-in", "value": "espeakng-loader"}]
