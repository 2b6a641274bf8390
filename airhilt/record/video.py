"""``video/``: what each camera saw, and what was made of it, as MP4 with H.264.

A picture waits for its detections, so that the boxes on it are its own, and not those of where
things were one latency earlier; what people of the run saw live was that much later.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from airhilt.errors import RunFolderError, VideoError, disk_failed, first_line
from airhilt.messages import (
    CONTROLLER,
    Advisory,
    CameraFrame,
    CameraInfo,
    Detections,
    Message,
    Status,
)
from airhilt.record.overlay import Overlay
from airhilt.record.pictures import Picture, Waiting
from airhilt.units import SECOND_NS

if TYPE_CHECKING:
    from PIL import Image

ENCODERS = ("libx264", "libopenh264")
"""Of H.264 in FFmpeg, the first that is there."""
QUALITY = {"preset": "veryfast", "crf": "21", "tune": "zerolatency"}
"""Of x264; without latency it keeps no pictures waiting, and so little memory."""
MOVIE = {"movflags": "hybrid_fragmented+frag_keyframe", "flush_packets": "1"}
"""How FFmpeg writes the file: in parts, each of which is whole, and made one at the end."""
TIME_BASE = Fraction(1, 90_000)
"""Of MPEG."""
KEY_PICTURE_S = 2.0
"""Between pictures from which a player can begin, and a killed run's file is whole up to one."""


def require_video() -> None:
    """Check that videos can be written.

    Raises
    ------
    VideoError
        PyAV or an H.264 encoder is not installed.
    """
    _encoder()


def _encoder() -> str:
    try:
        from av.codec import codecs_available
    except ImportError:
        raise VideoError(
            "--video needs PyAV, which is not installed: pip install 'airhilt[video]'"
        ) from None
    for name in ENCODERS:
        if name in codecs_available:
            return name
    raise VideoError(
        f"--video needs an H.264 encoder, and PyAV here was built without; expected one of "
        f"{', '.join(ENCODERS)}, as the wheels on PyPI have: pip install 'airhilt[video]'"
    )


class _Scene(NamedTuple):
    """A picture, and what stood at its time."""

    picture: Picture
    advisory: Advisory | None

    @property
    def header(self) -> CameraFrame:
        return self.picture.header

    @property
    def pixels(self) -> bytes:
        return self.picture.pixels


class VideoRecorder:
    """Writes a video for each camera of a run.

    Parameters
    ----------
    folder
        Where to write; made with the first picture.
    notice
        Called with what a user is to know: of which camera there is no more video, and why.

    Raises
    ------
    VideoError, RendererError
        As `require_video`.
    """

    def __init__(self, folder: Path, *, notice: Callable[[str], None]) -> None:
        require_video()
        self._folder = folder
        self._notice = notice
        self._rates_hz: dict[str, float] = {}
        self._films: dict[str, _Film] = {}
        self._failed: set[str] = set()
        self._advisories: dict[tuple[str, str], Advisory] = {}
        """Those that stand, by id and recipient."""
        self._is_watched = False
        self._is_full = False

    def take(self, key: str, message: Message, payload: bytes) -> None:  # noqa: ARG002
        """Take in a published message; truth is left aside.

        Raises
        ------
        RunFolderError
            The disk takes no more.
        """
        try:
            self._take(message, payload)
        except RunFolderError:
            self._is_full = True
            raise

    def _take(self, message: Message, payload: bytes) -> None:
        match message:
            case CameraInfo(camera=name, rate_hz=rate_hz):
                self._rates_hz[name] = rate_hz
            case CameraFrame():
                self._take_picture(Picture(message, payload, ()))
            case Detections(camera=name, missed="") if name in self._films:
                with self._at_its_own_cost(name):
                    self._films[name].look(message)
            case Advisory():
                self._advise(message)
            case Status(modality="vision", state=state):
                self._is_watched = state == "on"
                if not self._is_watched:
                    for name, film in list(self._films.items()):
                        with self._at_its_own_cost(name):
                            film.wait_no_longer()

    def close(self) -> None:
        """Finish all videos; one whose disk was full stays as far as it goes.

        Raises
        ------
        RunFolderError
            The disk takes no more.
        """
        try:
            for name, film in list(self._films.items()):
                if not self._is_full:
                    with self._at_its_own_cost(name):
                        film.close()
        finally:
            for film in self._films.values():
                film.give_up()
            self._films.clear()

    @contextmanager
    def _at_its_own_cost(self, name: str) -> Iterator[None]:
        """Give up the video of a camera when it cannot go on; what there is of it stays."""
        try:
            yield
        except VideoError as error:
            self._failed.add(name)
            film = self._films.pop(name, None)
            if film is not None:
                film.give_up()
            self._notice(f"no more video of camera {name}: {error}")

    def _take_picture(self, picture: Picture) -> None:
        name = picture.header.camera
        if name in self._failed:
            return
        with self._at_its_own_cost(name):
            if name not in self._films:
                path = self._folder / f"{name}.mp4"
                self._films[name] = _Film(path, picture, self._rates_hz[name])
            self._films[name].take(_Scene(picture, self._advisory_for(picture)))
            if not self._is_watched:
                self._films[name].wait_no_longer()

    def _advise(self, advisory: Advisory) -> None:
        name = advisory.id, advisory.recipient
        self._advisories.pop(name, None)
        if advisory.active:
            self._advisories[name] = advisory

    def _advisory_for(self, picture: Picture) -> Advisory | None:
        """Return the most severe advisory that stands, rather one to those who own the camera."""
        owner = picture.header.view.carrier or CONTROLLER
        return max(
            self._advisories.values(),
            key=lambda one: (one.severity.rank, one.recipient == owner, one.t_ns),
            default=None,
        )


