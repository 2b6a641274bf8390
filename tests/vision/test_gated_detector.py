"""The embedded detector behind the watch for changes, on pictures of a landing."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

pytest.importorskip("moderngl")
from pictures import camera_view

from airhilt import load
from airhilt.actors import build_cast
from airhilt.boxes import overlap
from airhilt.cameras.bodies import state_of
from airhilt.cameras.mounts import frame_of
from airhilt.cameras.remote import RemoteStudio
from airhilt.scenario.geometry import Setting
from airhilt.scenario.loading import draw
from airhilt.units import seconds_to_ns
from airhilt.workers.vision.detector import Detector, Found, Picture
from airhilt.workers.vision.embedded import EmbeddedDetector
from airhilt.workers.vision.gating import Gate, GateSettings

TICK_S = 0.05
BEFORE_TICKS = 1_960
"""Up to when the aircraft is a kilometre from the camera."""
CAMERA = "tower_south"
REACH_PX = 32.0
"""See docs/vision.md."""
LEAST = 0.2
SURE = 0.25
"""Confidence from which findings are compared, with all that is found from `LEAST` on."""
LEAST_COMPARED = 40
"""One in every second picture."""
MOST_LACKING = 0.02
"""Share of findings that may be somewhere else, or nowhere."""
MOST_APART = 0.03
"""In confidence."""


@pytest.fixture(scope="module")
def landing() -> list[Picture]:
    """Pictures of four seconds."""
    realised, _ = draw(load("s01b_noncompliance"), 0)
    setting = Setting.of(realised)
    frame = frame_of(setting)
    pictures = []
    with RemoteStudio(realised, [CAMERA], "moderngl") as studio:
        cast = build_cast(realised, setting, 0, TICK_S)
        for tick in range(1, BEFORE_TICKS + 81):
            for performer in cast.values():
                performer.body.advance()
            if tick > BEFORE_TICKS:
                t_s = tick * TICK_S
                bodies = [state_of(one, frame, setting.ground_m, t_s) for one in cast.values()]
                (shot,) = studio.shoot([CAMERA], bodies, seconds_to_ns(t_s))
                pictures.append(shot.colour.copy())
    return pictures


class Counted:
    """A detector, and how many pixels it has looked at."""

    def __init__(self, detector: Detector) -> None:
        self.name = detector.name
        self.pixels = 0
        self._detector = detector

    def detect(self, picture: Picture) -> Sequence[Found]:
        self.pixels += picture.shape[0] * picture.shape[1]
        return self._detector.detect(picture)


@pytest.mark.slow
def test_what_is_found_hardly_depends_on_windows(landing: list[Picture]) -> None:
    rows, columns = landing[0].shape[:2]
    view = camera_view(columns, rows)
    detector = Counted(EmbeddedDetector(threshold=LEAST))
    whole = [list(detector.detect(picture)) for picture in landing]
    looked_at, detector.pixels = detector.pixels, 0
    gate = Gate(detector, GateSettings.of_reach(REACH_PX))
    gated = [
        gate.look(CAMERA, view, seconds_to_ns(TICK_S * index), picture)
        for index, picture in enumerate(landing)
    ]
    assert detector.pixels < 0.8 * looked_at
    for some, others in ((whole, gated), (gated, whole)):
        apart = compared(some, others)
        assert len(apart) >= LEAST_COMPARED
        assert apart.count(None) <= MOST_LACKING * len(apart)
        assert max(one for one in apart if one is not None) <= MOST_APART


def compared(some: list[list[Found]], others: list[list[Found]]) -> list[float | None]:
    """Return for what is in some pictures how its confidence differs in others, None if lacking."""
    return [
        min(
            (
                abs(one.confidence - its.confidence)
                for its in other
                if one.label == its.label and overlap(one.box, its.box) > 0.5
            ),
            default=None,
        )
        for found, other in zip(some, others, strict=True)
        for one in found
        if one.confidence >= SURE
    ]
