"""How a sweep is run: where, by whom, within which limits. None of it changes a row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import get_args

import psutil

from airhilt.engines import Package
from airhilt.errors import AirhiltError
from airhilt.host.machine import available_cores
from airhilt.sweep.outcome import Keep
from airhilt.sweep.runner_process import MEGABYTE, Limits

LOCAL = "local"
"""Scheduler of a sweep unless another is named: this machine alone."""
RUN_MB = 400.0
"""Memory of a runner without cameras."""
CAMERAS_MB = 900.0
"""Memory that cameras add: the renderer's process, its pictures, and the detector."""


@dataclass(frozen=True)
class Work:
    """How a sweep is run; none of it changes a row.

    Attributes
    ----------
    scheduler
        ``local``, the address of a Dask scheduler, or its scheduler file.
    workers
        Number of local workers; None: as many as this machine has cores and memory for.
    keep
        Runs whose folders stay.
    sample
        Number of run folders that stay if ``keep`` is ``none``: the first by key.
    retry
        True: runs that a limit ended are tried again.
    allowed
        Folders besides their own in which scenarios may name files. Who gives the command allows
        them; a sweep file cannot.
    """

    out: Path
    limits: Limits = field(default_factory=Limits)
    workers: int | None = None
    scheduler: str = LOCAL
    keep: Keep = "none"
    sample: int = 0
    retry: bool = False
    allowed: Sequence[Path] = ()


def keep_of(text: str) -> tuple[Keep, int]:
    """Return which run folders stay, and the size of the sample, of ``none`` or ``sample:5``.

    Raises
    ------
    AirhiltError
        It is none of these.
    """
    word, _, number = text.partition(":")
    if word == "sample" and number.isdecimal() and int(number) > 0:
        return "none", int(number)
    for keep in get_args(Keep):
        if text == keep:
            return keep, 0
    raise AirhiltError(f"--keep {text}: expected none, failed, all, or sample:N")


def default_workers(renderer: str) -> int:
    """Return how many workers this machine has cores and memory for, at least 1."""
    needed_mb = RUN_MB + (CAMERAS_MB if renderer else 0.0)
    by_memory = psutil.virtual_memory().available / MEGABYTE / needed_mb
    return max(1, min(available_cores(), int(by_memory)))


def require_scheduler(scheduler: str) -> None:
    """Complain about a text that names no scheduler; nothing is connected.

    Raises
    ------
    AirhiltError
        It is neither ``local``, nor an address, nor a file that exists, or Dask is missing.
    """
    if scheduler == LOCAL:
        return
    if "://" not in scheduler and not Path(scheduler).is_file():
        raise AirhiltError(
            f"scheduler {scheduler}: no such file; expected local, the address of a Dask scheduler "
            "such as tcp://host:8786, or its scheduler file (docs/clusters.md has recipes for "
            "SLURM, PBS, LSF and Kubernetes)"
        )
    dask = Package("distributed", "cluster")
    if not dask.found():
        raise AirhiltError(f"scheduler {scheduler}: Dask is missing: {dask.remedy()}")
