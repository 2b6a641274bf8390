"""``video/``: the pictures of each camera with boxes and advisories, as MP4 with H.264.

A picture waits for its detections, so that the boxes on it are its own. In the run the boxes came
later by the latency of vision.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from fractions import Fraction
from pathlib import Path

import numpy as np

from airhilt.errors import RendererError, RunFolderError, VideoError, first_line, writing_to_run
from airhilt.host.files import make_folder
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
from airhilt.record.pictures import Picture, WaitingPictures
from airhilt.sim.payload import Payload
from airhilt.units import SECOND_NS

ENCODERS = ("libx264", "libopenh264")
"""H.264 encoders of FFmpeg; the first one installed is used."""
QUALITY = {"preset": "veryfast", "crf": "21", "tune": "zerolatency"}
"""Options of x264; with zero latency it keeps no pictures waiting, which saves memory."""
MOVIE = {"movflags": "hybrid_fragmented+frag_keyframe", "flush_packets": "1"}
"""Options of the MP4 file: it is written in complete parts, which are joined at the end."""
TIME_BASE = Fraction(1, 90_000)
"""Time base of MPEG, in s."""
KEY_PICTURE_S = 2.0
"""Time between two key pictures, in s: a player can begin at one, and the file of a killed run is
whole up to one."""


def require_video() -> str:
    """Return the encoder of videos; `VideoError` if PyAV or an encoder is not installed."""
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


class VideoRecorder:
    """Writes a video for each camera of a run.

    The notice is told when a camera's video cannot go on. Without PyAV it raises `VideoError`.
    """

    def __init__(self, folder: Path, *, notice: Callable[[str], None]) -> None:
        require_video()
        self._folder = folder
        self._notice = notice
        self._rates_hz: dict[str, float] = {}
        self._videos: dict[str, _CameraVideo] = {}
        self._failed: set[str] = set()
        self._advisories: dict[tuple[str, str], Advisory] = {}
        """Active advisories by id and recipient."""
        self._is_watched = False
        self._is_full = False

    def take(self, key: str, message: Message, payload: Payload) -> None:  # noqa: ARG002
        """Receive a message; `RunFolderError` if the disk is full or gone."""
        try:
            self._take(message, payload)
        except RunFolderError:
            self._is_full = True
            raise

    def _take(self, message: Message, payload: Payload) -> None:
        match message:
            case CameraInfo(camera=name, rate_hz=rate_hz):
                self._rates_hz[name] = rate_hz
            case CameraFrame(encoding="rgb8"):
                advisory = self._advisory_for(message)
                self._take_picture(Picture(message, payload, advisory=advisory))
            case Detections(camera=name, missed="") if name in self._videos:
                with self._giving_up(name):
                    self._videos[name].look(message)
            case Advisory():
                self._advisories.pop((message.id, message.recipient), None)
                if message.active:
                    self._advisories[message.id, message.recipient] = message
            case Status(modality="vision", state=state):
                self._is_watched = state == "on"
                if not self._is_watched:
                    for name, video in list(self._videos.items()):
                        with self._giving_up(name):
                            video.flush()

    def close(self) -> None:
        """Finish all videos; one whose disk was full keeps what was written."""
        try:
            for name, video in list(self._videos.items()):
                if not self._is_full:
                    with self._giving_up(name):
                        video.close()
        finally:
            for video in self._videos.values():
                video.give_up()
            self._videos.clear()

    @contextmanager
    def _giving_up(self, name: str) -> Iterator[None]:
        try:
            yield
        except (VideoError, RendererError) as error:
            self._failed.add(name)
            video = self._videos.pop(name, None)
            if video is not None:
                video.give_up()
            self._notice(f"no more video of camera {name}: {error}")

    def _take_picture(self, picture: Picture) -> None:
        name = picture.header.camera
        if name in self._failed:
            return
        with self._giving_up(name):
            if name not in self._videos:
                path = self._folder / f"{name}.mp4"
                self._videos[name] = _CameraVideo(path, picture, self._rates_hz[name])
            self._videos[name].take(picture)
            if not self._is_watched:
                self._videos[name].flush()

    def _advisory_for(self, header: CameraFrame) -> Advisory | None:
        """Return the most severe active advisory, preferably one to the owner of the camera."""
        owner = header.view.carrier or CONTROLLER
        return max(
            self._advisories.values(),
            key=lambda one: (one.severity.rank, one.recipient == owner, one.t_ns),
            default=None,
        )


class _CameraVideo:
    def __init__(self, path: Path, first: Picture, rate_hz: float) -> None:
        import av

        self._path = path
        self._begin_ns = first.header.t_frame_ns
        self._waiting = WaitingPictures()
        self._seen: Detections | None = None
        self._overlay = Overlay(first.header.view.width_px, first.header.view.height_px)
        rate = Fraction(rate_hz).limit_denominator(1000)
        with _writing(path):
            make_folder(path.parent)
            self._container = av.open(str(path), "w", format="mp4", options=dict(MOVIE))
            stream = self._container.add_stream(require_video(), rate=rate, options=dict(QUALITY))
            assert isinstance(stream, av.VideoStream)
            stream.width, stream.height = self._overlay.size
            stream.pix_fmt = "yuv420p"
            stream.codec_context.time_base = TIME_BASE
            stream.codec_context.gop_size = max(round(KEY_PICTURE_S * rate_hz), 1)
        self._stream = stream

    def take(self, picture: Picture) -> None:
        """Add a picture, which waits for its detections."""
        self._write(self._waiting.add(picture))

    def look(self, seen: Detections) -> None:
        """Write the picture with these detections, and those before it that have none."""
        pictures = self._waiting.up_to(seen.camera, seen.seq)
        is_there = bool(pictures) and pictures[-1].header.seq == seen.seq
        self._write(pictures[:-1] if is_there else pictures)
        if is_there:
            self._seen = seen
            self._write(pictures[-1:])

    def flush(self) -> None:
        """Write all waiting pictures."""
        self._write(self._waiting.everything())

    def close(self) -> None:
        """Write all waiting pictures, and finish the file."""
        self.flush()
        with _writing(self._path):
            self._container.mux(self._stream.encode())
            self._container.close()

    def give_up(self) -> None:
        """Close the file in whatever state it is."""
        with suppress(RunFolderError, VideoError), _writing(self._path):
            self._container.close()

    def _write(self, pictures: list[Picture]) -> None:
        import av

        for picture in pictures:
            image = self._overlay.image(picture, self._seen)
            t_ns = picture.header.t_frame_ns - self._begin_ns
            with _writing(self._path):
                frame = av.VideoFrame.from_ndarray(np.asarray(image), format="rgb24")
                frame.pts = round(t_ns * TIME_BASE.denominator / SECOND_NS)
                frame.time_base = TIME_BASE
                self._container.mux(self._stream.encode(frame))


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    """Convert errors of the disk and of FFmpeg to RunFolderError and VideoError."""
    import av

    try:
        with writing_to_run(path):
            yield
    except (av.FFmpegError, ValueError) as error:
        raise VideoError(f"{path} stays as far as it goes: {first_line(error)}") from None
