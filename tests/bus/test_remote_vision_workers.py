"""Pictures on their way from a camera to a worker of another process, and detections back."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TypeVar

import pytest

from airhilt import load, run
from airhilt.bus import free_endpoint
from airhilt.messages import CameraFrame, Detections, Message
from airhilt.record import read_log
from airhilt.scenario import Scenario
from airhilt.world.loading import load_text
from paths import EXAMPLES
from processes import process
from shortened import shortened

HASHING_DETECTOR = """
import hashlib, sys
from airhilt.workers import serve
from airhilt.assistant.vision.detector import Found
from airhilt.assistant.vision.worker import VisionWorker
class Hashing:
    name = "hashing"
    threshold = 0.0
    def detect(self, picture):
        number = int(hashlib.sha256(picture.tobytes()).hexdigest()[:12], 16)
        return [Found("airplane", number / 16**12, (0.0, 0.0, 9.0, 9.0))]
serve(VisionWorker(Hashing()), sys.argv[1])
"""


@pytest.fixture(scope="module")
def glance() -> Scenario:
    """A second of a head-on encounter, with small cameras on both noses."""
    document = load("s02a_headon").model_dump(mode="json")
    document["cameras"] = [
        {
            "name": f"nose-{callsign}",
            "mount": {"type": "actor", "actor": callsign, "station": "nose"},
            "width_px": 160,
            "height_px": 90,
            "rate_hz": 8.0,
        }
        for callsign in ("AAL123", "DAL456")
    ]
    document |= {"name": "glance"}
    return load_text(json.dumps(shortened(document, 1.0)), "glance")


Kind = TypeVar("Kind", bound=Message)


def logged(folder: Path, prefix: str, model: type[Kind]) -> list[Kind]:
    return [
        model.model_validate_json(one.data)
        for one in read_log(folder / "log.mcap")
        if one.key.startswith(prefix) and one.key.split("/")[-1] != "info"
    ]


def test_an_attached_detector_gets_every_pixel_and_looks_for_the_run(
    glance: Scenario, tmp_path: Path
) -> None:
    endpoint = free_endpoint()
    with process("-c", HASHING_DETECTOR, endpoint) as detector:
        result = run(
            glance, out=tmp_path / "run", latency="fixed:0.01", speech=False,
            renderer="embree", endpoint=endpoint, attach=("vision",),
        )  # fmt: skip
        assert detector.wait(timeout=10.0) == 0
    frames = {(one.camera, one.seq): one for one in logged(result.folder, "camera/", CameraFrame)}
    told = {(one.camera, one.seq): one for one in logged(result.folder, "vision/", Detections)}
    assert len(told) >= 16
    for place, seen in told.items():
        number = int(frames[place].sha256[:12], 16)
        assert [one.confidence for one in seen.detections] == [number / 16**12]
        assert (seen.t_frame_ns, seen.view) == (frames[place].t_frame_ns, frames[place].view)
        assert 10_000_000 <= seen.t_ns - seen.t_frame_ns <= 40_000_000
    assert result.summary.modalities["vision"] == "on"


@pytest.mark.slow
def test_the_example_detector_looks_for_the_run(glance: Scenario, tmp_path: Path) -> None:
    endpoint = free_endpoint()
    with process(EXAMPLES / "vision_worker.py", endpoint) as detector:
        result = run(
            glance, out=tmp_path / "run", latency="fixed:0.01", speech=False,
            renderer="embree", endpoint=endpoint, attach=("mine",),
        )  # fmt: skip
        assert detector.wait(timeout=10.0) == 0
    told = logged(result.folder, "vision/", Detections)
    assert {one.engine for one in told} == {"mine"}
    assert {one.camera for one in told} == {"nose-AAL123", "nose-DAL456"}
