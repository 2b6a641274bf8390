"""What the report of a run shows of its cameras."""

from __future__ import annotations

import base64
import os
import shutil
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from airhilt.record import LogWriter, RunFolder, read_log
from airhilt.report import write_report
from airhilt.report.intervals import MOST_INTERVALS, BridgedIntervals
from airhilt.report.sections import cameras as camera_section
from airhilt.units import SECOND_NS
from camera_run import camera_run
from report_pages import shown as data
from sightings import vision

HOSTILE = "</script><img src=x onerror=alert(1)>"


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
    assert detection["range_m"] == truth["range_m"] == pytest.approx(4_140, abs=50)
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


def test_pictures_of_a_run_that_was_killed_are_shown_without_a_manifest(folder: Path) -> None:
    whole = len(shown(folder)["pictures"])
    paths = RunFolder(folder)
    paths.write_info(paths.info().model_copy(update={"phase": "running", "files": {}}))
    assert len(shown(folder)["pictures"]) == whole


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


def test_a_run_without_cameras_shows_none(folder: Path) -> None:
    with closing(LogWriter(folder / "log.mcap")):
        pass
    shutil.rmtree(folder / "pictures")
    assert shown(folder) == {"state": "off", "cause": "", "timelines": [], "pictures": []}


def rewrite(folder: Path, *statuses: Any) -> None:
    """Put states of vision in the place of those of the log."""
    kept = [one for one in read_log(folder / "log.mcap") if one.key != "status/vision"]
    with closing(LogWriter(folder / "log.mcap")) as log:
        for one in kept:
            log.write(one.key, one.publisher, type(statuses[0]), one.t_ns, one.data)
        for status in statuses:
            log.write(
                "status/vision", "run", type(status), status.t_ns, status.model_dump_json().encode()
            )


def test_why_vision_was_not_evaluated_is_told_as_data(folder: Path) -> None:
    rewrite(folder, vision("not evaluated", HOSTILE))
    page = write_report(folder)
    assert "onerror=alert(1)>" not in page.read_text()
    cameras = data(page)["sections"]["cameras"]
    assert (cameras["state"], cameras["cause"]) == ("not evaluated", HOSTILE)


# --- intervals ------------------------------------------------------------------------------


def test_short_pauses_are_bridged_and_long_ones_are_not() -> None:
    intervals = BridgedIntervals()
    for t_ns in (0, SECOND_NS // 4, SECOND_NS // 2, 2 * SECOND_NS, 3 * SECOND_NS):
        intervals.add(t_ns)
    assert intervals.as_json() == [(0.0, 0.5), (2.0, 2.0), (3.0, 3.0)]


def test_many_intervals_are_joined_until_there_is_room() -> None:
    intervals = BridgedIntervals()
    for second in range(5_000):
        intervals.add(second * SECOND_NS)
    found = intervals.as_json()
    assert len(found) <= MOST_INTERVALS
    assert (found[0][0], found[-1][1]) == (0.0, 4_999.0)
