"""Where the workers of a sweep come from: one file a kind of cluster, each with its `CLUSTER`.

One of another package is found by an entry point of the group ``airhilt.clusters``.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Protocol, runtime_checkable
from urllib.parse import urlsplit

from airhilt.engines import EngineFamily
from airhilt.errors import AirhiltError

if TYPE_CHECKING:
    from distributed import Client

LOCAL = "local"
"""Cluster of a sweep unless another is named."""
ENCRYPTED = ("tls", "wss")
"""Protocols of Dask that ask for a certificate."""


class ClusterError(AirhiltError):
    """A scheduler or its workers cannot be reached or started."""


def openness(address: str) -> str:
    """Return a notice on a scheduler that anybody in its network can reach, empty if nobody can.

    Parameters
    ----------
    address
        Address of the scheduler, such as ``tcp://host:8786``.
    """
    scheme, _, _ = address.partition("://")
    host = urlsplit(address).hostname or ""
    if scheme in ENCRYPTED or host == "localhost" or host.startswith("127.") or host == "::1":
        return ""
    return (
        f"scheduler {address} has no TLS: whoever reaches it, or one of its workers, can run "
        "programs as their user (docs/clusters.md, Who can reach it)"
    )


@runtime_checkable
class Cluster(Protocol):
    """Starts workers, or finds those of an existing scheduler."""

    def connect(self, workers: int, dashboard: str | None) -> AbstractContextManager[Client]:
        """Return a client of the scheduler; what was started for it ends with it.

        Parameters
        ----------
        workers
            Number of workers that are wanted, each with one thread.
        dashboard
            Address of Dask's dashboard, such as ``127.0.0.1:8787``; None: off.

        Raises
        ------
        ClusterError
            The scheduler is not there, or nothing can be started.
        """

    def concurrency(self, workers: int) -> int | None:
        """Return how many runs go on at a time with so many workers, None if that is not known."""


FAMILY = EngineFamily[Cluster](
    "scheduler",
    "airhilt.clusters",
    __name__,
    "CLUSTER",
    error=ClusterError,
    product=f"{__name__}:Cluster",
)
