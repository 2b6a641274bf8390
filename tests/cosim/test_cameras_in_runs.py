"""Runs with cameras: pictures reach the detector, and a run goes on without them."""

from __future__ import annotations

import gc
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from airhilt import load
from airhilt.assistant.vision.gating import KeptPixels
from airhilt.cosim import cameras as vision
from airhilt.cosim.observer import Observer, Snapshot
from airhilt.cosim.replay import replay
from airhilt.cosim.simulation import run
from airhilt.errors import AirhiltError, RendererError, RunStopped
from airhilt.host.child_process import ChildProcess
from airhilt.messages import CameraFrame, Detections, Status
from airhilt.options import Options
from airhilt.record import Logged, read_log
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.frame import Frame
from airhilt.units import SECOND_NS
from notices import Notices

SEEN = Options(renderer="embree", speech=False, latency="fixed")


@pytest.fixture
def short() -> Scenario:
    """Two seconds of two aircraft that fly at each other 4 km apart."""
    document = json.loads(load("s02a_headon").model_dump_json())
    for actor in document["actors"]:
        actor["initial"]["position"]["distance_nm"] = 1.08
    for camera in document["cameras"]:
        camera["rate_hz"] = 8.0
    return Scenario.model_validate(document | {"name": "short", "duration_s": 2.0})


@pytest.fixture
def small(short: Scenario) -> Scenario:
    """The same in pictures that are drawn and looked at in no time."""
    size = {"width_px": 320, "height_px": 180}
    cameras = tuple(camera.model_copy(update=size) for camera in short.cameras)
    return short.model_copy(update={"cameras": cameras})


def log_of(scenario: Scenario, out: Path, **options: Any) -> list[Logged]:
    run(scenario, SEEN.model_copy(update={"out": out, **options}))
    return list(read_log(out / "log.mcap"))


def messages(log: list[Logged], prefix: str) -> list[Logged]:
    return [logged for logged in log if logged.key.startswith(prefix)]


def states_of_vision(log: list[Logged]) -> list[tuple[str, str]]:
    states = [Status.model_validate_json(each.data) for each in messages(log, "status/vision")]
    return [(status.state, status.cause) for status in states]


