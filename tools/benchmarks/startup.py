"""From the command line to its help, and to the first simulated second."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time

from benchmarks.rounds import best

FIRST_SECOND = """
import sys, time
import airhilt
class First(airhilt.Observer):
    def snapshot(self, snapshot):
        if snapshot.t_s >= 1.0:
            print(time.time())
            sys.stdout.flush()
            raise KeyboardInterrupt
try:
    airhilt.run("s02a_headon", out=sys.argv[1] + "/run", observer=First(), renderer="embree")
except KeyboardInterrupt:
    pass
"""


def startup() -> dict[str, float]:
    """Time the command line to its help and to the first simulated second."""

    def first_second() -> float:
        with tempfile.TemporaryDirectory() as scratch:
            begun = time.time()
            command = [sys.executable, "-c", FIRST_SECOND, scratch]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
        return float(done.stdout) - begun

    def show_help() -> float:
        begun = time.perf_counter()
        command = [sys.executable, "-m", "airhilt", "--help"]
        subprocess.run(command, capture_output=True, check=True)
        return time.perf_counter() - begun

    return {"first_simulated_second_s": best(first_second), "help_s": best(show_help)}
