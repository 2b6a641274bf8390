"""The client of a sweep: gives requests to the workers of Dask, and takes their outcomes."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from typing import TYPE_CHECKING

from distributed import KilledWorker, as_completed

from airhilt.errors import AirhiltError, first_line
from airhilt.sweep.clusters import ClusterError
from airhilt.sweep.dask_worker import RunnerPlugin, run_case
from airhilt.sweep.outcome import Machine, Outcome, Request

if TYPE_CHECKING:
    from distributed import Client, Future

IN_HAND_PER_THREAD = 2
"""Runs given to each thread of a worker at a time: the one that it does, and the next."""
COUNT_PERIOD_S = 1.0
"""Period at which the threads of all workers are counted, in s."""
FIRST_WORKER_S = 120.0
"""Time that a scheduler has to get its first worker, in s."""


def prepare(client: Client, plugin: RunnerPlugin) -> None:
    """Wait for the first worker, compare the versions of Dask, and send the runners' plugin.

    Raises
    ------
    ClusterError
        There is no worker, or versions differ.
    """
    try:
        client.wait_for_workers(1, timeout=FIRST_WORKER_S)
    except TimeoutError:
        raise ClusterError(
            f"{address(client)}: no worker has come within {FIRST_WORKER_S:.0f} s; expected at "
            "least one, such as `dask worker` starts"
        ) from None
    try:
        client.get_versions(check=True)
    except ValueError as error:
        raise ClusterError(
            f"{address(client)}: versions differ between this process, scheduler and workers; "
            f"expected the same everywhere:\n{error}"
        ) from None
    try:
        client.register_plugin(plugin)
    except Exception as error:  # What a worker raised; most often it has no AIRHILT to import.
        raise ClusterError(
            f"{address(client)}: workers cannot be prepared ({first_line(error)}); expected "
            "AIRHILT to be installed there, as here"
        ) from None


def address(client: Client) -> str:
    """Return where the scheduler is, for messages."""
    scheduler = client.scheduler
    return f"scheduler {scheduler.address if scheduler else '(lost)'}"


def described(client: Client, has_dashboard: bool) -> str:
    """Return workers and dashboard in a few words."""
    threads = client.nthreads()
    count = len(threads)
    text = f"{count} worker{'s' * (count != 1)}"
    if sum(threads.values()) != count:
        text += f" with {sum(threads.values())} threads"
    return f"{text}, dashboard {client.dashboard_link}" if has_dashboard else text


def outcomes(
    client: Client, requests: Sequence[Request], stops: Callable[[], bool]
) -> Iterator[Outcome]:
    """Yield the outcomes as they come; no more runs are given out once ``stops`` is true.

    Raises
    ------
    AirhiltError
        A worker cannot run anything, or the scheduler is lost.
    """
    waiting = iter(requests)
    in_hand: dict[Future[str], Request] = {}
    completed = as_completed()
    limit, counted = 0, 0.0
    while True:
        if time.monotonic() - counted > COUNT_PERIOD_S:
            limit, counted = max(_threads(client), 1) * IN_HAND_PER_THREAD, time.monotonic()
        while not stops() and len(in_hand) < limit:
            request = next(waiting, None)
            if request is None:
                break
            future = client.submit(
                run_case, request.model_dump_json(), key=f"airhilt-{request.key}", pure=False
            )
            in_hand[future] = request
            completed.add(future)
        if not in_hand:
            return
        future = next(completed)
        yield _outcome(client, future, in_hand.pop(future))


def _threads(client: Client) -> int:
    try:
        return sum(client.nthreads().values())
    except (OSError, RuntimeError, ValueError):
        raise _lost(client) from None


def _outcome(client: Client, future: Future[str], request: Request) -> Outcome:
    """Return the outcome of a task.

    Raises
    ------
    AirhiltError
        The worker cannot run anything, or the scheduler is lost.
    """
    try:
        return Outcome.model_validate_json(future.result())
    except AirhiltError:
        raise
    except KilledWorker as error:
        last = getattr(error.last_worker, "address", "")
        machine = Machine(wall_s=0.0, cpu_s=None, peak_memory_mb=0.0, host=last, process=0)
        cause = f"workers died under it, the last one at {last}"
        return Outcome(key=request.key, status="crashed", cause=cause, machine=machine)
    except (CancelledError, OSError):
        raise _lost(client) from None


def _lost(client: Client) -> ClusterError:
    return ClusterError(
        f"{address(client)} is lost; what was finished is kept, and the same command does the rest"
    )
