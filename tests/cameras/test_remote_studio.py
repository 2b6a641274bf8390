"""Pictures come from a process of their own, and its end is an error with a name."""

from __future__ import annotations

import math
import os
import signal
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from airhilt import load
from airhilt.actors import build_cast
from airhilt.cameras.bodies import BodyState, state_of
from airhilt.cameras.mounts import frame_of
from airhilt.cameras.remote import RemoteStudio
from airhilt.cameras.still import TICK_S, still, write_png
from airhilt.errors import CameraError, RendererError
from airhilt.scenario import Scenario
from airhilt.scenario.geometry import Setting

pytest.importorskip("moderngl")

CAMERA = {
    "name": "field",
    "mount": {
        "type": "fixed",
        "position": {"type": "runway", "runway": "01", "along_m": 300, "offset_m": 80},
        "height_ft": 20,
        "azimuth_deg": 180,
    },
    "width_px": 160,
    "height_px": 90,
}


def washington(**camera: object) -> Scenario:
    document = load("s01b_nominal").model_dump(mode="json")
    document["cameras"] = [CAMERA | camera]
    return Scenario.model_validate(document)


def bodies_of(scenario: Scenario) -> list[BodyState]:
    setting = Setting.of(scenario)
    cast = build_cast(scenario, setting, 0, TICK_S)
    frame = frame_of(setting)
    return [state_of(performer, frame, setting.ground_m, 0.0) for performer in cast.values()]


@pytest.fixture(scope="module")
def bodies() -> list[BodyState]:
    return bodies_of(washington())


@pytest.fixture(scope="module")
def studio() -> Iterator[RemoteStudio]:
    with RemoteStudio(washington(), renderer="moderngl") as opened:
        yield opened


def test_a_picture_comes_with_its_truth(studio: RemoteStudio, bodies: list[BodyState]) -> None:
    frame = studio.shoot(["field"], bodies, 7)[0]
    assert frame.t_ns == 7
    assert frame.colour.shape == (90, 160, 3)
    assert frame.colour.std() > 5.0
    assert [sighting.actor for sighting in frame.sightings] == ["AAL123"]
    assert frame.sightings[0].range_m == pytest.approx(4.0 * 1852.0, rel=0.1)
    assert np.isinf(frame.distance_m[0]).all()


def test_a_pose_that_is_not_finite_is_refused_and_the_next_is_drawn(
    studio: RemoteStudio, bodies: list[BodyState]
) -> None:
    lost = [bodies[0]._replace(up_m=math.nan), *bodies[1:]]
    with pytest.raises(CameraError, match="finite"):
        studio.shoot(["field"], lost, 0)
    assert studio.shoot(["field"], bodies, 0)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"mount": CAMERA["mount"] | {"height_ft": -3}}, "above the ground"),
        (
            {
                "mount": {
                    "type": "fixed",
                    "position": {"type": "geodetic", "lat_deg": 38.853, "lon_deg": -77.0427},
                    "height_ft": 20,
                    "azimuth_deg": 0,
                }
            },
            "inside 'Terminal 2'",
        ),
    ],
)
def test_a_camera_that_stands_in_something_is_refused(
    changes: dict[str, object], said: str
) -> None:
    with pytest.raises(CameraError, match=said):
        RemoteStudio(washington(**changes), renderer="moderngl")


def test_a_camera_that_nobody_has_declared_is_refused_with_the_nearest() -> None:
    with pytest.raises(CameraError, match="did you mean 'runway_01'"):
        RemoteStudio(washington(), ["runway_011"], "moderngl")


def test_a_still_is_written_as_a_png(tmp_path: Path) -> None:
    pytest.importorskip("PIL")
    frame = still(washington(), "field", 1.0, renderer="moderngl")
    write_png(frame, tmp_path / "still.png", boxes=True)
    assert (tmp_path / "still.png").read_bytes().startswith(b"\x89PNG")


# The last: it leaves nothing to draw with.
def test_the_death_of_the_process_is_an_error_with_a_name(
    studio: RemoteStudio, bodies: list[BodyState]
) -> None:
    os.kill(studio.process_id, signal.SIGKILL)
    with pytest.raises(RendererError, match=r"moderngl has ended \(signal 9\)"):
        studio.shoot(["field"], bodies, 0)
