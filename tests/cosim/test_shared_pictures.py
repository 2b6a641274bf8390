"""Runs that share what is costly about pictures: the same logs as without sharing."""

from __future__ import annotations

from pathlib import Path

import pytest

from airhilt import load
from airhilt.assistant.vision.detectors.embedded import EmbeddedDetector
from airhilt.cosim.simulation import run
from airhilt.errors import AirhiltError
from airhilt.options import Options
from airhilt.scenario import Scenario

SEEN = Options(renderer="embree", speech=False, latency="fixed")


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "airhilt"


def meeting() -> Scenario:
    """Return a second of two aircraft that fly at each other 3 km apart."""
    document = load("s02a_headon").model_dump(mode="json")
    for actor in document["actors"]:
        actor["initial"]["position"]["distance_nm"] = 0.8
    for camera in document["cameras"]:
        camera["rate_hz"] = 8.0
    return Scenario.model_validate(document | {"name": "meeting", "duration_s": 1.0})


def log_of(out: Path, **options: object) -> bytes:
    run(meeting(), Options.model_validate({**SEEN.model_dump(), "out": out, **options}))
    return (out / "log.mcap").read_bytes()


def test_a_run_that_shares_has_the_log_of_one_that_does_not(
    tmp_path: Path, cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain = log_of(tmp_path / "plain")
    assert not (cache / "detections").exists()
    assert log_of(tmp_path / "first", share_pictures=True) == plain
    assert {each.name for each in cache.iterdir()} >= {"detections", "rays"}
    monkeypatch.setattr(EmbeddedDetector, "proposed", None)  # Nothing is looked at again.
    assert log_of(tmp_path / "second", share_pictures=True) == plain


def test_measured_latencies_of_vision_cannot_be_shared(tmp_path: Path) -> None:
    with pytest.raises(AirhiltError, match=r"--share-pictures: with --latency measured .*fixed"):
        log_of(tmp_path / "run", share_pictures=True, latency="measured")


def test_without_cameras_there_is_nothing_to_share(tmp_path: Path) -> None:
    options = Options(cameras=False, share_pictures=True, latency="fixed", out=tmp_path / "run")
    with pytest.raises(AirhiltError, match="--share-pictures would do nothing with --no-cameras"):
        run(meeting(), options)
