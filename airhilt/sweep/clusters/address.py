"""The scheduler of a Dask cluster that is there already, by its address."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from distributed import Client

from airhilt.engines import Engine
from airhilt.errors import first_line
from airhilt.sweep.clusters import Cluster, ClusterError

SCHEMES = ("tcp", "tls", "ucx", "ws", "wss")
"""Protocols of Dask's communication."""
TIMEOUT_S = 10.0
"""Time to reach the scheduler, in s."""


class ExistingScheduler:
    """A scheduler at an address; TLS as Dask's own configuration has it."""

    def __init__(self, address: str) -> None:
        self._address = address

    @contextmanager
    def connect(self, workers: int, dashboard: str | None) -> Iterator[Client]:  # noqa: ARG002
        """Connect; the cluster decides how many workers there are."""
        try:
            client = Client(self._address, timeout=TIMEOUT_S)
        except (OSError, ValueError, RuntimeError, TypeError) as error:  # TypeError: without TLS
            raise ClusterError(
                f"scheduler {self._address}: not there ({first_line(error)}); expected the "
                "address that `dask scheduler` tells, such as tcp://host:8786"
            ) from None
        with client:
            yield client

    def concurrency(self, workers: int) -> int | None:  # noqa: ARG002
        """Return None: only the cluster knows."""
        return None


def _is_address(text: str) -> bool:
    scheme, separator, _ = text.partition("://")
    return bool(separator) and scheme in SCHEMES


CLUSTER = Engine[Cluster](
    name="address",
    summary="an existing Dask scheduler",
    create=ExistingScheduler,
    argument="ADDRESS",
    is_argument_required=True,
    takes=_is_address,
    usage="the address of a scheduler such as tcp://host:8786",
)
