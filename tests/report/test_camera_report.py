"""What the report of a run shows of its cameras."""

from __future__ import annotations

import base64
import os
import shutil
from pathlib import Path
from typing import Any

import pytest

from airhilt.record import RunFolder
from airhilt.report import write_report
from airhilt.report.sections import cameras as camera_section
from camera_run import camera_run
from report_pages import shown as data


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    with pytest.MonkeyPatch.context() as patch:
        return camera_run(tmp_path_factory.mktemp("cameras") / "run", patch).folder


@pytest.fixture
def folder(finished: Path, tmp_path: Path) -> Path:
    """A copy of it to damage."""
    return shutil.copytree(finished, tmp_path / "run")


def shown(folder: Path) -> dict[str, Any]:
    cameras: dict[str, Any] = data(write_report(folder))["sections"]["cameras"]
    return cameras


def test_pictures_lie_in_the_page_as_they_were_written(folder: Path) -> None:
    picture = shown(folder)["pictures"][0]
    kind, _, encoded = picture["src"].partition(",")
    assert kind == "data:image/png;base64"
    (file,) = (folder / "pictures").glob("first_detection-*")
    assert base64.b64decode(encoded) == file.read_bytes()
    assert (picture["width"], picture["height"]) == (640, 360)


def test_a_picture_says_who_was_found_in_it_how_far_off_and_how_late(folder: Path) -> None:
    picture = shown(folder)["pictures"][0]
    (detection,) = picture["detections"]
    (truth,) = picture["truth"]
    assert (detection["label"], detection["confidence"]) == ("airplane", 0.8)
    assert detection["actor"] == truth["actor"]
    assert truth["found"] is True
    assert detection["range_m"] == truth["range_m"] == pytest.approx(4_045, abs=50)
    assert detection["box"] == pytest.approx(truth["box"], abs=3.0)
    assert picture["latency_s"] == pytest.approx(0.05)


def test_each_camera_has_a_timeline_of_what_was_in_view_and_found(folder: Path) -> None:
    timelines = shown(folder)["timelines"]
    assert [(timeline["camera"], timeline["carrier"]) for timeline in timelines] == [
        ("nose-AAL123", "AAL123"), ("nose-DAL456", "DAL456")
    ]  # fmt: skip
    for timeline in timelines:
        (in_view,) = timeline["in_view"]
        assert in_view[0] == 0.0
        assert 5.0 < in_view[1] < 9.0
        assert timeline["found"][0][0] <= timeline["confirmed"][0][0] <= in_view[1]
        assert timeline["false"] == []
        assert (timeline["width_px"], timeline["rate_hz"], timeline["video"]) == (640, 4.0, None)


def test_a_video_is_linked_to(folder: Path, tmp_path: Path) -> None:
    (folder / "video").mkdir()
    (folder / "video" / "nose-AAL123.mp4").touch()
    record_files(folder)
    assert shown(folder)["timelines"][0]["video"] == "video/nose-AAL123.mp4"
    elsewhere = data(write_report(folder, tmp_path / "page.html"))["sections"]["cameras"]
    assert elsewhere["timelines"][0]["video"] == "run/video/nose-AAL123.mp4"


def record_files(folder: Path) -> None:
    """Make the manifest as if the run had written all that is there."""
    paths = RunFolder(folder)
    paths.write_info(paths.info().model_copy(update={"files": paths.manifest()}))


def test_a_picture_or_a_video_that_the_run_did_not_write_is_named_and_not_shown(
    folder: Path,
) -> None:
    (folder / "video").mkdir()
    (folder / "video" / "nose-AAL123.mp4").touch()
    first, *_, last = sorted((folder / "pictures").iterdir())
    first.write_bytes(first.read_bytes() + b"0")
    foreign = last.with_name("first_warning-nose-AAL123-0.png")
    foreign.write_bytes(last.read_bytes())
    before = len(list((folder / "pictures").iterdir()))
    page = data(write_report(folder))
    cameras = page["sections"]["cameras"]
    assert len(cameras["pictures"]) == before - 2
    assert cameras["timelines"][0]["video"] is None
    notes = "\n".join(page["notes"])
    assert f"Damaged: pictures/{first.name}: damaged or changed" in notes
    assert f"Damaged: pictures/{foreign.name}: not written by the run" in notes
    assert "Damaged: video/nose-AAL123.mp4: not written by the run" in notes


@pytest.mark.parametrize("kind", ["link", "pipe", "folder"])
def test_a_picture_that_is_no_file_of_the_run_is_named_and_not_read(
    folder: Path, tmp_path: Path, kind: str
) -> None:
    paths = RunFolder(folder)
    paths.write_info(paths.info().model_copy(update={"phase": "running", "files": {}}))
    picture = next((folder / "pictures").glob("first_detection-*"))
    secret = tmp_path / "passwd"
    secret.write_text("root:x:0:0")
    if kind == "folder":
        shutil.move(folder / "pictures", tmp_path / "pictures")
        (tmp_path / "pictures" / picture.name).write_text("root:x:0:0")
        (folder / "pictures").symlink_to(tmp_path / "pictures")
    else:
        picture.unlink()
        os.mkfifo(picture) if kind == "pipe" else picture.symlink_to(secret)
    page = write_report(folder)
    assert base64.b64encode(secret.read_bytes()).decode() not in page.read_text()
    assert f"{picture.name}: no regular file of its folder" in page.read_text()


def test_pictures_that_have_no_room_are_links_and_the_page_says_so(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(camera_section, "MOST_CHARACTERS", 3_000)
    page = data(write_report(folder))
    links = [one["href"] for one in page["sections"]["cameras"]["pictures"] if "href" in one]
    assert links
    assert all((folder / link).is_file() for link in links)
    assert any(f"no room in this file for {len(links)} pictures" in note for note in page["notes"])


def test_what_is_no_picture_of_the_run_is_not_shown(folder: Path) -> None:
    pictures = folder / "pictures"
    (pictures / "notes.png").write_bytes(b"mine")
    (pictures / "first_warning-nobody-1.png").write_bytes(b"of no camera")
    next(pictures.glob("first_detection-*")).unlink()
    occasions = [picture["occasion"] for picture in shown(folder)["pictures"]]
    assert occasions == ["first_warning", "closest_approach", "start", "start"]
