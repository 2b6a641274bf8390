"""Child processes: each answers the questions that this process asks it.

Questions and answers go through a socket. What a child prints goes to a file, whose last line says
why the child ended. A child ends as soon as its parent does.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path
from queue import SimpleQueue
from threading import Thread
from typing import Any

from airhilt.errors import AirhiltError

WATCH_S = 0.5
"""Period at which a process that owes an answer is watched, in s."""
LAST_PRINTED_BYTES = 1 << 12
"""Size of the end of the output in which its last line is looked for."""


class NoAnswer(Exception):
    """The process did not answer in time, and was killed."""


class Ended(Exception):
    """The process has ended; the text says how, with the last line that it printed."""


class ChildProcess:
    """A process of AIRHILT's own.

    Parameters
    ----------
    module
        Module that runs `serve`.
    environment
        Variables that it has besides those of this process; None for one that it does not have.

    Raises
    ------
    OSError
        It cannot be started.
    """

    def __init__(self, module: str, environment: Mapping[str, str | None]) -> None:
        self._connection, theirs = Pipe()
        self._printed = tempfile.TemporaryFile()  # noqa: SIM115 - closed with the process
        try:
            self._process = subprocess.Popen(  # noqa: S603 - our own module
                # -P: nothing is imported from the current folder.
                [sys.executable, "-P", "-m", module, str(theirs.fileno())],
                stdin=subprocess.DEVNULL,
                stdout=self._printed,
                stderr=subprocess.STDOUT,
                # Ctrl-C is for this process, which then ends the other one itself.
                start_new_session=True,
                pass_fds=[theirs.fileno()],
                env=_environment(environment),
            )
        except OSError:
            self._connection.close()
            self._printed.close()
            raise
        finally:
            theirs.close()

    @property
    def process_id(self) -> int:
        """Identifier of the process."""
        return self._process.pid

    @property
    def is_alive(self) -> bool:
        """True if it can be asked."""
        return self._process.poll() is None

    def ask(
        self,
        what: str,
        *arguments: Any,
        patience_s: float,
        watch: Callable[[], None] = lambda: None,
    ) -> Any:
        """Return what a method of the child's server returns; what it raises is raised here.

        Errors are those of `answer`.
        """
        self.tell(what, *arguments)
        return self.answer(patience_s, watch)

    def tell(self, what: str, *arguments: Any) -> None:
        """Ask without waiting: `answer` returns the answer, or says that the process has ended."""
        with suppress(OSError):
            self._connection.send((what, arguments))

    def answer(self, patience_s: float, watch: Callable[[], None] = lambda: None) -> Any:
        """Return the answer that is owed. If there is none, for any reason, the process is killed.

        Parameters
        ----------
        watch
            Is called from time to time until the answer is there; what it raises ends the wait.

        Raises
        ------
        AirhiltError
            It is the answer.
        NoAnswer
            There was none within the patience.
        Ended
            The process has ended.
        """
        until_s = time.monotonic() + patience_s
        try:
            while not self._connection.poll(min(max(until_s - time.monotonic(), 0.0), WATCH_S)):
                watch()
                if time.monotonic() >= until_s:
                    raise NoAnswer
            answer = self._connection.recv()
        except (EOFError, ConnectionError):
            raise Ended(self._how_it_ended()) from None
        except BaseException:  # The answer that is still owed must not be taken for the next one.
            self.kill()
            raise
        if isinstance(answer, AirhiltError):
            raise answer
        return answer

    def kill(self) -> None:
        """Kill the process; another thread may be asking it."""
        self._process.kill()
        self._process.wait()

    def close(self) -> None:
        """End the process."""
        self.kill()
        self._connection.close()
        self._printed.close()

    def _how_it_ended(self) -> str:
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(5.0)
        self.kill()
        code, file = self._process.returncode, self._printed.fileno()
        end = max(os.fstat(file).st_size - LAST_PRINTED_BYTES, 0)
        printed = os.pread(file, LAST_PRINTED_BYTES, end).decode(errors="replace")
        last = printed.strip().splitlines()[-1:]
        cause = f": {last[0]}" if last else ""
        return f"(signal {-code}){cause}" if code < 0 else f"(exit code {code}){cause}"


def serve(server: object) -> None:
    """Answer the parent with the methods of an object; end with it, whatever is going on."""
    connection = Connection(int(sys.argv[1]))
    questions: SimpleQueue[tuple[str, tuple[Any, ...]]] = SimpleQueue()

    def read() -> None:
        with suppress(EOFError, OSError):
            while True:
                questions.put(connection.recv())
        os._exit(0)

    Thread(target=read, daemon=True).start()
    while True:
        what, arguments = questions.get()
        try:
            answer = getattr(server, what)(*arguments)
        except AirhiltError as error:
            answer = error
        connection.send(answer)


def _environment(more: Mapping[str, str | None]) -> dict[str, str]:
    """Return the environment of a child, which imports from where this process does."""
    places = [str(Path(place).absolute()) for place in sys.path]
    own = {**os.environ, **more, "PYTHONPATH": os.pathsep.join(places)}
    return {name: value for name, value in own.items() if value is not None}
