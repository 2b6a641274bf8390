"""Pictures come from a process of their own, and its end is an error with a name."""

from __future__ import annotations

import errno
import hashlib
import math
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from airhilt import load
from airhilt.errors import CameraError, RendererError, RendererLost
from airhilt.imaging.view import Intrinsics, Pose, View
from airhilt.scenario import Scenario
from airhilt.sensors.cameras import renderer_process
from airhilt.sensors.cameras.frame import CameraPicture
from airhilt.sensors.cameras.renderer_process import RendererProcess, probe
from airhilt.sensors.cameras.renderers import open3d, require_renderer
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.snapshot import TICK_S, snapshot, write_png
from airhilt.world.actors import build_actors
from airhilt.world.site import ScenarioSite
from opening_bodies import bodies_of

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


def washington(**camera: Any) -> Scenario:
    document = load("s01b_nominal").model_dump(mode="json")
    document["cameras"] = [CAMERA | camera]
    return Scenario.model_validate(document)


@pytest.fixture(scope="module")
def bodies() -> list[BodyState]:
    return bodies_of(washington())


@pytest.fixture(scope="module")
def process() -> Iterator[RendererProcess]:
    with RendererProcess(washington(), renderer="embree") as opened:
        yield opened


def test_a_picture_comes_with_its_truth(process: RendererProcess, bodies: list[BodyState]) -> None:
    (picture,) = process.take(["field"], bodies, 7)
    assert picture.colour.shape == (90, 160, 3)
    assert picture.colour.std() > 5.0
    assert picture.sha256 == hashlib.sha256(bytes(picture.pixels)).hexdigest()
    assert [sighting.actor for sighting in picture.sightings] == ["AAL123"]
    assert picture.sightings[0].range_m == pytest.approx(4.0 * 1852.0, rel=0.1)


def test_a_pose_that_is_not_finite_is_refused_and_the_next_is_drawn(
    process: RendererProcess, bodies: list[BodyState]
) -> None:
    lost = [bodies[0]._replace(up_m=math.nan), *bodies[1:]]
    with pytest.raises(CameraError, match="finite"):
        process.take(["field"], lost, 0)
    assert process.take(["field"], bodies, 0)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"mount": CAMERA["mount"] | {"height_ft": 0}}, "above the ground"),
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
        RendererProcess(washington(**changes), renderer="embree")


def test_a_camera_that_nobody_has_declared_is_refused_with_the_nearest() -> None:
    with pytest.raises(CameraError, match="did you mean 'runway_01'"):
        RendererProcess(washington(), ["runway_011"], "embree")


