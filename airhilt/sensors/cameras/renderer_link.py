"""The process that draws: a child process, and the memory for pixels that it shares with this one.

`airhilt.sensors.cameras.renderer_server` is the other side.
"""

from __future__ import annotations

import mmap
import os
import tempfile
from collections.abc import Iterable, Mapping
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from airhilt.errors import CameraError, RendererError, RendererLost, ScenarioError
from airhilt.host.child_process import ChildProcess, Ended, NoAnswer, command_of
from airhilt.imaging.view import Intrinsics
from airhilt.shapes.mesh import Floats

COMMAND = command_of("airhilt.sensors.cameras.renderer_server")
"""Command of the other side."""
ENVIRONMENT = {"EGL_PLATFORM": "surfaceless", "OMP_NUM_THREADS": "1", "LP_NUM_THREADS": "2"}
"""Environment for drivers without a display. A run waits while pictures are drawn: two threads
draw some of them sooner."""
ERRORS = {error.__name__: error for error in (CameraError, RendererError, ScenarioError)}
"""Errors that go from one process to the other by their names."""
BYTES_PER_PIXEL = 4 + 3 + 1
"""Size of a pixel: distance, colour, instance."""
Planes = tuple[npt.NDArray[np.uint8], Floats, npt.NDArray[np.uint8]]
"""Colour, distance and instance of a picture."""


class RendererLink(ChildProcess):
    """A process that draws pictures.

    Attributes
    ----------
    shared
        File for pixels, which both processes map into their memory.

    Raises
    ------
    OSError
        It cannot be started.
    """

    def __init__(self) -> None:
        self.shared = _shared_file()
        number = self.shared.fileno()
        try:
            super().__init__(COMMAND, [str(number)], pass_fds=[number], environment=ENVIRONMENT)
        except OSError:
            self.shared.close()
            raise

    def draw(self, question: Mapping[str, Any], patience_s: float, renderer: str) -> Any:
        """Return the answer to a question.

        Parameters
        ----------
        renderer
            Name of the renderer, for error messages.

        Raises
        ------
        CameraError, RendererError, ScenarioError
            The answer is an error.
        RendererLost
            There is no answer.
        """
        try:
            answer = self.ask(question, patience_s)
        except NoAnswer:
            raise RendererLost(
                f"the renderer {renderer} has not answered for {patience_s:.0f} s; no more "
                "pictures are drawn: take smaller ones (width_px, height_px) or another --renderer"
            ) from None
        except Ended as ended:
            raise RendererLost(
                f"the process of renderer {renderer} has ended {ended}; no more pictures are drawn"
            ) from None
        if "error" in answer:
            raise ERRORS.get(answer["error"], RendererError)(answer["text"])
        return answer

    def close(self) -> None:
        """End the process."""
        super().close()
        self.shared.close()


class RendererKeeper:
    """Keeps one process that draws for run after run; a new one takes its place if it dies."""

    def __init__(self) -> None:
        self._link: RendererLink | None = None

    def link(self) -> RendererLink:
        """Return a process that can draw.

        Raises
        ------
        OSError
            A new one cannot be started.
        """
        if self._link is None or not self._link.is_alive:
            self.close()
            self._link = RendererLink()
        return self._link

    def close(self) -> None:
        """End the process."""
        if self._link is not None:
            self._link.close()
        self._link = None


def pixels_bytes(lenses: Iterable[Intrinsics]) -> int:
    """Return the size of the memory for the pictures of some cameras."""
    return sum(lens.width_px * lens.height_px * BYTES_PER_PIXEL for lens in lenses)


def planes_of(shared: int, lenses: Mapping[str, Intrinsics]) -> dict[str, Planes]:
    """Return the pixels of each camera's picture in memory.

    Parameters
    ----------
    shared
        Descriptor of the file for pixels.
    """
    pixels, planes, place = mmap.mmap(shared, 0), {}, 0
    for name, lens in lenses.items():
        shape = lens.height_px, lens.width_px
        count = lens.height_px * lens.width_px
        distance = np.ndarray(shape, np.float32, pixels, place)
        colour = np.ndarray((*shape, 3), np.uint8, pixels, place + 4 * count)
        instance = np.ndarray(shape, np.uint8, pixels, place + 7 * count)
        planes[name] = colour, distance, instance
        place += BYTES_PER_PIXEL * count
    return planes


def _shared_file() -> IO[bytes]:
    """Return a file for pixels, in memory where the system has such files."""
    if hasattr(os, "memfd_create"):
        return os.fdopen(os.memfd_create("airhilt"), "w+b")
    return tempfile.TemporaryFile()
