"""The processor, of which the last bits of computed numbers depend."""

from __future__ import annotations

import hashlib
import platform
from contextlib import suppress
from pathlib import Path

PROCESSOR = Path("/proc/cpuinfo")
"""Description of the processor on Linux: libraries choose their instructions by what it has."""


def processor_sha256() -> str:
    """Return the SHA-256 of what is known of the processor."""
    known = {platform.machine()}
    with suppress(OSError):
        lines = PROCESSOR.read_text().splitlines()
        known |= {line for line in lines if line.startswith(("flags", "Features", "model name"))}
    return hashlib.sha256("\n".join(sorted(known)).encode()).hexdigest()
