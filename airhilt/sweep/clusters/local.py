"""Workers on this machine: processes of Dask's own LocalCluster, one thread each."""

from __future__ import annotations

import logging
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import dask
from distributed import Client, LocalCluster, Worker, WorkerPlugin
from distributed.security import Security

from airhilt.engines import Engine
from airhilt.host.child_process import available_cores
from airhilt.sweep.clusters import LOCAL, Cluster, ClusterError

HOST = "127.0.0.1"


class Uninterrupted(WorkerPlugin):
    """Leaves Ctrl-C, which all processes of a terminal get, to the sweep."""

    name = "uninterrupted"

    def setup(self, worker: Worker) -> None:  # noqa: ARG002
        """Ignore the signal; the main thread of a worker's process calls this."""
        signal.signal(signal.SIGINT, signal.SIG_IGN)


class LocalWorkers:
    """A scheduler in this process, and workers beside it, on the loopback interface.

    They know each other by a certificate that lives as long as they do, in their memory alone, so
    other users of the machine cannot reach them.
    """

    @contextmanager
    def connect(self, workers: int, dashboard: str | None) -> Iterator[Client]:
        """Start everything, and end it with the context."""
        is_logged = dask.config.get("logging", None)
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
                        silence_logs=False if is_logged else logging.CRITICAL,
                        memory_limit=0,  # Of the runs, each runner's own process is watched.
                    )
            except (OSError, RuntimeError) as error:
                raise ClusterError(f"scheduler {LOCAL}: cannot be started: {error}") from None
            with cluster, Client(cluster) as client:
                client.register_plugin(Uninterrupted())
                yield client

    def concurrency(self, workers: int) -> int:
        """Return the number of workers, at most that of the cores."""
        return min(workers, available_cores())


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


def _create(_argument: str) -> LocalWorkers:
    return LocalWorkers()


CLUSTER = Engine[Cluster](
    name=LOCAL,
    summary="worker processes on this machine",
    create=_create,
)
