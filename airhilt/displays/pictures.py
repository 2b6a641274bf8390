"""The pictures of a recorded run: those of its videos, else those that it has kept."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from PIL import Image

from airhilt.engines import Package
from airhilt.messages import CameraFrame
from airhilt.record import Run
from airhilt.record.kept_pictures import encoded, kept_pictures
from airhilt.record.overlay import Overlay
from airhilt.record.run import result_problem
from airhilt.units import SECOND_NS

if TYPE_CHECKING:
    from av import VideoFrame

PYAV = Package("av", "video")
SAME_NS = 1_000_000
"""Time by which a picture of a video may be off its header, in ns: a video counts in 1/90,000 s."""


class RecordedPictures:
    """Finds the picture of each header of a run; those of one camera are asked for in their order.

    Pictures of a video have the boxes that the run has drawn on them.
    """

    def __init__(self, run: Run) -> None:
        self._run = run
        self._kept, _ = kept_pictures(run)
        self._videos: dict[str, _Video | None] = {}

    def jpeg(self, header: CameraFrame) -> bytes | None:
        """Return a picture as JPEG, None if the run has it no more."""
        if header.camera not in self._videos:
            self._videos[header.camera] = self._video(header)
        video = self._videos[header.camera]
        found = None if video is None else video.jpeg(header)
        return found or self._kept.get((header.camera, header.seq))

    def _video(self, first: CameraFrame) -> _Video | None:
        path = self._run.paths.video_path / f"{first.camera}.mp4"
        if not path.is_file() or result_problem(self._run.paths, self._run.info, path):
            return None
        return _Video(path, first)


class _Video:
    def __init__(self, path: Path, first: CameraFrame) -> None:
        self._begin_ns = first.t_frame_ns
        self._overlay = Overlay(first.view.width_px, first.view.height_px)
        self._pictures = self._decoded(path)
        self._next = next(self._pictures, None)

    def jpeg(self, header: CameraFrame) -> bytes | None:
        """Return the picture of a header, None if it is not in the video."""
        t_ns = header.t_frame_ns - self._begin_ns
        while self._next is not None and self._next[0] < t_ns - SAME_NS:
            self._next = next(self._pictures, None)
        if self._next is None or self._next[0] > t_ns + SAME_NS:
            return None
        image = Image.fromarray(self._next[1].to_ndarray(format="rgb24"))
        return encoded(self._overlay.picture_in(image))

    def _decoded(self, path: Path) -> Iterator[tuple[int, VideoFrame]]:
        with PYAV.importing():
            import av
        with av.open(str(path)) as container:
            for frame in container.decode(video=0):
                assert frame.time is not None
                yield round(frame.time * SECOND_NS), frame
