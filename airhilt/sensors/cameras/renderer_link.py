"""A process that draws, started and asked from this one.

Questions and answers are lines of JSON on two pipes. What the process prints goes to a temporary
file, and pixels lie in a file that both processes map into their memory.
`airhilt.sensors.cameras.renderer_server` is the other side.
"""

from __future__ import annotations

import json
import os
import selectors
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

COMMAND = (sys.executable, "-P", "-m", "airhilt.sensors.cameras.renderer_server")
"""Command of the other side; -P keeps the current folder out of what it imports from."""
ENVIRONMENT = {"EGL_PLATFORM": "surfaceless", "OMP_NUM_THREADS": "1", "LP_NUM_THREADS": "2"}
"""Environment for drivers without a display. A run waits while pictures are drawn: two threads
draw some of them sooner."""
MOST_PRINTED_BYTES = 1 << 20
"""Size of the process's output at which it is thrown away."""
LAST_PRINTED_BYTES = 1 << 12
"""Size of the end of the output in which its last line is looked for."""


class NoAnswer(Exception):
    """The process did not answer in time, and was killed."""


class Ended(Exception):
    """The process has ended; the text says how, with the last line that it printed."""


class RendererLink:
    """A process that waits to be asked for pictures.

    Raises
    ------
    OSError
        There is no room for the files of the process.
    """

    def __init__(self) -> None:
        self._printed = tempfile.TemporaryFile(buffering=0)  # noqa: SIM115
        self.shared = _shared_file()
        self._process, self._questions, self._answers = self._start()
        self._unread = b""
        self._was_asked = False

    @property
    def process_id(self) -> int:
        """Identifier of the process."""
        return self._process.pid

    def ask(self, question: Mapping[str, Any], patience_s: float) -> Any:
        """Return the answer to a question.

        Raises
        ------
        NoAnswer
            There was none within the patience.
        Ended
            The process has ended.
        """
        self._was_asked = True
        try:
            self._questions.write(json.dumps(question).encode() + b"\n")
            self._questions.flush()
            line = self._line(patience_s)
        except (OSError, ValueError):
            line = b""
        if not line:
            raise Ended(self._how_it_ended())
        self._discard_output()
        return json.loads(line)

    def close(self) -> None:
        """End the process; a question that it has not read is lost with it."""
        try:
            with suppress(OSError, subprocess.TimeoutExpired):
                self._questions.close()
                if self._was_asked:
                    self._process.wait(5.0)
        finally:
            self._process.kill()
            self._process.wait()
            self._answers.close()
            self.shared.close()
            self._printed.close()

    def _start(self) -> tuple[subprocess.Popen[bytes], IO[bytes], IO[bytes]]:
        questions, ask = os.pipe()
        answers, answer = os.pipe()
        shared = self.shared.fileno()
        numbers = [str(number) for number in (questions, answer, shared)]
        process = subprocess.Popen(  # noqa: S603 - our own module
            [*COMMAND, *numbers],
            stdin=subprocess.DEVNULL,
            stdout=self._printed,
            stderr=self._printed,
            # Ctrl-C is for the run, which then ends this process itself.
            start_new_session=True,
            pass_fds=(questions, answer, shared),
            env=environment(),
        )
        os.close(questions)
        os.close(answer)
        return process, os.fdopen(ask, "wb"), os.fdopen(answers, "rb", buffering=0)

    def _line(self, patience_s: float) -> bytes:
        """Return the next line of answers; empty when there will be none."""
        until_s = time.monotonic() + patience_s
        with selectors.DefaultSelector() as selector:
            selector.register(self._answers, selectors.EVENT_READ)
            while b"\n" not in self._unread:
                left_s = until_s - time.monotonic()
                if left_s <= 0.0 or not selector.select(left_s):
                    self._process.kill()
                    raise NoAnswer
                part = self._answers.read(1 << 16)
                if not part:
                    return b""
                self._unread += part
        line, _, self._unread = self._unread.partition(b"\n")
        return line

    def _discard_output(self) -> None:
        """Throw much output away: the process writes where this side's file stands too."""
        if os.fstat(self._printed.fileno()).st_size > MOST_PRINTED_BYTES:
            self._printed.seek(0)
            self._printed.truncate()

    def _how_it_ended(self) -> str:
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(5.0)
        self._printed.seek(max(os.fstat(self._printed.fileno()).st_size - LAST_PRINTED_BYTES, 0))
        last = self._printed.read().decode(errors="replace").strip().splitlines()[-1:]
        cause = f": {last[0]}" if last else ""
        return f"({exit_text(self._process.returncode)}){cause}"


def environment() -> dict[str, str]:
    """Return the environment of the other side, which imports from where this one does."""
    places = [str(Path(place).absolute()) for place in sys.path]
    return {**os.environ, **ENVIRONMENT, "PYTHONPATH": os.pathsep.join(places)}


def exit_text(code: int | None) -> str:
    """Return how a process ended, in words."""
    return f"signal {-code}" if code is not None and code < 0 else f"exit code {code}"


def _shared_file() -> IO[bytes]:
    """Return a file for pixels, in memory where the system has such files."""
    if hasattr(os, "memfd_create"):
        return os.fdopen(os.memfd_create("airhilt"), "w+b")
    return tempfile.TemporaryFile()
