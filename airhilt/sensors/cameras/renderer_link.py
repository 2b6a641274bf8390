"""The process that draws: a child process, and the file of pixels that both have in memory.

`airhilt.sensors.cameras.renderer_server` is the other side.
"""

from __future__ import annotations

import os
import tempfile
from typing import IO

from airhilt.host.child_process import ChildProcess, command_of

COMMAND = command_of("airhilt.sensors.cameras.renderer_server")
"""Command of the other side."""
ENVIRONMENT = {"EGL_PLATFORM": "surfaceless", "OMP_NUM_THREADS": "1", "LP_NUM_THREADS": "2"}
"""Environment for drivers without a display. A run waits while pictures are drawn: two threads
draw some of them sooner."""


class RendererLink(ChildProcess):
    """A process that waits to be asked for pictures.

    Attributes
    ----------
    shared
        File for pixels, which both processes map into their memory.
    is_kept
        True if it stays for another run when it is released.

    Raises
    ------
    OSError
        There is no room for the files of the process.
    """

    def __init__(self, *, is_kept: bool = False) -> None:
        self.is_kept = is_kept
        self.shared = _shared_file()
        number = self.shared.fileno()
        try:
            super().__init__(COMMAND, [str(number)], pass_fds=[number], environment=ENVIRONMENT)
        except BaseException:
            self.shared.close()
            raise

    def release(self) -> None:
        """End the process, unless it stays for another run."""
        if not self.is_kept:
            self.close()

    def close(self) -> None:
        """End the process; a question that it has not read is lost with it."""
        try:
            super().close()
        finally:
            self.shared.close()


class RendererKeeper:
    """Keeps one process that draws for run after run; a new one takes its place if it dies."""

    def __init__(self) -> None:
        self._link: RendererLink | None = None

    def link(self) -> RendererLink:
        """Return a process that nobody else has.

        Raises
        ------
        OSError
            There is no room for the files of a new one.
        """
        if self._link is None or not self._link.is_idle:
            self.close()
            self._link = RendererLink(is_kept=True)
        return self._link

    def close(self) -> None:
        """End the process."""
        if self._link is not None:
            self._link.close()
        self._link = None


def _shared_file() -> IO[bytes]:
    """Return a file for pixels, in memory where the system has such files."""
    if hasattr(os, "memfd_create"):
        return os.fdopen(os.memfd_create("airhilt"), "w+b")
    return tempfile.TemporaryFile()
