"""The Dask scheduler of a sweep.

Clusters are recipes of Dask's own that start a scheduler (docs/clusters.md).
"""

from __future__ import annotations

import json
import logging
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urlsplit

import dask
from distributed import Client

from airhilt.errors import AirhiltError, first_line

TIMEOUT_S = 10.0
"""Time to reach an existing scheduler, in s."""
ENCRYPTED = ("tls", "wss")
"""Protocols of Dask that ask for a certificate."""
LOGGERS = ("distributed", "distributed.client")
"""Names of the loggers of Dask, each with a level of its own."""


class SchedulerError(AirhiltError):
    """A scheduler or its workers cannot be reached."""


@contextmanager
def connect(scheduler: str) -> Iterator[Client]:
    """Return a client of a scheduler, closed with the context.

    Raises
    ------
    SchedulerError
        The scheduler cannot be reached.
    """
    with _quiet_dask(), _existing(scheduler) as client:
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
