"""A scenario uses an airport, a type of aircraft and a radio channel that lie beside its file."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from airhilt.errors import ScenarioError
from airhilt.host import library
from airhilt.world.loading import load, load_text
from airhilt.world.site import ScenarioSite
from paths import DATA


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a scenario, and with an airport and a type that have other names here."""
    folder = tmp_path / "mine"
    folder.mkdir()
    shutil.copy(library.folder("airports") / "kdca.json", folder / "field.json")
    shutil.copy(library.folder("aircraft") / "737.json", folder / "jet.json")
    document = load("s01a_tight_timing").model_dump(mode="json")
    document["scene"]["airport"] = "field.json"
    for actor in document["actors"]:
        actor["aircraft"] = "jet.json"
    write(folder, document)
    return folder


def write(folder: Path, document: dict[str, Any]) -> None:
    (folder / "scenario.json").write_text(json.dumps(document))


def changed(folder: Path, airport: str) -> Path:
    """Give the scenario another airport, and return its file."""
    path = folder / "scenario.json"
    document = json.loads(path.read_text())
    document["scene"]["airport"] = airport
    write(folder, document)
    return path


def test_files_beside_a_scenario_are_part_of_it(folder: Path) -> None:
    scenario = load(folder / "scenario.json")
    assert set(scenario.files) == {"field.json", "jet.json"}
    assert ScenarioSite.of(scenario).airport.airport.icao == "KDCA"
    shutil.rmtree(folder)
    assert load_text(scenario.model_dump_json(), "again") == scenario


def test_a_file_elsewhere_is_refused_unless_its_folder_is_allowed(
    folder: Path, tmp_path: Path
) -> None:
    other = tmp_path / "other"
    other.mkdir()
    shutil.move(folder / "field.json", other / "field.json")
    path = changed(folder, "../other/field.json")
    with pytest.raises(ScenarioError, match=r"scene/airport: found '\.\./other/field\.json'"):
        load(path)
    assert "../other/field.json" in load(path, [other]).files
    (folder / "link.json").symlink_to(other / "field.json")
    with pytest.raises(ScenarioError, match=r"not in the folder of the scenario.*--allow-path"):
        load(changed(folder, "link.json"))


def test_a_file_that_is_not_there_or_no_airport_is_named(folder: Path) -> None:
    with pytest.raises(ScenarioError, match=r"scene/airport: found 'none\.json', but there is no"):
        load(changed(folder, "none.json"))
    with pytest.raises(ScenarioError, match=r"scene/airport: jet\.json: icao: missing"):
        load(changed(folder, "jet.json"))
    (folder / "deep.json").write_text("[" * 1000)
    with pytest.raises(ScenarioError, match=r"deep\.json"):
        load(changed(folder, "deep.json"))


def test_a_learned_channel_lies_beside_the_scenario(folder: Path) -> None:
    document = load("s01a_tight_timing").model_dump(mode="json")
    document["radio"]["profile"] = "echo.onnx"
    write(folder, document)
    with pytest.raises(ScenarioError, match=r"radio/profile: found 'echo\.onnx', but there is no"):
        load(folder / "scenario.json")
    shutil.copy(DATA / "channels" / "echo.onnx", folder)
    scenario = load(folder / "scenario.json")
    assert scenario.radio.profile == str(folder / "echo.onnx")
