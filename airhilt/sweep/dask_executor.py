"""The workers of a Dask scheduler, which do runs for the client that a sweep is."""

from __future__ import annotations

import math
import queue
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Self

from distributed import KilledWorker

from airhilt.errors import first_line
from airhilt.sweep.dask_worker import RunnerPlugin, probe_in, run_case
from airhilt.sweep.environment import Environment
from airhilt.sweep.outcome import Machine, Outcome, Request
from airhilt.sweep.runner_process import Limits
from airhilt.sweep.scheduler import SchedulerError, connect, openness

if TYPE_CHECKING:
    from distributed import Client, Future

IN_HAND_PER_THREAD = 2
"""Runs given to each thread of a worker at a time: the one that it does, and the next."""
COUNT_PERIOD_S = 1.0
"""Period at which the threads of all workers are counted, in s."""
QUIET_S = 5.0
"""Time without a worker after which that is told, in s."""
LOST = (OSError, RuntimeError, ValueError, CancelledError)
"""Errors of Dask if the scheduler is not there any more; TimeoutError is an OSError."""


class DaskExecutor:
    """Does runs by the workers of a scheduler.

    Parameters
    ----------
    expected
        Environment of the runs; a worker with another one refuses to run anything.
    notice
        Is told once if there are no workers, and what is open.

    Raises
    ------
    SchedulerError
        The scheduler cannot be reached.
    """

    def __init__(
        self,
        scheduler: str,
        renderer: str,
        limits: Limits,
        expected: Environment,
        notice: Callable[[str], None],
    ) -> None:
        self._stack = ExitStack()
        self._client = self._stack.enter_context(connect(scheduler))
        self._workers = Workers(self._client, notice)
        self._given = renderer, limits, expected
        if told := openness(self._client.scheduler_info()["address"]):
            notice(told)

    @property
    def size(self) -> int:
        """Number of threads of the workers."""
        return self._workers.threads()

    def ready(self, stops: Callable[[], bool]) -> str:
        """Wait for the first worker, or for the user to stop; return the workers in words.

        Raises
        ------
        SchedulerError
            The scheduler is lost.
        """
        self._workers.wait(stops)
        threads = self._client.nthreads()
        count = len(threads)
        text = f"{count} worker{'s' * (count != 1)}"
        if sum(threads.values()) != count:
            text += f" with {sum(threads.values())} threads"
        return text

    def outcomes(self, requests: Sequence[Request], stops: Callable[[], bool]) -> Iterator[Outcome]:
        """Yield outcomes as they come; no more runs are begun once ``stops`` is true.

        Raises
        ------
        AirhiltError
            A worker cannot run anything, or the scheduler is lost.
        """
        with ExitStack() as stack:
            kept = [Path(each.folder).parent for each in requests if each.keep != "none"]
            probe = stack.enter_context(probe_in(kept[0])) if kept else None
            plugin = RunnerPlugin(*self._given, probe)
            stack.enter_context(prepared(self._client, plugin))
            yield from outcomes(self._client, plugin.name, requests, self._workers, stops)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._stack.close()


class Workers:
    """The workers of a scheduler, counted from time to time; it tells if there are none."""

    def __init__(self, client: Client, notice: Callable[[str], None]) -> None:
        self._client = client
        self._notice = notice
        self._threads = 0
        self._count_at = 0.0
        self._tell_at = time.monotonic() + QUIET_S

    def threads(self) -> int:
        """Return the number of runs that the workers do at a time.

        Raises
        ------
        SchedulerError
            The scheduler is lost.
        """
        now = time.monotonic()
        if now < self._count_at:
            return self._threads
        self._count_at = now + COUNT_PERIOD_S
        if self._client.status != "running":
            raise _lost(self._client)
        try:
            self._threads = sum(self._client.nthreads().values())
        except LOST:
            raise _lost(self._client) from None
        if self._threads:
            self._tell_at = now + QUIET_S
        elif now > self._tell_at:
            self._tell_at = math.inf
            self._notice(f"{_address(self._client)} has no workers; waiting for one, Ctrl-C stops")
        return self._threads

    def wait(self, stops: Callable[[], bool]) -> None:
        """Wait for the first worker, or for the user to stop; errors as `threads`."""
        while not (stops() or self.threads()):
            time.sleep(COUNT_PERIOD_S / 10.0)


@contextmanager
def prepared(client: Client, plugin: RunnerPlugin) -> Iterator[None]:
    """Have the runners' plugin in all workers meanwhile.

    Raises
    ------
    SchedulerError
        A worker cannot load it.
    """
    try:
        client.register_plugin(plugin)
    except LOST:
        raise _lost(client) from None
    except Exception as error:  # What a worker raised; most often it has no AIRHILT to import.
        raise SchedulerError(
            f"{_address(client)}: workers cannot be prepared ({first_line(error)}); expected "
            "AIRHILT to be installed there, as here"
        ) from None
    try:
        yield
    finally:
        if client.status == "running":
            with suppress(*LOST):
                client.unregister_worker_plugin(plugin.name)


def outcomes(
    client: Client,
    plugin: str,
    requests: Sequence[Request],
    workers: Workers,
    stops: Callable[[], bool],
) -> Iterator[Outcome]:
    """Yield the outcomes as they come; no more runs are given out once ``stops`` is true.

    Raises
    ------
    AirhiltError
        A worker cannot run anything, or the scheduler is lost.
    """
    waiting = iter(requests)
    in_hand: dict[Future[Outcome], Request] = {}
    completed: queue.SimpleQueue[Future[Outcome]] = queue.SimpleQueue()
    while True:
        limit = max(workers.threads(), 1) * IN_HAND_PER_THREAD
        while not stops() and len(in_hand) < limit and (request := next(waiting, None)):
            key = f"{plugin}-{request.key}"
            future = client.submit(run_case, request, plugin, key=key, pure=False)
            in_hand[future] = request
            future.add_done_callback(completed.put)
        if not in_hand:
            return
        with suppress(queue.Empty):
            future = completed.get(timeout=COUNT_PERIOD_S)
            yield _outcome(client, future, in_hand.pop(future))


def _outcome(client: Client, future: Future[Outcome], request: Request) -> Outcome:
    """Return the outcome of a task; errors as `outcomes`."""
    try:
        return future.result()
    except KilledWorker as error:
        last = getattr(error.last_worker, "address", "")
        machine = Machine(wall_s=0.0, cpu_s=None, peak_memory_mb=0.0, host=last, process=0)
        cause = f"workers died under it, the last one at {last}"
        return Outcome(key=request.key, status="crashed", cause=cause, machine=machine)
    except (CancelledError, OSError) as error:
        if future.status != "error":  # It is not the task that has raised it.
            raise _lost(client) from None
        raise SchedulerError(
            f"{_address(client)}: a worker cannot run anything: {first_line(error)}; what was "
            "finished is kept, and the same command with the same --out does the rest"
        ) from None


def _address(client: Client) -> str:
    """Return where the scheduler is, for messages."""
    scheduler = client.scheduler
    return f"scheduler {scheduler.address if scheduler else '(lost)'}"


def _lost(client: Client) -> SchedulerError:
    return SchedulerError(
        f"{_address(client)} is lost; what was finished is kept, and the same command with "
        "the same --out does the rest"
    )
