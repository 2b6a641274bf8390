"""The Dask scheduler of a sweep: one on this machine with its workers, or one that exists.

Other kinds of cluster are recipes of Dask's own that start a scheduler (docs/clusters.md).
"""

from __future__ import annotations

import json
import logging
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urlsplit

import dask
from distributed import Client, LocalCluster, Worker, WorkerPlugin
from distributed.security import Security

from airhilt.errors import AirhiltError, first_line

LOCAL = "local"
"""Scheduler of a sweep unless another is named."""
HOST = "127.0.0.1"
TIMEOUT_S = 10.0
"""Time to reach an existing scheduler, in s."""
ENCRYPTED = ("tls", "wss")
"""Protocols of Dask that ask for a certificate."""
LOGGERS = ("distributed", "distributed.client")
"""Names of the loggers of Dask, each with a level of its own."""


class SchedulerError(AirhiltError):
    """A scheduler or its workers cannot be reached or started."""


def require_scheduler(scheduler: str) -> None:
    """Complain about a text that names no scheduler; nothing is connected.

    Raises
    ------
    SchedulerError
        It is neither ``local``, nor an address, nor a file that exists.
    """
    if scheduler != LOCAL and "://" not in scheduler and not Path(scheduler).is_file():
        raise SchedulerError(
            f"scheduler {scheduler}: no such file; expected local, the address of a Dask scheduler "
            "such as tcp://host:8786, or its scheduler file (docs/clusters.md has recipes for "
            "SLURM, PBS, LSF and Kubernetes)"
        )


@contextmanager
def connect(scheduler: str, workers: int, dashboard: str | None) -> Iterator[Client]:
    """Return a client of a scheduler; what was started for it ends with the context.

    Parameters
    ----------
    dashboard
        Address of Dask's dashboard on this machine, such as ``127.0.0.1:8787``; None: off.

    Raises
    ------
    SchedulerError
        The scheduler cannot be reached, or nothing can be started.
    """
    with (
        _quiet_dask(),
        _local(workers, dashboard) if scheduler == LOCAL else _existing(scheduler) as client,
    ):
        yield client


def openness(address: str) -> str:
    """Return a notice on a scheduler that anybody in its network can reach, empty if nobody can."""
    scheme, _, _ = address.partition("://")
    host = urlsplit(address).hostname or ""
    if scheme in ENCRYPTED or host == "localhost" or host.startswith("127.") or host == "::1":
        return ""
    return (
        f"scheduler {address} has no TLS: whoever reaches it, or one of its workers, can run "
        "programs as their user (docs/clusters.md, Who can reach it)"
    )


def _existing(scheduler: str) -> Client:
    """Return a client of an existing scheduler; TLS as Dask's own configuration has it."""
    try:
        is_address = "://" in scheduler
        address = (
            scheduler if is_address else json.loads(Path(scheduler).read_text("utf-8"))["address"]
        )
        return Client(address, timeout=TIMEOUT_S)
    except (OSError, ValueError, RuntimeError, TypeError, KeyError) as error:
        # TypeError: without TLS; KeyError: another file.
        raise SchedulerError(
            f"scheduler {scheduler}: not there ({first_line(error)}); expected the address that "
            "`dask scheduler` tells, such as tcp://host:8786, or the file that it writes"
        ) from None


@contextmanager
def _local(workers: int, dashboard: str | None) -> Iterator[Client]:
    """Start a scheduler in this process, and workers beside it, on the loopback interface.

    They know each other by a certificate that lives as long as they do, in their memory alone, so
    other users of the machine cannot reach them.
    """
    with dask.config.set({"distributed.worker.daemon": False}):
        try:
            with _uninterrupted():
                cluster = LocalCluster(
                    n_workers=workers,
                    threads_per_worker=1,
                    processes=True,
                    host=HOST,
                    security=Security.temporary(),  # A port of the loopback is everybody's.
                    dashboard_address=dashboard or f"{HOST}:0",
                    silence_logs=False if dask.config.get("logging", None) else logging.CRITICAL,
                    memory_limit=0,  # Of the runs, each runner's own process is watched.
                )
        except (OSError, RuntimeError) as error:
            raise SchedulerError(f"scheduler {LOCAL}: cannot be started: {error}") from None
        with cluster, Client(cluster) as client:
            client.register_plugin(_Uninterrupted())
            yield client


class _Uninterrupted(WorkerPlugin):
    """Leaves Ctrl-C, which all processes of a terminal get, to the sweep."""

    name = "uninterrupted"

    def setup(self, worker: Worker) -> None:  # noqa: ARG002
        """Ignore the signal; the main thread of a worker's process calls this."""
        signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Ignore Ctrl-C, so that processes that are started meanwhile do so from their beginning."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    earlier = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, earlier)


@contextmanager
def _quiet_dask() -> Iterator[None]:
    """Print nothing that Dask logs, unless its own configuration says what is logged.

    What matters of it comes as an error or a notice; the rest are tracebacks of lost connections.
    """
    loggers = [] if dask.config.get("logging", None) else [*map(logging.getLogger, LOGGERS)]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)
