"""Pictures with the truth about them can be written to train detectors on."""

from __future__ import annotations

import errno
import hashlib
import itertools
import json
import os
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import numpy as np
import pytest

import airhilt.host.files
from airhilt import load
from airhilt.errors import CameraError, ScenarioError
from airhilt.host import library
from airhilt.imaging.view import Intrinsics, Pose, View
from airhilt.sensors.cameras.dataset.export import export
from airhilt.sensors.cameras.dataset.pictures import (
    Picture,
    Takes,
    random_pictures,
    scenario_pictures,
    split_of,
)
from airhilt.sensors.cameras.dataset.records import run_lengths
from airhilt.sensors.cameras.dataset.scenes import EN_ROUTE, PICTURES_PER_WORLD, Casting
from airhilt.sensors.cameras.frame import Frame

SIZE = (320, 192)


Take = Callable[[int], Iterator[Picture]]


def country(count: int, seed: int = 3, empty: float = 0.0, sequence: int = 1) -> Take:
    takes = Takes(of_world=8, sequence=sequence, empty=empty)
    return lambda first: random_pictures(count, seed, ["en_route"], "embree", SIZE, takes, first)


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
        assert annotation["area"] == covered.sum() > 0
        rows, columns = np.nonzero(covered)
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
    pictures = list(country(6)(0))
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


def test_no_two_places_have_the_same_weather_and_bodies_by_one_seed() -> None:
    takes = Takes(of_world=2, empty=0.0)
    worlds = [
        list(random_pictures(2, 5, [place], "embree", SIZE, takes)) for place in ("rjtt", "lszh")
    ]
    (rjtt, lszh) = worlds
    assert rjtt[0].about["visibility_m"] != lszh[0].about["visibility_m"]
    places = [
        {sighting.range_m for picture in world for sighting in picture.frame.sightings}
        for world in worlds
    ]
    assert not places[0] & places[1]


def test_a_world_is_the_same_whatever_came_before_it() -> None:
    """Airports in the shade are kept from world to world: one without texture, then one with."""
    used, fresh = Casting(["LSZH"], SIZE), Casting(["LSZH"], SIZE)
    plain, textured = (used.sitting(number, 0, "dataset") for number in (8, 10))
    assert plain.light.texture == 0.0 < textured.light.texture
    alone = fresh.sitting(10, 0, "dataset").landscape.mesh
    pairs = zip(alone.arrays, textured.landscape.mesh.arrays, strict=True)
    assert all(np.array_equal(one, other) for one, other in pairs)


