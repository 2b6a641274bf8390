"""The page is told what a run folder has."""

from __future__ import annotations

import io
import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from airhilt.audio.wav import read_wav
from airhilt.errors import AirhiltError, StationError
from airhilt.record import Run, open_run
from airhilt.record.kept_pictures import kept_pictures
from airhilt.record.pictures import PictureName
from airhilt.report.frequency import read_frequency
from airhilt.station.app import debrief_app
from airhilt.station.debrief import Debrief
from camera_run import camera_run
from stations import asked


@pytest.fixture(scope="module")
def debrief(spoken_run: Path) -> Iterator[Debrief]:
    debrief = Debrief(open_run(spoken_run))
    yield debrief
    debrief.close()


@pytest.fixture(scope="module")
def filmed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Debrief]:
    with pytest.MonkeyPatch.context() as patch:
        folder = camera_run(tmp_path_factory.mktemp("filmed") / "run", patch).folder
    debrief = Debrief(open_run(folder))
    yield debrief
    debrief.close()


def test_a_call_has_what_was_said_and_what_was_recognised(debrief: Debrief) -> None:
    call = debrief.document["calls"][0]
    assert call["speaker"] == "AAL123"
    assert "flight level" in call["said"]
    transcript = call["transcripts"][0]
    assert 0.0 < transcript["confidence"] <= 1.0
    assert [word["text"] for word in transcript["words"]] == transcript["text"].split()


def test_an_advisory_has_all_its_recipients_and_its_evidence(debrief: Debrief) -> None:
    advisory = debrief.document["advisories"][0]
    assert {text["recipient"] for text in advisory["texts"]} >= {"ATC", "DAL456"}
    assert "adsb" in advisory["evidence"]["sources"]


def test_a_frequency_sounds_as_listen_writes_it(debrief: Debrief, spoken_run: Path) -> None:
    khz = next(name for name in debrief.document["sounds"] if name.isdigit())
    written = read_wav(debrief.sounds.wav(khz))
    expected = np.concatenate([*read_frequency(open_run(spoken_run), int(khz)).sound.pieces()])
    assert len(written) == len(expected)
    assert abs(written - expected).max() < 1e-4


def test_the_voice_of_the_assistant_begins_when_it_did(debrief: Debrief) -> None:
    voice = read_wav(debrief.sounds.wav("assistant"))
    begin = round(debrief.document["spoken"][0]["from"] * 16_000)
    assert not voice[: begin - 16].any()
    assert voice[begin : begin + 8_000].any()


def test_the_run_folder_is_not_changed(spoken_run: Path) -> None:
    before = {path: path.stat().st_mtime_ns for path in spoken_run.rglob("*")}
    debrief = Debrief(open_run(spoken_run))
    for name in debrief.document["sounds"]:
        debrief.sounds.wav(name)
    debrief.close()
    assert {path: path.stat().st_mtime_ns for path in spoken_run.rglob("*")} == before


def test_a_sound_that_is_not_there_is_named(debrief: Debrief) -> None:
    with pytest.raises(StationError, match=r"'\.\./run\.json': not in this run"):
        debrief.sounds.wav("../run.json")


def test_a_picture_has_the_boxes_of_the_detector_and_the_true_ones(filmed: Debrief) -> None:
    camera = filmed.camera("nose-AAL123")
    assert camera["t"] == sorted(camera["t"])
    assert any(found and found["boxes"] for found in camera["found"])
    assert any(there for there in camera["there"])


def first_detection(folder: Path) -> tuple[Path, PictureName]:
    path = next((folder / "pictures").glob("first_detection-*.png"))
    name = PictureName.of(path)
    assert name is not None
    return path, name


def without_manifest(folder: Path) -> Run:
    """Open a run as one that was killed, which has no record of its pictures."""
    run = open_run(folder)
    run.info = run.info.model_copy(update={"files": {}, "phase": "running"})
    return run


