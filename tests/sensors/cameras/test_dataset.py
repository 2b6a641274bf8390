"""Pictures with the truth about them can be written to train detectors on."""

from __future__ import annotations

import errno
import hashlib
import json
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import numpy as np
import pytest

import airhilt.host.files
from airhilt import load
from airhilt.errors import CameraError, ScenarioError
from airhilt.imaging.view import Intrinsics, Pose, View
from airhilt.sensors.cameras.dataset.coco import (
    Picture,
    export,
    random_pictures,
    run_lengths,
    scenario_pictures,
)
from airhilt.sensors.cameras.frame import Frame

SIZE = (320, 192)


def country(count: int, seed: int = 3, empty: float = 0.0) -> Iterator[Picture]:
    return random_pictures(count, seed, ["en_route"], "embree", SIZE, empty)


def read(folder: Path) -> dict[str, Any]:
    document: dict[str, Any] = json.loads((folder / "annotations.json").read_text())
    return document


def mask(segmentation: dict[str, list[int]]) -> np.ndarray:
    """Return the mask of run lengths, as COCO's own reader does."""
    rows, columns = segmentation["size"]
    filled = np.arange(len(segmentation["counts"])) % 2 == 1
    return np.repeat(filled, segmentation["counts"]).reshape(columns, rows).T


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    where = tmp_path_factory.mktemp("dataset") / "country"
    export(country(24), where, {"seed": 3})
    return where


@pytest.fixture(scope="module")
def empty_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    where = tmp_path_factory.mktemp("dataset") / "empty"
    export(country(6, seed=4, empty=1.0), where, {"seed": 4})
    return where


def test_boxes_lie_in_the_pictures_and_masks_in_the_boxes(folder: Path) -> None:
    document = read(folder)
    images = {image["id"]: image for image in document["images"]}
    assert len(document["annotations"]) >= 24
    for annotation in document["annotations"]:
        image = images[annotation["image_id"]]
        left, top, width, height = annotation["bbox"]
        assert left >= 0.0
        assert top >= 0.0
        assert left + width <= image["width"] + 0.02
        assert top + height <= image["height"] + 0.02
        covered = mask(annotation["segmentation"])
        assert covered.shape == (image["height"], image["width"])
        rows, columns = np.nonzero(covered)
        if len(rows):
            assert left - 1.0 <= columns.min()
            assert columns.max() <= left + width + 1.0
            assert top - 1.0 <= rows.min()
            assert rows.max() <= top + height + 1.0


def test_what_coco_has_no_word_for_stands_beside_it(folder: Path) -> None:
    document = read(folder)
    for image in document["images"]:
        assert image["airport"] is None
        assert 300.0 < image["visibility_m"] <= 30_000.0
        assert 9.0 < image["horizontal_fov_deg"] < 80.0
        assert 0.0 <= image["solar_time_h"] < 24.0
        assert image["camera_kind"] in ("nose", "tail")
    for annotation in document["annotations"]:
        assert annotation["iscrowd"] == 0
        assert annotation["range_m"] > 0.0
        assert 0.0 < annotation["visible_fraction"] <= 1.0
        assert 0.0 <= annotation["truncation"] < 1.0
        assert 0.0 < annotation["transmission"] <= 1.0
    assert [category["name"] for category in document["categories"]] == [
        "airplane", "truck", "bird", "deer", "coyote"
    ]  # fmt: skip


def test_the_own_aircraft_has_a_mask_beside_the_picture_and_no_annotation(folder: Path) -> None:
    pictures = list(country(6))
    for image, picture in zip(read(folder)["images"][:6], pictures, strict=True):
        assert picture.carrier is not None
        number = picture.actors.index(picture.carrier) + 1
        assert np.array_equal(mask(image["own_aircraft"]), picture.frame.instance == number)
    assert not any(each["actor"].startswith("carrier") for each in read(folder)["annotations"])
    shares = {
        station: [
            mask(image["own_aircraft"]).mean()
            for image in read(folder)["images"]
            if image["camera_kind"] == station
        ]
        for station in ("nose", "tail")
    }
    assert max(shares["nose"]) == 0.0
    assert max(shares["tail"]) > 0.0  # Of some types the tailplane is in view.


def test_the_same_seed_gives_the_same_bytes_and_another_does_not(
    folder: Path, empty_folder: Path, tmp_path: Path
) -> None:
    def digests(where: Path) -> list[str]:
        files = sorted((where / "images").iterdir())[:6]
        return [hashlib.sha256(file.read_bytes()).hexdigest() for file in files]

    export(country(6), tmp_path / "same", {})
    assert digests(tmp_path / "same") == digests(folder)
    assert not set(digests(empty_folder)) & set(digests(folder))