def test_a_still_is_written_as_a_png(tmp_path: Path) -> None:
    frame = snapshot(washington(), "field", 1.0, renderer="embree")
    write_png(frame, tmp_path / "still.png", boxes=True)
    assert (tmp_path / "still.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_a_still_between_two_ticks_shows_bodies_further_on() -> None:
    """As the run's own picture of that time does, which a tick is too coarse for."""
    scenario = washington()
    early, late = (snapshot(scenario, "field", at_s, renderer="embree") for at_s in (4.0, 4.04))
    site = ScenarioSite.of(scenario)
    cast = build_actors(scenario, site, 0, TICK_S)
    for _ in range(80):
        for actor in cast.values():
            actor.body.advance()
    speed = cast["AAL123"].body.state.ground_speed_m_s
    nearer_m = early.sightings[0].range_m - late.sightings[0].range_m
    assert nearer_m == pytest.approx(0.04 * speed, rel=0.05)


def test_a_still_that_cannot_be_written_is_named_with_what_to_do(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    view = View(Intrinsics(32, 16, 1.0), Pose.of((0.0, 0.0, 9.0), 0.0))
    blank = CameraPicture("field", view, (), "", bytes(3 * 32 * 16))
    with pytest.raises(CameraError, match=r"a\.png: cannot be written: Not a dir.* another --out"):
        write_png(blank, tmp_path / "file" / "a.png")


def test_a_renderer_that_cannot_be_started_is_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(subprocess, "Popen", full_disk)
    with pytest.raises(RendererLost, match="cannot be started: No space left"):
        RendererProcess(washington(), ["runway_01"], "embree")


def full_disk(*_: object, **__: Any) -> None:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_renderer_without_its_libraries_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pytest.importorskip("moderngl")
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere")
    for attempt in (
        lambda: probe("moderngl"),
        lambda: RendererProcess(washington(), None, "moderngl"),
    ):
        with pytest.raises(RendererError, match=r"apt install .*libegl1") as caught:
            attempt()
        assert "\n" not in str(caught.value)


def test_open3d_without_its_libraries_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(open3d, "_bindings", lacks_a_library)
    with pytest.raises(RendererError, match=r"apt install libgl1 .*libGL.*--renderer embree"):
        require_renderer("open3d")


def lacks_a_library() -> None:
    raise ImportError("libGL.so.1: cannot open shared object file")


def test_embree_without_its_package_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "embreex.rtcore", None)
    with pytest.raises(RendererError, match="pip install embreex"):
        require_renderer("embree")


def test_the_renderer_imports_nothing_from_the_folder_in_which_it_starts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "json.py").write_text("raise SystemExit('a file of the user')")
    monkeypatch.chdir(tmp_path)
    probe("embree")


def test_the_renderer_is_that_of_the_package_that_starts_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A checkout that is not installed has its own renderer too."""
    package = tmp_path / "airhilt" / "sensors" / "cameras"
    package.mkdir(parents=True)
    for folder in (package, package.parent, package.parent.parent):
        (folder / "__init__.py").touch()
    (package / "renderer_server.py").write_text("raise SystemExit('the one of this path')")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", ["", *sys.path])
    with pytest.raises(RendererError, match="the one of this path"):
        probe("embree")


@pytest.mark.slow
def test_a_renderer_that_hangs_is_given_up_and_says_what_to_do(
    bodies: list[BodyState], monkeypatch: pytest.MonkeyPatch
) -> None:
    with RendererProcess(washington(), renderer="embree") as opened:
        monkeypatch.setattr(renderer_process, "PATIENCE_S", 2.0)
        os.kill(opened.processes[0].process_id, signal.SIGSTOP)
        with pytest.raises(RendererLost, match=r"not answered for 2 s.*take smaller"):
            opened.take(["field"], bodies, 0)


@pytest.mark.slow
def test_memory_stays_flat_over_10000_pictures(
    process: RendererProcess, bodies: list[BodyState]
) -> None:
    held = []
    for number in range(10_001):
        shift = number % 50
        process.take(["field"], [one._replace(east_m=one.east_m + shift) for one in bodies], 0)
        if number in (500, 10_000):
            held.append(held_mb(process.processes[0].process_id))
    assert held[1] < 1.02 * held[0]
    assert held[1] < 1000.0


def held_mb(process_id: int) -> float:
    """Return the memory that a process holds, where the system tells it."""
    status = Path(f"/proc/{process_id}/status")
    if not status.exists():
        pytest.skip("this system has no /proc")
    lines = dict(line.split(":", 1) for line in status.read_text().splitlines())
    return float(lines["VmRSS"].split()[0]) / 1024.0


def test_nothing_is_drawn_again_when_nothing_changes(process: RendererProcess) -> None:
    first, again = (process.take(["field"], [], t_ns)[0] for t_ns in (0, 1))
    assert again.pixels is first.pixels
    assert again.sha256 == first.sha256


# The last: it leaves nothing to draw with.
def test_the_death_of_the_process_is_an_error_with_a_name(
    process: RendererProcess, bodies: list[BodyState]
) -> None:
    process.processes[0].kill()
    with pytest.raises(RendererError, match=r"embree has ended \(signal 9\)"):
        process.take(["field"], bodies, 0)
