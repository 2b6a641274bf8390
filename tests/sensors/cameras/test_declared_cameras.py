"""What a scenario says of its cameras is checked before anything is drawn."""

from __future__ import annotations

import json

import pytest

from airhilt import load
from airhilt.errors import ScenarioError
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.mounts import station_mount
from airhilt.world.flight.aircraft_type import load_aircraft_type
from airhilt.world.loading import load_text


def with_cameras(*changes: dict[str, object]) -> Scenario:
    """Return a scenario with a camera for each, changed so."""
    document = load("s02a_headon").model_dump(mode="json")
    document["cameras"] = [document["cameras"][0] | change for change in changes]
    return load_text(json.dumps(document), "test")


@pytest.mark.parametrize("fov_deg", [0.01, 179.9])
def test_a_lens_that_cannot_be_drawn_is_refused_with_its_path(fov_deg: float) -> None:
    with pytest.raises(ScenarioError, match="cameras/0/horizontal_fov_deg"):
        with_cameras({"horizontal_fov_deg": fov_deg})


@pytest.mark.parametrize("name", [".", "..", "-x", "_x", ".hidden", "a/b", "", "x" * 41])
def test_a_camera_has_a_name_that_a_file_can_have(name: str) -> None:
    with pytest.raises(ScenarioError, match="cameras/0/name"):
        with_cameras({"name": name})


def test_names_of_cameras_differ_in_more_than_their_case() -> None:
    with pytest.raises(ScenarioError, match=r"cameras/1/name.*'Tower'.*has already, as 'tower'"):
        with_cameras({"name": "tower"}, {"name": "Tower"})
    assert len(with_cameras({"name": "tower"}, {"name": "7.tower_B-2"}).cameras) == 2


def test_a_camera_on_the_nose_looks_ahead_and_one_on_the_tail_back() -> None:
    kind = load_aircraft_type("737")
    nose = station_mount("nose", "AAL123", "nose", kind).pose
    tail = station_mount("tail", "AAL123", "tail", kind).pose
    ahead = [pose.rotation[1, 1] for pose in (nose, tail)]
    assert ahead[0] > 0.99
    assert ahead[1] < -0.99