def test_each_picture_is_looked_at_and_told_as_late_as_the_detector_is(
    small: Scenario, tmp_path: Path
) -> None:
    log = log_of(small, tmp_path / "run", latency="fixed:0.05")
    frames = [CameraFrame.model_validate_json(each.data) for each in messages(log, "camera/")
              if each.key.endswith("/frame")]  # fmt: skip
    seen = [Detections.model_validate_json(each.data) for each in messages(log, "vision/")]
    assert len(frames) == 2 * 17
    assert {each.t_ns - each.t_frame_ns for each in seen} >= {SECOND_NS // 20}
    assert {(each.camera, each.seq) for each in seen} <= {(f.camera, f.seq) for f in frames}
    assert len(seen) > 25
    assert states_of_vision(log) == [("on", "")]


def pictures_in_memory() -> list[Frame | KeptPixels]:
    """Return all there are, among them those that other tests keep."""
    return [each for each in gc.get_objects() if isinstance(each, Frame | KeptPixels)]


@pytest.mark.slow
def test_a_run_leaves_no_picture_in_memory(small: Scenario, tmp_path: Path) -> None:
    """Something may hold one run for longer than it lasts, on a busy machine; not each of three."""
    brief = small.model_copy(update={"duration_s": 0.5})
    gc.collect()
    before = pictures_in_memory()
    gc.disable()
    try:
        for attempt in range(3):
            log_of(brief, tmp_path / f"run {attempt}")
            left = len(pictures_in_memory()) - len(before)
            if not left:
                break
    finally:
        gc.enable()
    assert not left


@pytest.mark.slow
def test_nobody_is_seen_in_the_fog_that_is_asked_for_and_a_replay_has_it(
    short: Scenario, tmp_path: Path
) -> None:
    glance = short.model_copy(update={"duration_s": 0.5})
    log = log_of(glance, tmp_path / "run", visibility_m=500.0)
    seen = [Detections.model_validate_json(each.data) for each in messages(log, "vision/")]
    assert seen
    assert not any(each.detections for each in seen)
    assert replay(tmp_path / "run").identical


@pytest.mark.slow
def test_pictures_wait_for_nobody_and_old_ones_are_dropped_and_counted(
    small: Scenario, tmp_path: Path
) -> None:
    options = SEEN.model_copy(update={"latency": "fixed:0.3", "out": tmp_path / "run"})
    summary = run(small, options).summary
    dropped = [n for key, n in summary.inputs_dropped.items() if "camera/nose" in key]
    assert sum(dropped) > 10


def test_a_measured_run_with_cameras_is_replayed_to_the_byte(
    small: Scenario, tmp_path: Path
) -> None:
    brief = small.model_copy(update={"duration_s": 1.0})
    log_of(brief, tmp_path / "run", latency="measured")
    assert replay(tmp_path / "run").identical


@pytest.mark.slow
def test_a_renderer_that_is_killed_costs_the_pictures_and_nothing_else(
    small: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened = []
    open_scene_renderer = vision._open_renderer

    def opening(scenario: Scenario, options: Options, processes: Sequence[ChildProcess]) -> object:
        opened.append(processes)
        return open_scene_renderer(scenario, options, processes)

    class Killer(Observer):
        def snapshot(self, snapshot: Snapshot) -> None:
            if snapshot.t_s == 1.0:
                opened[0][0].kill()

    monkeypatch.setattr(vision, "_open_renderer", opening)
    result = run(small, SEEN.model_copy(update={"out": tmp_path / "run"}), Killer())
    monkeypatch.undo()
    assert result.summary.outcome == "finished"
    log = list(read_log(tmp_path / "run" / "log.mcap"))
    (_, _), (state, cause) = states_of_vision(log)
    assert state == "lost"
    assert "signal 9" in cause
    assert replay(tmp_path / "run").identical


def test_without_a_renderer_vision_is_not_evaluated_and_the_run_goes_on(
    small: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(vision, "_open_renderer", missing)
    notices = Notices()
    result = run(small, SEEN.model_copy(update={"out": tmp_path / "run"}), notices)
    log = list(read_log(tmp_path / "run" / "log.mcap"))
    assert states_of_vision(log) == [("not evaluated", "no renderer here")]
    assert result.summary.outcome == "finished"
    assert any("no renderer here" in text for text in notices.texts)
    assert replay(tmp_path / "run").identical


def missing(*_: object) -> None:
    raise RendererError("no renderer here")


def test_without_a_renderer_a_strict_run_does_not_begin(
    short: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(vision, "_open_renderer", missing)
    options = SEEN.model_copy(update={"strict": True, "out": tmp_path / "run"})
    with pytest.raises(RunStopped, match="--no-cameras"):
        run(short, options)
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize("changes", [{"assistant": "none"}, {"cameras": False, "renderer": "auto"}])
def test_no_picture_is_drawn_that_nobody_looks_at(
    short: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, changes: dict[str, object]
) -> None:
    monkeypatch.setattr(vision, "_open_renderer", missing)
    log = log_of(short, tmp_path / "run", **changes)
    assert states_of_vision(log) == [("off", "")]


def test_a_camera_on_the_ground_is_refused_before_the_run(short: Scenario, tmp_path: Path) -> None:
    document = json.loads(short.model_dump_json())
    document["cameras"][0]["mount"] = {
        "type": "fixed",
        "position": {"type": "from_centre", "bearing_deg": 0.0, "distance_nm": 1.0},
        "height_ft": 0.0,
        "azimuth_deg": 0.0,
    }
    with pytest.raises(AirhiltError, match="nose-AAL123"):
        log_of(Scenario.model_validate(document), tmp_path / "run")
    assert not (tmp_path / "run").exists()
