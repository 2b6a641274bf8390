"""Child processes: each answers the questions that this process asks it.

Questions and answers are lines of JSON on two pipes. A third pipe takes what the child prints; its
last line says why the child ended. A child ends as soon as its parent does.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread
from typing import Any

import psutil

WATCH_S = 0.5
"""Period at which a process that owes an answer is watched, in s."""
LAST_PRINTED_BYTES = 1 << 12
"""Size of the end of the output in which its last line is looked for."""


class NoAnswer(Exception):
    """The process did not answer in time, and was killed."""


class Ended(Exception):
    """The process has ended; the text says how, with the last line that it printed."""


class ChildProcess:
    """A process of AIRHILT's own that runs `serve`.

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
        questions, ask = os.pipe()
        answers, answer = os.pipe()
        self._questions, self._answers = os.fdopen(ask, "wb"), os.fdopen(answers, "rb")
        try:
            self._process = subprocess.Popen(  # noqa: S603 - our own module
                [*command, str(questions), str(answer), *arguments],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                # Ctrl-C is for this process, which then ends the other one itself.
                start_new_session=True,
                pass_fds=(questions, answer, *pass_fds),
                env=environment_with(environment or {}),
            )
        except OSError:
            self._questions.close()
            self._answers.close()
            raise
        finally:
            os.close(questions)
            os.close(answer)
        self._last_printed = b""
        self._printing = Thread(target=self._read_printed, daemon=True)
        self._printing.start()

    @property
    def process_id(self) -> int:
        """Identifier of the process."""
        return self._process.pid

    @property
    def is_alive(self) -> bool:
        """True if it can be asked."""
        return self._process.poll() is None

    def ask(self, question: Any, patience_s: float, watch: Callable[[], None] | None = None) -> Any:
        """Return the answer to a question. If there is none, for any reason, the process is killed.

        Parameters
        ----------
        watch
            Is called from time to time until the answer is there; what it raises ends the wait.

        Raises
        ------
        NoAnswer
            There was none within the patience.
        Ended
            The process has ended.
        """
        line, answers = json.dumps(question).encode() + b"\n", SimpleQueue[bytes]()
        Thread(target=self._exchange, args=(line, answers), daemon=True).start()
        try:
            answer = _within(patience_s, answers, watch)
        except BaseException:  # The answer that is still owed must not be taken for the next one.
            self.kill()
            raise
        if not answer.endswith(b"\n"):
            raise Ended(self._how_it_ended())
        return json.loads(answer)

    def kill(self) -> None:
        """Kill the process and all that it has started; another thread may be asking it."""
        if self.is_alive:
            with suppress(psutil.Error):
                for each in psutil.Process(self.process_id).children(recursive=True):
                    with suppress(psutil.Error):
                        each.kill()
            self._process.kill()
        self._process.wait()

    def close(self) -> None:
        """End the process."""
        self.kill()
        self._printing.join(1.0)
        with suppress(OSError):  # A question that it has not read is lost with it.
            self._questions.close()
        self._answers.close()

    def _exchange(self, question: bytes, answers: SimpleQueue[bytes]) -> None:
        """Ask a question; the answer is not a whole line if the process has ended."""
        answer = b""
        with suppress(OSError, ValueError):
            self._questions.write(question)
            self._questions.flush()
            answer = self._answers.readline()
        answers.put(answer)

    def _read_printed(self) -> None:
        """Keep the end of what the process prints, however much that is."""
        assert self._process.stdout is not None
        with self._process.stdout as printed:
            while part := os.read(printed.fileno(), 1 << 16):
                self._last_printed = (self._last_printed + part)[-LAST_PRINTED_BYTES:]

    def _how_it_ended(self) -> str:
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(5.0)
        self.kill()
        self._printing.join(1.0)
        code = self._process.returncode
        last = self._last_printed.decode(errors="replace").strip().splitlines()[-1:]
        cause = f": {last[0]}" if last else ""
        return f"(signal {-code}){cause}" if code < 0 else f"(exit code {code}){cause}"


def _within(
    patience_s: float, answers: SimpleQueue[bytes], watch: Callable[[], None] | None
) -> bytes:
    until_s = time.monotonic() + patience_s
    while (left_s := until_s - time.monotonic()) > 0.0:
        with suppress(Empty):
            return answers.get(timeout=min(left_s, WATCH_S))
        if watch is not None:
            watch()
    raise NoAnswer


def serve(
    questions: int,
    answers: int,
    answer: Callable[[Any], str],
    at_end: Callable[[], None] = lambda: None,
) -> None:
    """Answer the questions of the parent; end this process with them, whatever it is doing.

    Parameters
    ----------
    questions, answers
        Descriptors that the process was given by its `ChildProcess`.
    answer
        Returns the answer to a question, as a line of JSON.
    at_end
        Is called when there are no more questions.
    """
    waiting: SimpleQueue[bytes] = SimpleQueue()

    def read() -> None:
        with os.fdopen(questions, "rb") as lines:
            for line in lines:
                waiting.put(line)
        at_end()
        os._exit(0)

    Thread(target=read, daemon=True).start()
    with os.fdopen(answers, "wb") as told:
        while True:
            try:
                told.write(answer(json.loads(waiting.get())).encode() + b"\n")
            except MemoryError:
                sys.exit("out of memory")
            told.flush()


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
