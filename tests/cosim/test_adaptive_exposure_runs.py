"""Runs with adaptive exposure: what they leave out, and what stays as it is at the full rate."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from airhilt import load
from airhilt.cosim.replay import replay
from airhilt.cosim.simulation import run
from airhilt.host.library import names
from airhilt.messages import CameraFrame, Detections
from airhilt.metrics.summary import Summary
from airhilt.options import Options
from airhilt.record import Logged, read_log
from airhilt.scenario import Scenario

MOST_S = 240.0
"""Length of the longest run of the slow test, in s.

Runs that it does not cut have first detections; one that it cuts has some if there was something
to find."""


def meeting(distance_nm: float, duration_s: float) -> Scenario:
    """Return two aircraft that fly at each other from so far apart, with two cameras."""
    document = load("s02a_headon").model_dump(mode="json")
    for actor in document["actors"]:
        actor["initial"]["position"]["distance_nm"] = distance_nm / 2.0
    for camera in document["cameras"]:
        camera["rate_hz"] = 8.0
    return Scenario.model_validate(document | {"name": "meeting", "duration_s": duration_s})


def summary_of(scenario: Scenario, out: Path, rate: str) -> Summary:
    given = {"camera_rate": rate, "renderer": "embree", "speech": False, "latency": "fixed"}
    return run(scenario, Options.model_validate({**given, "out": out})).summary


@pytest.mark.slow
def test_only_what_cameras_show_is_left_out_and_everything_else_comes_when_it_did(
    tmp_path: Path,
) -> None:
    """Headers and empty answers keep the workers as busy as pictures do."""

    def rest(log: list[Logged]) -> list[Logged]:
        seen = "camera/", "vision/", "truth/camera/"
        return [each._replace(sequence=0) for each in log if not each.key.startswith(seen)]

    def turns(log: list[Logged]) -> list[tuple[int, str, int]]:
        told = [Detections.model_validate_json(each.data) for each in log
                if each.key.startswith("vision/")]  # fmt: skip
        return [(each.t_ns, each.camera, each.seq) for each in told]

    apart = meeting(60.0, 1.0)
    full, adaptive = (summary_of(apart, tmp_path / rate, rate) for rate in ("full", "adaptive"))
    logs = {rate: list(read_log(tmp_path / rate / "log.mcap")) for rate in ("full", "adaptive")}
    assert rest(logs["full"]) == rest(logs["adaptive"])
    assert turns(logs["full"]) == turns(logs["adaptive"])
    assert (full.vision.taken, full.vision.exposures_left_out) == (18, 0)
    assert (adaptive.vision.taken, adaptive.vision.exposures_left_out) == (4, 14)
    assert (full.nuisance_alerts, adaptive.nuisance_alerts) == (0, None)
    assert replay(tmp_path / "adaptive").identical


@pytest.mark.slow
def test_with_a_body_in_view_from_the_start_a_run_is_that_of_the_full_rate(tmp_path: Path) -> None:
    near = meeting(3.0, 0.5)
    for rate in ("full", "adaptive"):
        summary_of(near, tmp_path / rate, rate)
    logs = [list(read_log(tmp_path / rate / "log.mcap")) for rate in ("full", "adaptive")]
    assert logs[0] == logs[1]
    frames = [json.loads(each.data) for each in logs[1] if each.key.endswith("/frame")]
    assert {CameraFrame.model_validate(frame).encoding for frame in frames} == {"rgb8"}


@pytest.mark.slow
@pytest.mark.parametrize("name", names("scenarios"))
def test_first_detections_and_their_times_are_those_of_the_full_rate(
    name: str, tmp_path: Path
) -> None:
    scenario = load(name)
    if not scenario.cameras:
        pytest.skip("this scenario has no cameras")
    shortened = scenario.model_copy(update={"duration_s": min(scenario.duration_s, MOST_S)})
    full, adaptive = (summary_of(shortened, tmp_path / rate, rate) for rate in ("full", "adaptive"))
    if full.vision.sightings or scenario.duration_s <= MOST_S:
        assert full.vision.first_detections, "there is nothing to compare"
    assert adaptive.vision.first_detections == full.vision.first_detections
    assert adaptive.t_first_warning_s == full.t_first_warning_s
    assert adaptive.avoided == full.avoided
