"""What the process of the tests holds of the operating system, as Linux counts it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import pytest

PROCESS = Path("/proc/self")
linux_only = pytest.mark.skipif(not PROCESS.exists(), reason="only Linux counts in /proc")


class Held(NamedTuple):
    """Resources of this process."""

    descriptors: int
    shared_memory: int
    """Number of files of shared memory that are mapped."""


def held() -> Held:
    """Return what this process holds now."""
    maps = (PROCESS / "maps").read_text()
    return Held(
        sum(1 for _ in (PROCESS / "fd").iterdir()),
        len(set(re.findall(r"/dev/shm/\S+", maps))),
    )


def resident_mb() -> float:
    """Return the resident memory of this process, in MB."""
    status = (PROCESS / "status").read_text()
    return int(re.findall(r"VmRSS:\s+(\d+) kB", status)[0]) / 1000.0