class _Film:
    """The video of one camera."""

    def __init__(self, path: Path, first: Picture, rate_hz: float) -> None:
        import av

        self._path = path
        self._begin_ns = first.header.t_frame_ns
        self._waiting: Waiting[_Scene] = Waiting()
        self._seen: Detections | None = None
        self._overlay = Overlay(first.header.view.width_px, first.header.view.height_px)
        rate = Fraction(rate_hz).limit_denominator(1000)
        with _writing(path):
            path.parent.mkdir(exist_ok=True)
            self._container = av.open(str(path), "w", format="mp4", options=dict(MOVIE))
            stream = self._container.add_stream(_encoder(), rate=rate, options=dict(QUALITY))
            assert isinstance(stream, av.VideoStream)
            stream.width, stream.height = self._overlay.size
            stream.pix_fmt = "yuv420p"
            stream.codec_context.time_base = TIME_BASE
            stream.codec_context.gop_size = max(round(KEY_PICTURE_S * rate_hz), 1)
        self._stream = stream

    def take(self, scene: _Scene) -> None:
        """Let a picture wait for its detections."""
        self._write(self._waiting.add(scene))

    def look(self, seen: Detections) -> None:
        """Write the picture that was looked at, and those before it that were not."""
        scenes = self._waiting.up_to(seen.camera, seen.seq)
        if scenes and scenes[-1].header.seq == seen.seq:
            self._write(scenes[:-1])
            self._seen = seen
            self._write(scenes[-1:])
        else:
            self._write(scenes)

    def wait_no_longer(self) -> None:
        """Write all pictures that wait."""
        self._write(self._waiting.everything())

    def close(self) -> None:
        """Write all pictures that wait, and finish the file."""
        self.wait_no_longer()
        with _writing(self._path):
            self._container.mux(self._stream.encode())
            self._container.close()

    def give_up(self) -> None:
        """Close the file, whatever state it is in."""
        with suppress(RunFolderError, VideoError), _writing(self._path):
            self._container.close()

    def _write(self, scenes: list[_Scene]) -> None:
        for scene in scenes:
            image = self._overlay.image(scene.picture, self._seen, scene.advisory)
            self._encode(image, scene.header.t_frame_ns - self._begin_ns)

    def _encode(self, image: Image.Image, t_ns: int) -> None:
        import av

        with _writing(self._path):
            frame = av.VideoFrame.from_ndarray(np.asarray(image), format="rgb24")
            frame.pts, frame.time_base = round(t_ns * TIME_BASE.denominator / SECOND_NS), TIME_BASE
            self._container.mux(self._stream.encode(frame))


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    """Name the file in whatever PyAV raises.

    Raises
    ------
    RunFolderError
        The disk takes no more.
    VideoError
        FFmpeg refuses.
    """
    import av

    try:
        yield
    except OSError as error:
        raise disk_failed(str(path), error) from None
    except (av.FFmpegError, ValueError) as error:
        raise VideoError(f"{path} stays as far as it goes: {first_line(error)}") from None
