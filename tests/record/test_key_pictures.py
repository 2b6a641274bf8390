"""A few pictures of each run are kept: of its start, first detection, first warning and closest
approach."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image

from airhilt.errors import RunFolderError
from airhilt.messages import Message, SightingTruth
from airhilt.record.pictures import KeyPictures, Picture, PictureName, WaitingPictures
from airhilt.sim.payload import Payload
from sightings import (
    advisory,
    found,
    frame,
    pixels,
    seen,
    sighting,
    time_ns,
    truth,
    undrawn,
    vision,
)

FULL = Path("/dev/full")
LEFT, RIGHT = (40.0, 30.0, 60.0, 36.0), (100.0, 30.0, 130.0, 40.0)
PAIR = ("AAL123", "DAL456")


class Run:
    """Key pictures of a run that is fed picture by picture; picture n has the grey level n."""

    def __init__(self, folder: Path, actors: tuple[str, ...] = PAIR) -> None:
        self.folder = folder / "pictures"
        self.closest: int | None = None
        """Number of the picture at which the pair was nearest up to now."""
        self.pictures = KeyPictures(
            self.folder,
            actors=actors,
            closest_ns=lambda: None if self.closest is None else time_ns(self.closest),
        )
        self.take(vision("on"))

    def take(self, message: Message, payload: Payload = b"") -> Run:
        self.pictures.take("", message, payload)
        return self

    def shoot(self, seq: int, *sightings: SightingTruth, camera: str = "tower") -> Run:
        self.take(truth(seq, *sightings, camera=camera))
        return self.take(frame(seq, camera), pixels(seq))

    def kept(self) -> set[tuple[str, str, int]]:
        names = [PictureName.of(path) for path in self.folder.glob("*")]
        return {(name.occasion, name.camera, name.seq) for name in names if name is not None}

    def seq_of(self, occasion: str) -> tuple[str, int] | None:
        return next(((camera, seq) for what, camera, seq in self.kept() if what == occasion), None)


@pytest.fixture
def run(tmp_path: Path) -> Run:
    return Run(tmp_path)


def test_the_first_picture_of_each_camera_is_kept_small(run: Run) -> None:
    for seq in range(3):
        run.shoot(seq).shoot(seq, camera="nose-AAL123")
    large = frame(0, "wide", size=(1280, 720))
    run.take(large, pixels(9, (1280, 720)))
    assert run.kept() == {
        ("start", "tower", 0), ("start", "nose-AAL123", 0), ("start", "wide", 0)
    }  # fmt: skip
    with Image.open(run.folder / "start-wide-0.jpg") as image:
        assert image.size == (320, 180)
    with Image.open(run.folder / "start-tower-0.jpg") as image:
        assert image.size == (160, 90)


def test_the_first_detection_is_that_of_an_actor_in_its_own_picture(run: Run) -> None:
    for seq in range(8):
        run.shoot(seq, sighting(LEFT), sighting(RIGHT, "OPS1", label="truck"))
    run.take(seen(2, found((0.0, 60.0, 20.0, 80.0))))
    run.take(seen(3, found(RIGHT, label="truck")))
    assert run.seq_of("first_detection") is None, "neither was about one of the pair"
    run.take(seen(5, found(LEFT))).take(seen(6, found(LEFT)))
    assert run.seq_of("first_detection") == ("tower", 5)
    with Image.open(run.folder / "first_detection-tower-5.png") as image:
        assert (image.size, image.getpixel((50, 50))) == ((160, 90), (5, 5, 5))


def test_the_first_warning_is_shown_as_whoever_gave_it_had_seen_it(run: Run) -> None:
    """The newest picture that was looked at, of the camera that shows the pair largest."""
    for seq in range(6):
        run.shoot(seq, sighting(LEFT)).shoot(seq, sighting(RIGHT), camera="runway")
    run.take(seen(3)).take(seen(4, camera="runway"))
    run.take(advisory(6, "ADVISORY"))
    assert run.seq_of("first_warning") is None
    run.take(advisory(6, "CAUTION", active=False))
    assert run.seq_of("first_warning") is None
    run.take(advisory(6, "CAUTION")).shoot(7).take(advisory(8, "WARNING"))
    assert run.seq_of("first_warning") == ("runway", 4)


def test_the_closest_approach_is_known_when_the_run_is_over(run: Run) -> None:
    for seq in range(12):
        run.closest = min(seq, 7)
        run.shoot(seq, sighting(LEFT))
    assert run.seq_of("closest_approach") is None
    run.pictures.close()
    assert run.seq_of("closest_approach") == ("tower", 7)


def test_where_the_pair_is_out_of_view_it_is_the_nearest_picture_that_has_it(run: Run) -> None:
    for seq in range(40):
        run.closest = min(seq, 20)
        visible = seq < 18 or seq > 30
        run.shoot(seq, *([sighting(LEFT)] if visible else []))
    run.pictures.close()
    assert run.seq_of("closest_approach") == ("tower", 17)


def test_without_a_pair_or_a_view_of_it_there_is_no_closest_approach(run: Run) -> None:
    run.shoot(0, sighting(LEFT))
    run.pictures.close()
    assert run.seq_of("closest_approach") is None
    run.closest = 1
    run.shoot(1, sighting(LEFT, "DEER1"), sighting(LEFT, pixels=0.0))
    run.pictures.close()
    assert run.seq_of("closest_approach") is None


# --- names, disks and room ----------------------------------------------------------------------


def test_a_name_says_what_a_picture_is_of() -> None:
    for name in (
        PictureName("first_warning", "nose-AAL123", 12),
        PictureName("start", "a.b-3", 0),
        PictureName("closest_approach", "first_warning-1", 7),
    ):
        assert PictureName.of(name.path(Path("pictures"))) == name
    for other in ("notes.txt", "first-tower-1.png", "start-tower.jpg", "start-tower-1.svg"):
        assert PictureName.of(Path(other)) is None


@pytest.mark.skipif(not FULL.exists(), reason="needs /dev/full")
def test_a_full_disk_is_named_once_with_the_file(run: Run) -> None:
    run.folder.mkdir()
    (run.folder / "first_warning-tower-1.png").symlink_to(FULL)
    run.closest = 1
    run.shoot(1, sighting(LEFT))
    with pytest.raises(RunFolderError, match=r"first_warning-tower-1\.png: .*No space.*make room"):
        run.take(advisory(2))
    assert not (run.folder / "first_warning-tower-1.png").is_symlink(), "no half a file stays"
    run.pictures.close()
    assert run.seq_of("closest_approach") is None


def test_a_picture_that_cannot_be_drawn_any_more_is_left_out(run: Run) -> None:
    run.take(truth(0, sighting(LEFT))).take(frame(0), undrawn((160, 90)))
    run.closest = 0
    run.take(advisory(0, "WARNING"))
    run.pictures.close()
    assert run.kept() == set()
    run.shoot(1, sighting(LEFT)).take(seen(1, found(LEFT)))
    assert run.kept() == {("first_detection", "tower", 1)}


def waiting_for(*seqs: int) -> tuple[WaitingPictures, list[int]]:
    waiting = WaitingPictures()
    crowded_out = [
        picture.header.seq
        for seq in seqs
        for picture in waiting.add(Picture(frame(seq), bytes(25_000_000), ()))
    ]
    return waiting, crowded_out


def numbers(pictures: list[Picture]) -> list[int]:
    return [picture.header.seq for picture in pictures]


def test_pictures_wait_for_their_detections_as_long_as_there_is_room() -> None:
    waiting, crowded_out = waiting_for(0, 1, 2, 3)
    assert crowded_out == [0, 1]
    assert numbers(waiting.up_to("tower", 2)) == [2]
    assert numbers(waiting.up_to("tower", 2)) == []
    assert numbers(waiting.everything()) == [3]
    assert numbers(waiting.everything()) == []