def test_pictures_can_all_be_empty(empty_folder: Path) -> None:
    document = read(empty_folder)
    assert len(document["images"]) == 6
    assert not document["annotations"]


@pytest.mark.slow
def test_at_an_airport_things_stand_on_the_ground_and_cameras_too() -> None:
    pictures = list(random_pictures(30, 1, ["kdca"], "embree", SIZE, 0.0))
    assert {picture.about["airport"] for picture in pictures} == {"KDCA"}
    assert {picture.about["camera_kind"] for picture in pictures} >= {"fixed", "nose"}
    labels = {sighting.label for picture in pictures for sighting in picture.frame.sightings}
    assert len(labels) >= 4


def test_a_scenario_shows_what_its_own_cameras_see_as_its_actors_move() -> None:
    scenario = load("s02a_headon")
    names = [camera.name for camera in scenario.cameras]
    pictures = list(scenario_pictures(scenario, 6, 0, "embree", SIZE))
    assert [picture.frame.camera for picture in pictures] == (names * 6)[:6]
    times = [picture.frame.t_ns for picture in pictures]
    assert times == sorted(times)
    assert times[-1] > times[0]
    assert all(picture.frame.colour.shape == (192, 320, 3) for picture in pictures)


def test_a_scenario_without_cameras_is_refused(encounter: Any) -> None:
    with pytest.raises(CameraError, match="declares no cameras"):
        next(scenario_pictures(encounter, 3))


def test_an_airport_that_does_not_exist_is_named() -> None:
    with pytest.raises(ScenarioError, match="no airport named 'kcda'; did you mean 'kdca'"):
        next(random_pictures(1, 0, ["KCDA"]))


def test_a_folder_with_something_in_it_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(CameraError, match="is not empty"):
        export(iter(()), tmp_path, {})
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def frames(count: int) -> Iterator[Picture]:
    """Return grey pictures of nobody."""
    view = View(Intrinsics(32, 16, 1.0), Pose.of((0.0, 0.0, 9.0), 0.0))
    colour = np.full((16, 32, 3), 128, dtype=np.uint8)
    plane = np.zeros((16, 32), dtype=np.uint8)
    frame = Frame("field", 0, view, colour, plane.astype(np.float32), plane, ())
    for _ in range(count):
        yield Picture(frame, (), None, {})


def test_a_folder_that_cannot_be_made_is_named_with_what_to_do(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    for folder in (tmp_path / "file", tmp_path / "file" / "new"):
        with pytest.raises(CameraError, match=r"cannot be written: Not a dir.*another --out"):
            export(frames(1), folder, {})


def test_of_a_full_disk_the_truth_tells_what_is_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_new = airhilt.host.files.write_new

    def filling(path: Path, data: bytes, mode: int) -> None:
        if "000003" in path.name:
            write_new(path, data[:100], mode)
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        write_new(path, data, mode)

    monkeypatch.setattr(airhilt.host.files, "write_new", filling)
    with pytest.raises(CameraError, match=r"part: .*No space left.*make room") as caught:
        export(frames(5), tmp_path / "part", {})
    assert "\n" not in str(caught.value)
    written = sorted(path.name for path in (tmp_path / "part" / "images").iterdir())
    assert written == ["000001.jpg", "000002.jpg"]
    assert len(read(tmp_path / "part")["images"]) == 2


def test_run_lengths_go_down_the_columns_and_begin_with_what_is_free() -> None:
    covered = np.array([[True, False], [True, True]])
    assert run_lengths(covered) == {"size": [2, 2], "counts": [0, 2, 1, 1]}
    assert run_lengths(np.zeros((2, 3), dtype=bool)) == {"size": [2, 3], "counts": [6]}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--airport", "KCDA"), "did you mean 'kdca'"),
        (("--scenario", "s02a_headon", "--airport", "KDCA"), "only one of"),
        (("--width", "640"), "--width and --height"),
        (("--width", "100000", "--height", "360"), "not in the range 16<=x<=4096"),
    ],
)
def test_bad_input_is_named(
    airhilt_command: Callable[..., CompletedProcess[str]],
    arguments: tuple[str, ...],
    message: str,
) -> None:
    answer = airhilt_command("dataset", "export", "--out", "out", "--images", "2", *arguments)
    assert answer.returncode == 2
    assert message in answer.stderr
    assert "Traceback" not in answer.stderr