def test_a_picture_that_the_run_has_kept_is_shown_as_it_was(
    tmp_path: Path, filmed: Debrief
) -> None:
    folder = Path(shutil.copytree(filmed.document["folder"], tmp_path / "run"))
    path, kept = first_detection(folder)
    ramp = np.mgrid[0:360, 0:640].sum(axis=0) / 4.0
    colours = np.stack([ramp, 255.0 - ramp, ramp / 2.0], axis=-1).astype(np.uint8)
    Image.fromarray(colours).save(path)
    debrief = Debrief(without_manifest(folder))
    shown = np.asarray(Image.open(io.BytesIO(debrief.picture(kept.camera, kept.seq))))
    assert np.abs(shown.astype(float) - colours).mean() < 3.0
    of_camera = [PictureName.of(one) for one in path.parent.glob("*.png")]
    assert debrief.camera(kept.camera)["kept"] == sorted(
        {one.seq for one in of_camera if one is not None and one.camera == kept.camera}
    )
    debrief.close()


def test_a_picture_that_was_changed_is_told_and_not_used(tmp_path: Path, filmed: Debrief) -> None:
    folder = Path(shutil.copytree(filmed.document["folder"], tmp_path / "run"))
    path, kept = first_detection(folder)
    assert filmed.document["notes"] == []
    assert kept.seq in filmed.camera(kept.camera)["kept"]
    Image.new("RGB", (64, 48)).save(path)
    debrief = Debrief(open_run(folder))
    assert f"Damaged: pictures/{path.name}" in " ".join(debrief.document["notes"])
    assert kept.seq not in debrief.camera(kept.camera)["kept"]
    debrief.close()


def test_what_is_no_picture_is_told_and_not_used(tmp_path: Path, filmed: Debrief) -> None:
    folder = Path(shutil.copytree(filmed.document["folder"], tmp_path / "run"))
    path, kept = first_detection(folder)
    path.write_bytes(b"no picture")
    pictures, notes = kept_pictures(without_manifest(folder))
    assert notes == [f"Damaged: pictures/{path.name}: cannot be read as a picture. It is not used."]
    assert (kept.camera, kept.seq) not in pictures


@pytest.mark.slow
def test_a_picture_is_drawn_again_by_a_renderer_of_this_machine(filmed: Debrief) -> None:
    """The one of the run is none that is installed."""
    camera = filmed.camera("nose-AAL123")
    jpeg = filmed.picture("nose-AAL123", camera["seq"][5])
    image = Image.open(io.BytesIO(jpeg))
    shown = next(one for one in filmed.document["cameras"] if one["name"] == "nose-AAL123")
    assert image.size == (shown["width_px"], shown["height_px"])
    colours = image.getcolors(1 << 20)
    assert colours is not None
    assert len(colours) > 100


def test_a_picture_or_a_camera_that_is_not_there_is_named(filmed: Debrief) -> None:
    with pytest.raises(AirhiltError, match="no picture 99999"):
        filmed.picture("nose-AAL123", 99_999)
    with pytest.raises(AirhiltError, match="expected nose-AAL123"):
        filmed.camera("roof")


def test_the_server_answers_a_mistake_in_words(debrief: Debrief) -> None:
    answer = asked(debrief_app(debrief), "/api/sounds/nothing.wav")
    assert answer.status_code == 400
    assert "expected" in answer.json()["error"]


def test_no_file_outside_of_the_page_is_served(debrief: Debrief) -> None:
    for name in ("..%2Fapp.py", "%2Fetc%2Fpasswd", "app.py"):
        assert asked(debrief_app(debrief), f"/page/{name}").status_code == 404


def test_what_a_seat_heard_by_its_own_receiver_is_a_sound_of_its_own(noisy_seat: Path) -> None:
    debrief = Debrief(open_run(noisy_seat))
    assert debrief.document["sounds"] == ("119100", "119100@AAL123")
    at_site, at_seat = (read_wav(debrief.sounds.wav(one)) for one in debrief.document["sounds"])
    assert len(at_site) == len(at_seat)
    assert not at_seat[: 4 * 16_000].any()
    assert at_seat[4 * 16_000 :].std() > 0.01
    assert abs(at_seat - at_site).max() > 0.01
    debrief.close()
