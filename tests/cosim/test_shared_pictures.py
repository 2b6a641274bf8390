"""Runs that share what is costly about pictures: the same logs as without sharing."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from airhilt import load
from airhilt.assistant.vision.detectors.embedded import EmbeddedDetector
from airhilt.cosim.replay import replay
from airhilt.cosim.simulation import run
from airhilt.errors import AirhiltError
from airhilt.messages import InputSpec, Status, WorkerDescription
from airhilt.options import Options
from airhilt.record import RunFolder, read_log
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.renderer_process import RendererProcess
from airhilt.workers import Input, Step

SEEN = Options(renderer="embree", speech=False, latency="fixed")


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "airhilt"


def meeting() -> Scenario:
    """Return a second of two aircraft that fly at each other 3 km apart, in small pictures."""
    document = load("s02a_headon").model_dump(mode="json")
    for actor in document["actors"]:
        actor["initial"]["position"]["distance_nm"] = 0.8
    for camera in document["cameras"]:
        camera |= {"rate_hz": 8.0, "width_px": 320, "height_px": 180}
    return Scenario.model_validate(document | {"name": "meeting", "duration_s": 1.0})


def log_of(out: Path, **options: object) -> bytes:
    run(meeting(), Options.model_validate({**SEEN.model_dump(), "out": out, **options}))
    return (out / "log.mcap").read_bytes()


@pytest.mark.slow
def test_a_run_that_shares_has_the_log_of_one_that_does_not(
    tmp_path: Path, cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain = log_of(tmp_path / "plain")
    assert not (cache / "detections").exists()
    assert log_of(tmp_path / "first", share_pictures=True) == plain
    assert {each.name for each in cache.iterdir()} >= {"detections", "pictures"}
    monkeypatch.setattr(EmbeddedDetector, "proposed", None)  # Nothing is looked at again.
    drawn = drawings(monkeypatch)
    assert log_of(tmp_path / "second", share_pictures=True) == plain
    pictures = key_pictures(tmp_path / "second")
    assert pictures == key_pictures(tmp_path / "plain")
    assert 0 < len(drawn) <= len(pictures)


def key_pictures(out: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in (out / "pictures").iterdir()}


def drawings(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """Return a list that grows with each call in which pictures are drawn."""
    drawn: list[object] = []
    ask = RendererProcess.ask

    def counted(renderer: RendererProcess, *asked: Any) -> Any:
        drawn.append(asked)
        return ask(renderer, *asked)

    monkeypatch.setattr(RendererProcess, "ask", counted)
    return drawn


@pytest.mark.slow
def test_pictures_that_another_program_hears_have_their_pixels(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log_of(tmp_path / "first", share_pictures=True)
    sent: list[Any] = []
    worker = Watching(sent)
    run(meeting(), SEEN.model_copy(update={"out": tmp_path / "second", "share_pictures": True,
                                           "detector": "none"}), workers=[worker])  # fmt: skip
    assert len(sent) > 10
    assert all(hashlib.sha256(pixels).hexdigest() == sha256 for sha256, pixels in sent)


class Watching:
    """A worker of the caller that reads all pictures."""

    description = WorkerDescription(
        name="watching", modality="vision", inputs=(InputSpec(key="camera/*/frame"),)
    )

    def __init__(self, sent: list[Any]) -> None:
        self._sent = sent

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        self._sent += [(item.attachment["sha256"], item.payload) for item in inputs]
        return Step()


@pytest.mark.slow
def test_a_killed_renderer_costs_pictures_that_others_have_drawn_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All is known, so it is missed only when somebody reads the pixels of a key picture."""
    log_of(tmp_path / "first", share_pictures=True)
    views = RendererProcess.views

    def killed(renderer: RendererProcess, *asked: Any) -> Any:
        renderer.processes[0].kill()
        return views(renderer, *asked)

    with monkeypatch.context() as patch:
        patch.setattr(RendererProcess, "views", killed)
        log_of(tmp_path / "second", share_pictures=True)
    assert RunFolder(tmp_path / "second").info().phase == "finished"
    *_, state = states_of_vision(tmp_path / "second")
    assert state.state == "lost"
    assert "signal 9" in state.cause
    assert not (tmp_path / "second" / "pictures").exists()
    assert replay(tmp_path / "second").identical


def states_of_vision(out: Path) -> list[Status]:
    log = read_log(out / "log.mcap")
    return [Status.model_validate_json(each.data) for each in log if each.key == "status/vision"]


@pytest.mark.slow
def test_runs_that_go_apart_have_the_logs_that_each_has_alone(tmp_path: Path) -> None:
    """The intruder is met otherwise with each assistant."""
    scenario = load("s02c_intruder_headon")
    for assistant in ("reference", "paper"):
        options = SEEN.model_copy(update={"assistant": assistant, "camera_rate": "adaptive"})
        for shares in (False, True):
            out = tmp_path / f"{assistant}-{shares}"
            run(scenario, options.model_copy(update={"out": out, "share_pictures": shares}))
        alone, shared = (tmp_path / f"{assistant}-{shares}" for shares in (False, True))
        assert (shared / "log.mcap").read_bytes() == (alone / "log.mcap").read_bytes()
        assert key_pictures(shared) == key_pictures(alone)
    one, other = (headers(tmp_path / f"{assistant}-True") for assistant in ("reference", "paper"))
    assert one[:100] == other[:100]
    assert one[-1] != other[-1]


def headers(out: Path) -> list[bytes]:
    return [each.data for each in read_log(out / "log.mcap") if each.key.endswith("/frame")]


def test_measured_latencies_of_vision_cannot_be_shared(tmp_path: Path) -> None:
    with pytest.raises(AirhiltError, match=r"--share-pictures: the latency of vision .*fixed"):
        log_of(tmp_path / "run", share_pictures=True, latency="measured")
