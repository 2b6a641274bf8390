"""CPU time of a command and of all processes that it starts, however and whenever they end.

    python tools/benchmarks/process_tree.py COMMAND ...

Linux only: a process that its parent did not wait for is adopted (prctl(2), PR_SET_CHILD_SUBREAPER)
and waited for here, so that its time is in that of the children (getrusage(2), RUSAGE_CHILDREN).
"""

from __future__ import annotations

import ctypes
import os
import resource
import subprocess
import sys
from collections.abc import Sequence

PR_SET_CHILD_SUBREAPER = 36
"""Number of the operation (linux/prctl.h)."""


def cpu_s(command: Sequence[str]) -> float:
    """Return the CPU time of a command and of all that it starts, in s.

    Raises
    ------
    subprocess.CalledProcessError
        It failed.
    """
    measure = [sys.executable, __file__, *command]
    done = subprocess.run(measure, stdout=subprocess.PIPE, text=True, check=True)
    return float(done.stdout)


def main(command: Sequence[str]) -> int:
    """Run a command, wait for everything that it has started, and print the CPU time."""
    if ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0):
        raise OSError("prctl: orphans cannot be adopted here")
    status = subprocess.run(command, stdout=subprocess.DEVNULL, check=False).returncode
    try:
        while True:
            os.wait()
    except ChildProcessError:  # None is left.
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(used.ru_utime + used.ru_stime)
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
