"""A process of AIRHILT's own, started and asked from this one.

Questions and answers are lines of JSON on two pipes. What the process prints goes to a temporary
file, whose last line says why it ended.
"""

from __future__ import annotations

import json
import os
import resource
import selectors
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

import psutil

MOST_PRINTED_BYTES = 1 << 20
"""Size of the process's output at which it is thrown away."""
LAST_PRINTED_BYTES = 1 << 12
"""Size of the end of the output in which its last line is looked for."""


STOPPED_FOR_S = 4.0
"""Time for which a process may be stopped, as by SIGSTOP, before it is given up, in s."""
LOOK_PERIOD_S = 1.0
"""Time between two looks at a process that owes an answer, in s."""


class NoAnswer(Exception):
    """The process did not answer in time, and was killed."""


class Stopped(NoAnswer):
    """The process was stopped, as by SIGSTOP, and was killed."""


class Ended(Exception):
    """The process has ended; the text says how, with the last line that it printed."""


class ChildProcess:
    """A process that waits for questions.

    Parameters
    ----------
    command
        Program and first arguments, such as `command_of` returns. The next two arguments are the
        descriptors on which it reads questions and writes answers.
    arguments
        Its further arguments.
    pass_fds
        Further descriptors that it inherits.
    environment
        Variables that it has besides those of this process; None for one that it does not have.

    Raises
    ------
    OSError
        It cannot be started.
    """

    def __init__(
        self,
        command: Sequence[str],
        arguments: Sequence[str] = (),
        pass_fds: Sequence[int] = (),
        environment: Mapping[str, str | None] | None = None,
    ) -> None:
        self._printed = tempfile.TemporaryFile(buffering=0)  # noqa: SIM115
        questions, ask = os.pipe()
        answers, answer = os.pipe()
        self._process = subprocess.Popen(  # noqa: S603 - our own module
            [*command, str(questions), str(answer), *arguments],
            stdin=subprocess.DEVNULL,
            stdout=self._printed,
            stderr=self._printed,
            # Ctrl-C is for this process, which then ends the other one itself.
            start_new_session=True,
            pass_fds=(questions, answer, *pass_fds),
            env=environment_with(environment or {}),
        )
        os.close(questions)
        os.close(answer)
        self._questions: IO[bytes] = os.fdopen(ask, "wb")
        self._answers: IO[bytes] = os.fdopen(answers, "rb", buffering=0)
        self._unread = b""
        self._was_asked = False
        self._is_asked = False

    @property
    def process_id(self) -> int:
        """Identifier of the process."""
        return self._process.pid

    @property
    def is_idle(self) -> bool:
        """True if it lives, and has answered all that it was asked."""
        return not self._is_asked and self._process.poll() is None

    def ask(
        self,
        question: Mapping[str, Any],
        patience_s: float,
        watch: Callable[[], None] | None = None,
        watch_period_s: float = 1.0,
    ) -> Any:
        """Return the answer to a question.

        Parameters
        ----------
        watch
            Is called from time to time until the answer is there; what it raises ends the wait.

        Raises
        ------
        NoAnswer
            There was none within the patience; `Stopped` if the process was stopped meanwhile.
        Ended
            The process has ended.
        """
        if self._is_asked:  # The answer that is still owed would be taken for the one to this.
            self._process.kill()
            raise Ended(self._how_it_ended())
        self._was_asked = self._is_asked = True
        try:
            self._questions.write(json.dumps(question).encode() + b"\n")
            self._questions.flush()
        except (OSError, ValueError):
            raise Ended(self._how_it_ended()) from None
        return self.answer(patience_s, watch, watch_period_s)

    def answer(
        self,
        patience_s: float,
        watch: Callable[[], None] | None = None,
        watch_period_s: float = 1.0,
    ) -> Any:
        """Return the next answer, to no question of its own; else as `ask`."""
        try:
            line = self._line(patience_s, watch, watch_period_s)
        except (OSError, ValueError):
            line = b""
        if not line:
            raise Ended(self._how_it_ended())
        self._discard_output()
        self._is_asked = False
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
            self._printed.close()

    def _line(
        self, patience_s: float, watch: Callable[[], None] | None, watch_period_s: float
    ) -> bytes:
        """Return the next line of answers; empty when there will be none."""
        now_s = time.monotonic()
        until_s, stopped_s = now_s + patience_s, now_s + STOPPED_FOR_S
        with selectors.DefaultSelector() as selector:
            selector.register(self._answers, selectors.EVENT_READ)
            while b"\n" not in self._unread:
                now_s = time.monotonic()
                if not self._is_stopped():
                    stopped_s = now_s + STOPPED_FOR_S
                if now_s >= min(until_s, stopped_s):
                    self._process.kill()
                    raise Stopped if now_s >= stopped_s else NoAnswer
                wait_s = LOOK_PERIOD_S if watch is None else watch_period_s
                if not selector.select(min(until_s - now_s, wait_s)):
                    if watch is not None:
                        watch()
                    continue
                part = self._answers.read(1 << 16)
                if not part:
                    return b""
                self._unread += part
        line, _, self._unread = self._unread.partition(b"\n")
        return line

    def _is_stopped(self) -> bool:
        """Return whether the process does nothing until somebody lets it go on."""
        if not hasattr(os, "waitid"):
            return False  # macOS has it from Python 3.13 on.
        try:
            look = os.WSTOPPED | os.WNOHANG | os.WNOWAIT
            return os.waitid(os.P_PID, self._process.pid, look) is not None
        except ChildProcessError:
            return False

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


def cpu_s() -> float:
    """Return the CPU time of this process and of its children, ended or not, in s."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    total = sum(each.ru_utime + each.ru_stime for each in used)
    for child in psutil.Process().children():
        with suppress(psutil.Error):
            living = child.cpu_times()
            total += living.user + living.system
    return total


def available_cores() -> int:
    """Return the number of cores that this process may use, at least 1."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1  # macOS binds no process to cores.


def exit_text(code: int | None) -> str:
    """Return how a process ended, in words."""
    return f"signal {-code}" if code is not None and code < 0 else f"exit code {code}"


def command_of(module: str) -> tuple[str, ...]:
    """Return the command that runs a module; the current folder is not imported from."""
    return (sys.executable, "-P", "-m", module)


def environment_with(more: Mapping[str, str | None]) -> dict[str, str]:
    """Return the environment of the other side, which imports from where this one does.

    Parameters
    ----------
    more
        Variables that take the place of this process's; None leaves one out.
    """
    places = [str(Path(place).absolute()) for place in sys.path]
    own = {**os.environ, **more, "PYTHONPATH": os.pathsep.join(places)}
    return {name: value for name, value in own.items() if value is not None}
