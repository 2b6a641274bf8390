"""Kinds of another package are whole: their file alone says how they look, sound and obey."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from airhilt.cosim.briefing import briefing_of
from airhilt.cosim.simulation import run
from airhilt.errors import AirhiltError, ScenarioError
from airhilt.messages import (
    AdsbReport,
    Advisory,
    CameraTruth,
    Climb,
    Evidence,
    HoldPosition,
    Recommendation,
    Severity,
)
from airhilt.options import Options
from airhilt.record import RunFolder, read_log
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.dataset.export import export
from airhilt.sensors.cameras.dataset.pictures import scenario_pictures
from airhilt.sensors.cameras.scene.bodies import kind_model
from airhilt.world.actors import build_actors
from airhilt.world.checks import check
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.kinds import load_kind

GUIDE = Path(__file__).parents[3] / "docs" / "actors.md"


@pytest.fixture
def other_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """An installed package with the moose and the drone of the guide."""
    guide = GUIDE.read_text()
    _, moose, drone = re.findall(r"```python\n(.*?)```", guide, flags=re.DOTALL)
    declared = re.search(r"```toml\n(.*?)```", guide, flags=re.DOTALL)
    assert declared is not None
    heading, *lines = declared[1].replace('"', "").splitlines()
    assert heading == "[project.entry-points.airhilt.kinds]"
    package = tmp_path / "path" / "my_package"
    installed = tmp_path / "path" / "my_package-1.0.dist-info"
    package.mkdir(parents=True)
    installed.mkdir()
    (package / "__init__.py").touch()
    (package / "moose.py").write_text(moose)
    (package / "drone.py").write_text(drone)
    (installed / "METADATA").write_text("Metadata-Version: 2.1\nName: my-package\nVersion: 1.0\n")
    (installed / "entry_points.txt").write_text("\n".join(["[airhilt.kinds]", *lines]))
    monkeypatch.syspath_prepend(tmp_path / "path")
    yield
    for name in [name for name in sys.modules if name.split(".")[0] == "my_package"]:
        del sys.modules[name]


def document(**drone: Any) -> dict[str, Any]:
    """Return three seconds of a moose and a drone, each before a camera, over runway 01."""

    def beside(along_m: float, offset_m: float) -> dict[str, Any]:
        return {"type": "runway", "runway": "01", "along_m": along_m, "offset_m": offset_m}

    def standing(along_m: float, offset_m: float) -> dict[str, Any]:
        return {"type": "standing", "position": beside(along_m, offset_m), "heading_deg": 90.0}

    def camera(name: str, position: dict[str, Any], height_ft: float) -> dict[str, Any]:
        mount = {"type": "fixed", "position": position, "height_ft": height_ft,
                 "azimuth_deg": 354.0, "elevation_deg": 0.0}  # fmt: skip
        return {"name": name, "width_px": 320, "height_px": 240, "rate_hz": 2.0,
                "horizontal_fov_deg": 60.0, "mount": mount}  # fmt: skip

    return {
        "name": "other_packages", "title": "A moose and a drone", "family": "S01C",
        "scene": {"type": "airport", "airport": "KDCA"}, "duration_s": 3.0,
        "actors": [
            {"type": "wildlife", "callsign": "MOOSE1", "kind": "moose",
             "initial": standing(300.0, 0.0)},
            {"type": "vehicle", "callsign": "UAV1", "icao24": "adb001", "kind": "drone",
             "initial": standing(306.0, -4.0), "transponder": {"equipped": True}} | drone,
        ],
        "cameras": [
            camera("low", beside(280.0, 0.0), 20.0), camera("high", beside(290.0, -4.0), 150.0)
        ],
    }  # fmt: skip


def scenario(**drone: Any) -> Scenario:
    return Scenario.model_validate(document(**drone))


def actors(given: Scenario) -> dict[str, Any]:
    return dict(build_actors(given, ScenarioSite.of(given), 1, 0.05))


def advisory(recommendation: Recommendation) -> Advisory:
    return Advisory(
        id="A1", revision=0, recipient="UAV1", recipients=("UAV1",), kind="loss_of_separation",
        severity=Severity.WARNING, traffic=("UAV1",), message="", recommendation=recommendation,
        evidence=Evidence(sources=()), t_ready_ns=0,
    )  # fmt: skip


def test_they_are_drawn_with_meshes_of_their_own(other_package: None) -> None:
    moose, drone = kind_model("moose"), kind_model("drone")
    assert set(moose.shapes) == set(drone.shapes) == {"body"}
    assert len(moose.shapes["body"]) != len(kind_model("deer").shapes["body"])
    assert list(drone.lights(0.0, True)) == []
    extent = moose.shapes["body"].corners.max(axis=(0, 1)) - moose.shapes["body"].corners.min(
        axis=(0, 1)
    )
    assert extent == pytest.approx((1.12, 2.35, 2.11), abs=0.2)


@pytest.mark.usefixtures("other_package")
def test_a_run_labels_them_and_hears_them_as_their_files_say(tmp_path: Path) -> None:
    run(
        scenario(),
        Options(out=tmp_path / "run", latency="fixed", speech=False, renderer="embree"),
    )
    log = list(read_log(tmp_path / "run" / "log.mcap"))
    truths = [
        CameraTruth.model_validate_json(logged.data)
        for logged in log
        if logged.key.startswith("truth/camera/")
    ]
    seen = {(s.actor, s.label) for truth in truths for s in truth.sightings if s.pixels > 0.0}
    assert seen == {("MOOSE1", "moose"), ("UAV1", "drone")}
    reports = [
        AdsbReport.model_validate_json(logged.data) for logged in log if logged.key == "adsb/adb001"
    ]
    assert {report.emitter_category for report in reports} <= {None, "B6"}
    assert reports
    assert RunFolder(tmp_path / "run").info().other_packages == {
        "kind moose": "my-package 1.0", "kind drone": "my-package 1.0",
    }  # fmt: skip


@pytest.mark.slow
@pytest.mark.usefixtures("other_package")
def test_data_sets_have_their_classes_after_the_usual_ones(tmp_path: Path) -> None:
    pictures = scenario_pictures(scenario(), 4, renderer="embree")
    found = export(lambda _: pictures, tmp_path / "data", {}).bodies
    assert found == {("train", "moose"): 2, ("train", "drone"): 2}
    written = json.loads((tmp_path / "data" / "annotations.json").read_text())
    names = {category["id"]: category["name"] for category in written["categories"]}
    assert list(names) == [1, 2, 3, 4, 5, 6, 7]
    assert (names[1], names[6], names[7]) == ("airplane", "drone", "moose")
    assert {names[each["category_id"]] for each in written["annotations"]} == {"drone", "moose"}


@pytest.mark.usefixtures("other_package")
def test_a_driver_understands_what_the_kind_does() -> None:
    climbing = scenario(commands=[{"action": "altitude", "altitude_ft": 500.0}])
    check(climbing, "here")
    body = actors(climbing)["UAV1"].body
    before = body.state.altitude_m
    for _ in range(20):
        body.advance()
    assert body.state.altitude_m == pytest.approx(before + 3.0)


def test_a_driver_of_another_kind_does_not(other_package: None) -> None:
    fire_truck = scenario(
        kind="fire_truck", commands=[{"action": "altitude", "altitude_ft": 500.0}]
    )
    with pytest.raises(ScenarioError, match="'altitude', which no vehicle does; expected taxi, "):
        check(fire_truck, "here")


@pytest.mark.usefixtures("other_package")
def test_a_driver_follows_the_recommendations_that_the_kind_follows() -> None:
    drone = actors(scenario())["UAV1"]
    up = Climb(sense="climb", altitude_ft=500.0, vertical_rate_fpm=500.0)
    reaction = drone.hear(advisory(up))
    assert reaction.text == "follows altitude"
    assert reaction.act()
    drone.body.advance()
    assert drone.body.state.velocity_down_m_s < 0.0
    truck = actors(scenario(kind="fire_truck"))["UAV1"]
    assert truck.hear(advisory(up)) is None
    assert truck.hear(advisory(HoldPosition(runway="01"))).text == "holds position"


@pytest.mark.usefixtures("other_package")
def test_radar_and_transponder_take_the_numbers_of_the_kind() -> None:
    assert load_kind("moose").radar_cross_section_m2 == 3.0
    assert actors(scenario())["UAV1"].emitter_category == "B6"


@pytest.mark.usefixtures("other_package")
def test_the_briefing_names_the_animals_among_the_labels() -> None:
    given = scenario()
    told = briefing_of(given, ScenarioSite.of(given))
    assert told.animals == ("bird", "coyote", "deer", "moose")


def broken_drone(folder: Path, method: str, body: str) -> None:
    """Give the drone of the other package a method that fails."""
    source = folder / "path" / "my_package" / "drone.py"
    text = source.read_text()
    defined = re.search(rf"    def {method}\(.*?\):\n", text, flags=re.DOTALL)
    if defined is None:
        owner = "class DroneKind(DrivenKind):\n"
        assert owner in text
        text = text.replace(owner, f"{owner}    def {method}(self, *_):\n        {body}\n\n")
    else:
        text = text.replace(defined[0], f"{defined[0]}        {body}\n", 1)
    source.write_text(text)


@pytest.mark.usefixtures("other_package")
@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("{}['gain']", r"actors/UAV1: .* kind 'drone': create failed: KeyError: 'gain' \(drone.py"),
        ("return None", "kind 'drone': create returned None, which has no drive, stop, resume, .*"),
        ("raise ValueError('too windy')", "actors/UAV1: cannot begin like that: too windy"),
    ],
)
def test_a_kind_that_makes_no_body_is_named(tmp_path: Path, body: str, told: str) -> None:
    broken_drone(tmp_path, "create", body)
    with pytest.raises(ScenarioError, match=told):
        actors(scenario())


@pytest.mark.usefixtures("other_package")
def test_a_kind_that_fails_at_a_command_is_named_and_not_unable(tmp_path: Path) -> None:
    broken_drone(tmp_path, "carry_out", "{}['gain']")
    with pytest.raises(AirhiltError, match="kind 'drone': carry_out failed: KeyError: 'gain'"):
        actors(scenario(commands=[{"action": "altitude", "altitude_ft": 500.0}]))


@pytest.mark.usefixtures("other_package")
@pytest.mark.parametrize(
    ("method", "body", "told"),
    [
        ("advance", "1 / 0", r"actor 'UAV1' cannot move on at 0\.05 s: ZeroDivisionError"),
        pytest.param(
            "mesh_of",
            "1 / 0",
            "kind 'drone': mesh_of failed: ZeroDivisionError",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_a_kind_that_fails_in_a_run_stops_it_with_its_name(
    tmp_path: Path, method: str, body: str, told: str
) -> None:
    broken_drone(tmp_path, method, body)
    options = Options(out=tmp_path / "run", latency="fixed", speech=False, renderer="embree")
    with pytest.raises(AirhiltError, match=told):
        run(scenario(), options)


@pytest.mark.usefixtures("other_package")
@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("1 / 0", "kind 'drone': appearance failed: ZeroDivisionError"),
        ("return 42", "kind 'drone': appearance returned 42; expected an Appearance"),
    ],
)
def test_a_kind_that_cannot_say_how_it_looks_is_named(tmp_path: Path, body: str, told: str) -> None:
    broken_drone(tmp_path, "appearance", body)
    with pytest.raises(AirhiltError, match=told):
        kind_model("drone")
