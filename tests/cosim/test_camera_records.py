"""What is left of a run with cameras: its numbers, its pictures, its videos."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

from airhilt.cli.progress import print_summary
from airhilt.cosim.replay import replay
from airhilt.cosim.simulation import run
from airhilt.errors import AirhiltError, RendererError, RunFolderError, VideoError
from airhilt.metrics.result import Result
from airhilt.options import Options
from airhilt.record import RunFolder, read_log
from airhilt.record.pictures import PictureName
from airhilt.scenario import Scenario
from airhilt.units import SECOND_NS
from camera_run import camera_run, passing
from oracle import BlankSceneRenderer

FULL = Path("/dev/full")


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Result:
    with pytest.MonkeyPatch.context() as patch:
        return camera_run(tmp_path_factory.mktemp("cameras") / "run", patch)


def test_the_summary_says_what_was_seen(finished: Result) -> None:
    vision = finished.summary.vision
    assert (vision.state, [one.camera for one in vision.cameras]) == (
        "on", ["nose-AAL123", "nose-DAL456"]
    )  # fmt: skip
    assert vision.taken == 2 * 41
    assert vision.looked_at + vision.dropped <= vision.taken
    assert vision.looked_at > 60
    assert 0.5 < vision.recall <= 1.0
    assert vision.false_detections is not None
    assert {first.actor for first in vision.first_detections} == {"AAL123", "DAL456"}
    assert all(4_000 < first.range_m < 4_300 for first in vision.first_detections)
    latency = finished.summary.latencies["vision"]
    assert (latency.n, latency.min_s) == (vision.looked_at, pytest.approx(0.05))


def test_the_pictures_that_matter_are_kept(finished: Result) -> None:
    folder = RunFolder(finished.folder)
    names = [PictureName.of(path) for path in folder.pictures_path.iterdir()]
    assert sorted(name.occasion for name in names if name is not None) == [
        "closest_approach", "first_detection", "first_warning", "start", "start"
    ]  # fmt: skip
    assert set(folder.pictures_path.iterdir()) <= set(folder.results)
    nearest = next(name for name in names if name is not None and name.occasion[0] == "c")
    closest = finished.summary.closest_approach
    assert closest is not None
    assert nearest.seq / 4.0 == pytest.approx(closest.t_s, abs=2.0)


def test_the_terminal_tells_what_was_seen(
    finished: Result, capsys: pytest.CaptureFixture[str]
) -> None:
    print_summary(finished.summary, finished.folder)
    shown = " ".join(capsys.readouterr().out.split())
    assert "vision 2 cameras, 82 pictures" in shown
    assert "recall" in shown
    assert "first seen DAL456 at" in shown


@pytest.mark.slow
def test_pictures_change_nothing_in_the_log(
    finished: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("av")
    again = camera_run(tmp_path / "run", monkeypatch, video=True)
    assert list(read_log(RunFolder(again.folder).log_path)) == list(
        read_log(RunFolder(finished.folder).log_path)
    )


def test_a_video_of_each_camera_lies_in_the_run_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    av = pytest.importorskip("av")
    folder = RunFolder(camera_run(tmp_path / "run", monkeypatch, video=True).folder)
    videos = sorted(folder.video_path.iterdir())
    assert [path.name for path in videos] == ["nose-AAL123.mp4", "nose-DAL456.mp4"]
    assert set(videos) <= set(folder.results)
    with av.open(str(videos[0])) as file:
        assert (file.streams.video[0].frames, file.streams.video[0].average_rate) == (41, 4)


@pytest.mark.slow
def test_a_video_can_be_had_of_a_run_in_which_nobody_looks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("av")
    result = camera_run(tmp_path / "run", monkeypatch, video=True, assistant="none")
    assert len(list(RunFolder(result.folder).video_path.iterdir())) == 2
    vision = result.summary.vision
    assert (vision.state, vision.taken, vision.recall) == ("off", 82, None)
    assert replay(result.folder).identical


def test_videos_and_pictures_of_an_earlier_run_do_not_stay(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("av")
    short = passing().model_copy(update={"duration_s": 1.0})
    camera_run(tmp_path / "run", monkeypatch, short, video=True)
    run(short, Options(out=tmp_path / "run", cameras=False, speech=False, overwrite=True))
    folder = RunFolder(tmp_path / "run")
    assert not [*folder.video_path.iterdir(), *folder.pictures_path.iterdir()]


def test_a_run_without_cameras_keeps_none_and_measures_nothing(
    encounter: Scenario, tmp_path: Path
) -> None:
    short = encounter.model_copy(update={"duration_s": 2.0})
    result = run(short, Options(out=tmp_path / "run", cameras=False, speech=False))
    folder = RunFolder(result.folder)
    assert not folder.pictures_path.exists()
    assert not folder.video_path.exists()
    assert (result.summary.vision.state, result.summary.vision.taken) == ("off", None)
    assert result.summary.latencies["vision"].n == 0


# --- what can go wrong ------------------------------------------------------------------------


def test_a_video_without_pyav_is_refused_before_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "av.codec", None)
    with pytest.raises(VideoError, match="pip install 'airhilt\\[video\\]'"):
        camera_run(tmp_path / "run", monkeypatch, video=True)
    assert not (tmp_path / "run").exists()


def test_a_video_of_no_cameras_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("av")
    blind = passing().model_copy(update={"cameras": ()})
    with pytest.raises(AirhiltError, match="--video: there are no cameras"):
        run(blind, Options(out=tmp_path / "run", video=True))
    assert not (tmp_path / "run").exists()


@pytest.mark.skipif(not FULL.exists(), reason="needs /dev/full")
@pytest.mark.parametrize(
    ("folder", "name"),
    [("video", "nose-AAL123.mp4"), ("pictures", "closest_approach-nose-AAL123-67.png")],
)
def test_a_disk_that_fills_up_with_pictures_stops_the_run_and_keeps_its_log(
    folder: str, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("av")
    place = tmp_path / "run" / folder
    create = RunFolder.create

    def creating(self: RunFolder, overwrite: bool = False) -> None:
        create(self, overwrite)
        place.mkdir(exist_ok=True)
        if folder == "video":
            (place / name).symlink_to(FULL)

    monkeypatch.setattr(RunFolder, "create", creating)
    if folder == "pictures":
        monkeypatch.setattr("PIL.Image.Image.save", full)
    with pytest.raises(RunFolderError, match=r"(No space left|full).*make room"):
        camera_run(tmp_path / "run", monkeypatch, video=folder == "video")
    monkeypatch.undo()
    recorded = RunFolder(tmp_path / "run")
    assert recorded.info().phase == "stopped"
    assert recorded.summary() is not None
    assert list(read_log(recorded.log_path))


def full(*_: object, **__: Any) -> None:
    raise OSError(28, "No space left on device")


def test_vision_that_is_lost_leaves_the_numbers_of_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    dying(monkeypatch, 5.0)
    vision = camera_run(tmp_path / "run", monkeypatch).summary.vision
    assert (vision.state, vision.cause) == ("lost", "the renderer has died")
    assert vision.taken == 2 * 20
    assert vision.recall is not None


@pytest.mark.slow
def test_cameras_are_lost_in_a_replay_at_the_very_moment_at_which_they_were(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("av")
    cameras = [camera.model_copy(update={"rate_hz": 8.0}) for camera in passing().cameras]
    short = passing().model_copy(update={"duration_s": 2.0, "cameras": tuple(cameras)})
    with monkeypatch.context() as patch:
        dying(patch, 1.0)  # There is much else in the log of that instant, before and after.
        result = camera_run(tmp_path / "run", monkeypatch, short, video=True, assistant="none")
    assert result.summary.vision.state == "lost"
    verdict = replay(result.folder)
    assert verdict.identical, verdict.difference


def dying(patch: pytest.MonkeyPatch, at_s: float) -> None:
    """Let the renderer die at a time."""
    take = BlankSceneRenderer.take

    def taking(self: BlankSceneRenderer, names: Any, bodies: Any, t_ns: int) -> Any:
        if t_ns >= at_s * SECOND_NS:
            raise RendererError("the renderer has died")
        return take(self, names, bodies, t_ns)

    patch.setattr(BlankSceneRenderer, "take", taking)