def test_every_place_is_in_the_first_hundred_pictures_and_splits_share_no_world() -> None:
    casting = Casting([*library.names("airports"), EN_ROUTE], SIZE)
    worlds = range(100 // PICTURES_PER_WORLD)
    assert len({casting.sitting(number, 0, "dataset").place for number in worlds}) == 6
    splits = Counter(split_of(world, 0) for world in range(50))
    assert splits == {"train": 40, "val": 5, "test": 5}


def test_an_export_that_was_stopped_goes_on_to_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    class Stopped(Exception):
        pass

    def stopping(first: int) -> Iterator[Picture]:
        yield from itertools.islice(country(24)(first), 11)
        raise Stopped

    with pytest.raises(Stopped):
        export(stopping, tmp_path / "part", {"seed": 3})
    assert len(read(tmp_path / "part")["images"]) == 11
    with (tmp_path / "part" / "pictures.jsonl").open("a") as lines:
        lines.write('{"image": {"id": 12')
    export(country(24), tmp_path / "part", {"seed": 3})
    assert contents(tmp_path / "part") == contents(folder)
    with pytest.raises(CameraError, match="holds an export with seed 3; expected 4"):
        export(country(24), tmp_path / "part", {"seed": 4})


def contents(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in folder.rglob("*")
        if path.is_file()
    }


@pytest.fixture(scope="module")
def sequences(tmp_path_factory: pytest.TempPathFactory) -> Path:
    where = tmp_path_factory.mktemp("dataset") / "sequences"
    export(country(12, sequence=4), where, {}, ("coco", "yolo", "mot"), has_depth=True)
    return where


def test_bodies_move_in_a_sequence_and_keep_their_tracks(sequences: Path) -> None:
    (first, *_) = sorted((sequences / "mot").glob("*/*"))
    rows = [line.split(",") for line in (first / "gt" / "gt.txt").read_text().splitlines()]
    assert {int(row[0]) for row in rows} <= {1, 2, 3, 4}
    boxes = {row[1]: {tuple(each[2:6]) for each in rows if each[1] == row[1]} for row in rows}
    assert all(len(each) > 1 for each in boxes.values())
    assert len(list((first / "img1").iterdir())) == 4
    assert "frameRate=10\nseqLength=4" in (first / "seqinfo.ini").read_text()


def test_yolo_has_the_same_boxes_in_parts_of_the_picture(sequences: Path) -> None:
    document = read(sequences)
    for image in document["images"]:
        wanted = [
            (each["category_id"] - 1, *each["bbox"])
            for each in document["annotations"]
            if each["image_id"] == image["id"]
        ]
        lines = (sequences / "labels" / f"{image['id']:06}.txt").read_text().splitlines()
        for line, (number, left, top, width, height) in zip(lines, wanted, strict=True):
            kind, x, y, w, h = (float(part) for part in line.split())
            assert kind == number
            found = (x - w / 2) * SIZE[0], (y - h / 2) * SIZE[1], w * SIZE[0], h * SIZE[1]
            assert found == pytest.approx((left, top, width, height), abs=0.02)
    lists = [sequences / f"{split}.txt" for split in ("train", "val", "test")]
    assert sorted(name for each in lists for name in each.read_text().split()) == [
        f"./images/{n:06}.jpg" for n in range(1, 13)
    ]


def test_depth_and_calibration_put_bodies_at_their_range(sequences: Path) -> None:
    document = read(sequences)
    images = {image["id"]: image for image in document["images"]}
    near = [each for each in document["annotations"] if each["area"] > 200]
    assert near
    for each in near:
        image = images[each["image_id"]]
        depth = np.load(sequences / image["depth"])["depth_m"].astype(float)
        rows, columns = np.nonzero(mask(each["segmentation"]))
        x, y = (
            (places + 0.5 - centre) / image["calibration"]["focal_px"]
            for places, centre in zip(
                (columns, rows), image["calibration"]["principal_point_px"], strict=True
            )
        )
        away = depth[rows, columns] * np.sqrt(x * x + y * y + 1.0)
        assert np.median(away) == pytest.approx(each["range_m"], rel=0.2, abs=30.0)


def test_the_datasheet_counts_what_is_there(sequences: Path) -> None:
    text = (sequences / "datasheet.md").read_text()
    assert "12 drawn pictures" in text
    assert "open country 12" in text


@pytest.mark.slow
def test_at_an_airport_things_stand_on_the_ground_and_cameras_too() -> None:
    pictures = list(random_pictures(30, 1, ["kdca"], "embree", SIZE, Takes(empty=0.0)))
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
        export(frames(0), tmp_path, {})
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def frames(count: int) -> Take:
    """Return what takes grey pictures of nobody."""
    view = View(Intrinsics(32, 16, 1.0), Pose.of((0.0, 0.0, 9.0), 0.0))
    colour = np.full((16, 32, 3), 128, dtype=np.uint8)
    plane = np.zeros((16, 32), dtype=np.uint8)
    frame = Frame("field", 0, view, colour, plane.astype(np.float32), plane, ())
    about = {"airport": None, "visibility_m": 9000.0}
    picture = Picture(frame, (), None, 0, 1, 1, "train", about)
    return lambda first: iter([picture] * (count - first))


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
        (("--width", "0", "--height", "0"), "not in the range 16<=x<=4096"),
        (("--format", "mot"), "expected --sequence N, or --scenario"),
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
