"""The machine, and what this process takes of it."""

from __future__ import annotations

import ctypes
import hashlib
import os
import platform
import resource
from contextlib import suppress
from pathlib import Path

import psutil

PROCESSOR = Path("/proc/cpuinfo")
"""Description of the processor on Linux: libraries choose their instructions by what it has."""


def processor_sha256() -> str:
    """Return the SHA-256 of the processor's features, on which last bits of numbers depend."""
    known = {platform.machine()}
    with suppress(OSError):
        lines = PROCESSOR.read_text().splitlines()
        known |= {line for line in lines if line.startswith(("flags", "Features", "model name"))}
    return hashlib.sha256("\n".join(sorted(known)).encode()).hexdigest()


def cpu_s() -> float:
    """Return the CPU time of this process and of its children, ended or not, in s."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    total = sum(each.ru_utime + each.ru_stime for each in used)
    for child in psutil.Process().children():
        with suppress(psutil.Error):
            living = child.cpu_times()
            total += living.user + living.system
    return total


def available_cores() -> int:
    """Return the number of cores that this process may use, at least 1."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1  # macOS binds no process to cores.


def give_memory_back() -> None:
    """Return freed memory to the operating system, where the C library is that of Linux (glibc).

    The C library keeps much of what a run has freed.
    """
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
