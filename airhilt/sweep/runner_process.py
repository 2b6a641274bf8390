"""Runners as seen by a worker: each runs one case at a time, within limits of time and memory."""

from __future__ import annotations

import socket
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass

import psutil

from airhilt.errors import AirhiltError
from airhilt.host.child_process import ChildProcess, Ended, NoAnswer
from airhilt.sweep.environment import Environment
from airhilt.sweep.outcome import Machine, Outcome, Request, Status

MODULE = "airhilt.sweep.runner"
ENVIRONMENT = {
    "MALLOC_TRIM_THRESHOLD_": None,
    "OMP_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
}
"""Environment of a runner. Dask gives its workers the first variable, with which the C library asks
the system for the memory of each array anew: two fifths of what it costs to draw pictures. It gives
them the others, too, but a worker without a nanny has none, and neither has the probe of a dry run:
libraries of linear algebra would start a thread for each core there."""
STARTING_S = 120.0
"""Time that a runner has to start, in s."""
MEGABYTE = 1e6


@dataclass(frozen=True)
class Limits:
    """Limits of one run: wall time in s, and memory in MB."""

    wall_s: float = 3600.0
    memory_mb: float = 4000.0


class RunnerError(AirhiltError):
    """A runner cannot be started."""


class _OverMemory(Exception):
    """A run has taken more memory than it may."""


class RunnerProcess:
    """One runner; a new process takes the place of one that has ended when the next run comes.

    Raises
    ------
    AirhiltError
        It cannot be started, or the renderer cannot draw; the message says why.
    """

    environment: Environment

    def __init__(self, renderer: str, limits: Limits) -> None:
        self._renderer = renderer
        self._limits = limits
        self._peak_mb = 0.0
        self._start()

    def run(self, request: Request) -> Outcome:
        """Run one case and return its outcome, even after a crash."""
        if not self._child.is_alive:
            self._start()
        begun = time.perf_counter()
        self._peak_mb = 0.0
        status: Status
        try:
            outcome: Outcome = self._child.ask(
                "run", request, patience_s=self._limits.wall_s, watch=self._watch
            )
        except NoAnswer:
            status = "over_time"
            cause = f"took longer than {self._limits.wall_s:g} s (--run-timeout)"
        except _OverMemory:
            status = "over_memory"
            cause = f"took more than {self._limits.memory_mb:.0f} MB (--run-memory)"
        except Ended as ended:
            status, cause = "crashed", f"its process has ended {ended}"
        else:
            self._measure()
            machine = outcome.machine.model_copy(update={"peak_memory_mb": self._peak_mb})
            return outcome.model_copy(update={"machine": machine})
        machine = Machine(
            wall_s=time.perf_counter() - begun,
            cpu_s=None,
            peak_memory_mb=self._peak_mb,
            host=socket.gethostname(),
            process=self._child.process_id,
        )
        self.close()
        is_kept = False
        with suppress(OSError):  # The run has its cause already.
            is_kept = request.settle(request.partial_folder, status)
        return Outcome(
            key=request.key, status=status, cause=cause, is_kept=is_kept, machine=machine
        )

    def kill(self) -> None:
        """End the process while another thread waits for a run, which then has crashed."""
        self._child.kill()

    def close(self) -> None:
        """End the process, and remove what its runs have left."""
        self._child.close()
        self._scratch.cleanup()

    def _start(self) -> None:
        try:
            self._scratch = tempfile.TemporaryDirectory(  # The runner may be killed.
                prefix="airhilt-runner-", ignore_cleanup_errors=True
            )
            self._child = ChildProcess(MODULE, ENVIRONMENT | {"TMPDIR": self._scratch.name})
        except OSError as error:
            raise _not_started(
                f"({error.strerror or error}); expected a few kB where temporary files are "
                "(TMPDIR), and room for one more process"
            ) from None
        try:
            self.environment = self._child.ask("environment", self._renderer, patience_s=STARTING_S)
        except (Ended, NoAnswer) as problem:
            self.close()
            raise _not_started(str(problem) or f"within {STARTING_S:.0f} s") from None
        except AirhiltError:
            self.close()
            raise

    def _watch(self) -> None:
        """Measure the memory of the run; complain if it is too much."""
        self._measure()
        if self._peak_mb > self._limits.memory_mb:
            raise _OverMemory

    def _measure(self) -> None:
        self._peak_mb = max(self._peak_mb, _memory_mb(self._child.process_id))


def _not_started(why: str) -> RunnerError:
    return RunnerError(
        f"the process that runs cases cannot be started on {socket.gethostname()} {why}"
    )


def _memory_mb(process_id: int) -> float:
    """Return the memory of a process and of what it has started, in MB."""
    total = 0.0
    with suppress(psutil.Error):
        process = psutil.Process(process_id)
        for each in (process, *process.children(recursive=True)):
            with suppress(psutil.Error):
                total += each.memory_info().rss / MEGABYTE
    return total
