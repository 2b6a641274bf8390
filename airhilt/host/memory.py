"""The memory of this process."""

from __future__ import annotations

import ctypes


def give_memory_back() -> None:
    """Return freed memory to the operating system, where the C library is that of Linux (glibc).

    The C library keeps much of what a run has freed.
    """
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
