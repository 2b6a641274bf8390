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
from airhilt.host.child_process import ChildProcess
from airhilt.scenario import Scenario
from airhilt.sensors.cameras import renderer_process
from airhilt.sensors.cameras.renderer_process import RendererProcess, probe
from airhilt.sensors.cameras.renderers import open3d, require_renderer
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.snapshot import snapshot, write_png
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


def test_a_still_is_written_as_a_png_or_the_reason_is_told(tmp_path: Path) -> None:
    picture = snapshot(washington(), "field", 1.0, renderer="embree")
    write_png(picture, tmp_path / "file", boxes=True)
    assert (tmp_path / "file").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(CameraError, match=r"a\.png: cannot be written: Not a dir.* another --out"):
        write_png(picture, tmp_path / "file" / "a.png")


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


def test_a_renderer_that_cannot_be_started_is_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: Any) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(subprocess, "Popen", full)
    with pytest.raises(RendererLost, match="cannot be started: No space left"):
        RendererProcess(washington(), ["runway_01"], "embree")


def test_ray_casters_without_their_libraries_say_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def lacks_a_library() -> None:
        raise ImportError("libGL.so.1: cannot open shared object file")

    monkeypatch.setattr(open3d, "_bindings", lacks_a_library)
    with pytest.raises(RendererError, match=r"apt install libgl1 .*libGL.*--renderer embree"):
        require_renderer("open3d")
    monkeypatch.setitem(sys.modules, "embreex.rtcore", None)
    with pytest.raises(RendererError, match="pip install embreex"):
        require_renderer("embree")


def test_the_renderer_imports_nothing_from_the_folder_in_which_it_starts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "json.py").write_text("raise SystemExit('a file of the user')")
    monkeypatch.chdir(tmp_path)
    probe("embree")


def test_a_process_that_draws_does_without_crews_and_phraseology() -> None:
    code = (
        f"import sys, {renderer_process.MODULE}; "
        "sys.exit(bool({'airhilt.world.actors', 'airhilt.phraseology'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_renderer_is_given_more_time_for_more_to_draw(monkeypatch: pytest.MonkeyPatch) -> None:
    """A fixed camera's first picture has 3 x 3 samples in each pixel, or more."""
    waited = []

    def note(_: ChildProcess, patience_s: float) -> None:
        waited.append(patience_s)
        raise RendererError("noted")

    monkeypatch.setattr(renderer_process, "SLOWEST_SAMPLES_PER_S", 1600.0)
    monkeypatch.setattr(ChildProcess, "answer", note)
    for supersampling in (1, 4):
        with pytest.raises(RendererError, match="noted"):
            RendererProcess(washington(), None, "embree", supersampling)
    assert waited == [120.0 + 9.0 * 9.0, 120.0 + 16.0 * 9.0]


@pytest.mark.slow
def test_a_renderer_that_hangs_is_given_up_and_says_what_to_do(
    bodies: list[BodyState], monkeypatch: pytest.MonkeyPatch
) -> None:
    with RendererProcess(washington(), renderer="embree") as opened:
        monkeypatch.setattr(renderer_process, "PATIENCE_S", 1.0)
        os.kill(opened.processes[0].process_id, signal.SIGSTOP)
        with pytest.raises(RendererLost, match=r"not answered for 2 s.*take smaller"):
            opened.take(["field"], bodies, 0)


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
