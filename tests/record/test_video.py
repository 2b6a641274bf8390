"""What a camera saw can be played, with what was made of it."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pytest

pytest.importorskip("av")

import av

from airhilt.errors import RunFolderError, VideoError
from airhilt.messages import Advisory, Message
from airhilt.record.overlay import COLOURS, Overlay
from airhilt.record.pictures import Picture
from airhilt.record.video import VideoRecorder, require_video
from airhilt.sim.payload import Payload
from sightings import advisory, found, frame, info, pixels, seen, undrawn, vision

FULL = Path("/dev/full")
SIZE = (320, 180)
BOX = (150.0, 80.0, 190.0, 110.0)
HEAD_PX = 16
"""Height of the bar above a picture of this size."""


class Film:
    """A recorder that is fed picture by picture."""

    def __init__(self, folder: Path, *cameras: str, size: tuple[int, int] = SIZE) -> None:
        self.folder = folder / "video"
        self.size = size
        self.told: list[str] = []
        self.recorder = VideoRecorder(self.folder, notice=self.told.append)
        self.take(vision("on"))
        for camera in cameras or ("tower",):
            self.take(info(camera, size))

    def take(self, message: Message, payload: Payload = b"") -> Film:
        self.recorder.take("", message, payload)
        return self

    def shoot(self, *seqs: int, camera: str = "tower", carrier: str | None = None) -> Film:
        for seq in seqs:
            self.take(frame(seq, camera, carrier, self.size), pixels(128, self.size))
        return self

    def frames(self, camera: str = "tower") -> list[np.ndarray]:
        self.recorder.close()
        with av.open(str(self.folder / f"{camera}.mp4")) as file:
            return [one.to_ndarray(format="rgb24") for one in file.decode(video=0)]


@pytest.fixture
def film(tmp_path: Path) -> Film:
    return Film(tmp_path)


def is_like(pixel: np.ndarray, colour: tuple[int, ...], within: int = 90) -> bool:
    """Whether a pixel has about a colour: H.264 keeps colours at half the resolution."""
    return bool(np.abs(pixel.astype(int) - colour).max() < within)


def left_edge(picture: np.ndarray) -> np.ndarray:
    """The middle of the left side of the box: 3 px beside it, below the bar."""
    edge: npt.NDArray[Any] = picture[HEAD_PX + 95, 147:149].mean(axis=0)
    return edge


# --- files ------------------------------------------------------------------------------------


def test_each_camera_has_a_video_with_all_its_pictures_in_time(tmp_path: Path) -> None:
    film = Film(tmp_path, "tower", "runway")
    for seq in range(40):
        film.shoot(seq).take(seen(seq))
        if seq % 2 == 0:
            film.shoot(seq, camera="runway")
    film.recorder.close()
    with av.open(str(film.folder / "tower.mp4")) as file:
        stream = file.streams.video[0]
        assert (stream.codec_context.name, stream.frames, stream.average_rate) == ("h264", 40, 16)
        assert (stream.width, stream.height) == (320, 228)
        times = [float(one.time) for one in file.decode(video=0)]
    assert times == pytest.approx([seq / 16 for seq in range(40)], abs=1e-3)
    with av.open(str(film.folder / "runway.mp4")) as file:
        times = [float(one.time) for one in file.decode(video=0)]
    assert times == pytest.approx([seq / 16 for seq in range(0, 40, 2)], abs=1e-3)


def test_a_run_that_is_killed_leaves_what_can_be_played(film: Film) -> None:
    for seq in range(100):
        film.shoot(seq).take(seen(seq))
    killed = film.folder / "killed.mp4"
    killed.write_bytes((film.folder / "tower.mp4").read_bytes())
    with av.open(str(killed)) as file:
        assert sum(1 for _ in file.decode(video=0)) >= 32
    film.recorder.close()


# --- what is drawn ----------------------------------------------------------------------------


def test_a_box_is_on_its_own_picture_although_it_came_later(film: Film) -> None:
    film.shoot(0, 1, 2).take(seen(1, found(BOX)))
    first, second, third = film.frames()
    assert is_like(left_edge(first), (128, 128, 128), 25)
    assert is_like(left_edge(second), COLOURS["airplane"])
    pale = tuple(round(0.65 * part) for part in COLOURS["airplane"])
    assert is_like(left_edge(third), pale, 60), "kept, and paler"
    assert left_edge(third)[0] < left_edge(second)[0] - 50
    middle = second[HEAD_PX + 95, 170]
    assert is_like(middle, (128, 128, 128), 25), "what is in the box is not painted over"


def test_boxes_of_an_earlier_picture_go_when_nothing_is_found_any_more(film: Film) -> None:
    film.shoot(0, 1).take(seen(0, found(BOX))).take(seen(1))
    assert is_like(left_edge(film.frames()[1]), (128, 128, 128), 25)


def test_an_advisory_stands_below_the_picture_while_it_is_active(film: Film) -> None:
    film.shoot(0).take(advisory(1, "CAUTION")).shoot(1).take(advisory(2, "WARNING", revision=1))
    film.shoot(2).take(advisory(3, "WARNING", revision=2, active=False)).shoot(3)
    bars = [picture[HEAD_PX + SIZE[1] + 4 :] for picture in film.frames()]
    assert bars[0].max() < 60
    assert (bars[1][..., 1].max(), bars[1][..., 0].max()) > (110, 180), "amber"
    red = bars[2].reshape(-1, 3)[bars[2][..., 0].argmax()].astype(int)
    assert red[0] > 150
    assert red[1] < 0.75 * red[0], "red"
    assert bars[3].max() < 60


def advised(film: Film, carrier: str | None) -> Advisory | None:
    return film.recorder._advisory_for(frame(0, carrier=carrier))


def test_a_camera_shows_what_its_owner_is_told_unless_something_worse_stands(film: Film) -> None:
    to_crew = advisory(1, recipient="AAL123")
    to_atc = advisory(1, recipient="ATC")
    film.take(to_crew).take(to_atc)
    assert advised(film, "AAL123") == to_crew
    assert advised(film, None) == to_atc
    worse = advisory(2, "WARNING", recipient="DAL456", id="decision-2")
    film.take(worse)
    assert advised(film, "AAL123") == worse


@pytest.mark.parametrize(
    "box", [(0.0, 0.0, 3.0, 3.0), (-5.0, -5.0, 400.0, 300.0), (318.0, 178.0, 320.0, 180.0)]
)
def test_boxes_at_the_edge_are_drawn(box: tuple[float, float, float, float]) -> None:
    picture = Picture(frame(0, size=SIZE), pixels(128, SIZE), ())
    detections = seen(0, found(box, track_id=None, hits=1))
    assert Overlay(*SIZE).image(picture, detections).size == (320, 228)


# --- what can go wrong ------------------------------------------------------------------------


def test_without_pyav_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "av.codec", None)
    with pytest.raises(VideoError, match=r"--video needs PyAV.*pip install 'airhilt\[video\]'"):
        require_video()


@pytest.mark.skipif(not FULL.exists(), reason="needs /dev/full")
def test_a_full_disk_is_named_once_with_the_file(film: Film) -> None:
    film.folder.mkdir()
    (film.folder / "tower.mp4").symlink_to(FULL)
    for seq in range(100):
        film.shoot(seq)
    with pytest.raises(RunFolderError, match=r"tower\.mp4: .*No space left.*make room"):
        film.take(seen(99, found(BOX)))
    film.recorder.close()


class Refusing:
    """A stream that takes nothing."""

    def __init__(self, error: Exception) -> None:
        self._error = error

    def encode(self, *_: object) -> None:
        raise self._error


@pytest.mark.parametrize(
    "error",
    [
        av.error.ExternalError(542398533, "Generic error in an external library"),
        ValueError("pts is not monotonic"),
    ],
)
def test_a_video_that_ffmpeg_refuses_costs_that_video_and_is_told_once(
    tmp_path: Path, error: Exception
) -> None:
    film = Film(tmp_path, "tower", "runway").shoot(0).shoot(0, camera="runway")
    film.recorder._videos["tower"]._stream = cast(Any, Refusing(error))
    for seq in range(1, 5):
        film.shoot(seq).shoot(seq, camera="runway")
        film.take(seen(seq)).take(seen(seq, camera="runway"))
    assert len(film.frames("runway")) == 5
    (told,) = film.told
    assert "no more video of camera tower" in told
    assert str(error) in told


def test_a_picture_that_cannot_be_drawn_any_more_ends_the_video_and_is_told(film: Film) -> None:
    film.shoot(0, 1).take(seen(1))
    film.take(frame(2, "tower", None, SIZE), undrawn(SIZE)).take(seen(2))
    film.shoot(3)
    assert film.told == ["no more video of camera tower: it has ended"]
    assert len(film.frames()) == 2


def test_pictures_that_wait_take_no_more_than_their_room(
    film: Film, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A camera that nobody answers for."""
    monkeypatch.setattr("airhilt.record.pictures.MOST_WAITING_BYTES", 10 * 3 * SIZE[0] * SIZE[1])
    film.shoot(*range(50))
    film.take(seen(39, found(BOX))).take(seen(40, found(BOX)))
    frames = film.frames()
    assert len(frames) == 50
    assert is_like(left_edge(frames[39]), (128, 128, 128), 25)
    assert is_like(left_edge(frames[40]), COLOURS["airplane"])
