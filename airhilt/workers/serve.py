"""Serves a worker to a run in another process."""

from __future__ import annotations

from airhilt.workers.protocol import Worker


def serve(worker: Worker, connect: str, run: str | None = None, patience_s: float = 30.0) -> None:
    """Attach a worker to a run, answer its grants, and return when the run is over.

    Parameters
    ----------
    connect
        Endpoint of the run, such as ``tcp/127.0.0.1:7447``.
    run
        Name of the run; None takes the one that answers at the endpoint.
    patience_s
        Longest wait for the run to come up, in s.

    Raises
    ------
    BusError
        No run was found there.
    """
    # Not at the top: who writes or checks a worker needs no bus.
    from airhilt.workers.grants import answer_grants

    answer_grants(worker, connect, run, patience_s)
