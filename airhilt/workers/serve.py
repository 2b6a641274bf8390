"""Serves a worker to a run in another process."""

from __future__ import annotations

from pathlib import Path

from airhilt.workers.protocol import Worker


def serve(
    worker: Worker,
    connect: str | None = None,
    run: str | None = None,
    patience_s: float = 30.0,
    tls: str | Path | None = None,
) -> None:
    """Attach a worker to a run, answer its grants, and return when the run is over.

    Parameters
    ----------
    connect
        Endpoint of the run, such as ``tcp/127.0.0.1:7447``; None: the one of the keys.
    run
        Name of the run; None takes the one that answers at the endpoint.
    patience_s
        Longest wait for the run to come up, in s.
    tls
        Folder with the file ``worker.json`` of `airhilt keys init`; None: the run has no keys.

    Raises
    ------
    BusError
        No run was found there, or the keys are none.
    """
    # Not at the top: who writes or checks a worker needs no bus.
    from airhilt.workers.grants import answer_grants

    answer_grants(worker, connect, run, patience_s, None if tls is None else Path(tls))
