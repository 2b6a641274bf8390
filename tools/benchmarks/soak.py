"""Two simulated hours with speech: what a long run needs, and what it keeps."""

from __future__ import annotations

import math
import re
import tempfile
import time
from pathlib import Path
from typing import Any

from airhilt import load, run
from airhilt.cosim.observer import Observer, Snapshot
from airhilt.scenario import Scenario

DURATION_S = 7200.0
BETWEEN_CALLS_S = 20.0
LEVELS = ("four", "five", "six", "seven", "eight", "nine")
"""Words for the thousands of feet that calls are about."""
LOOKS_S = (600.0, 1800.0, 3600.0, 7190.0)
"""Simulated times of the looks at the process, in s."""
PROCESS = Path("/proc/self")


class Looks(Observer):
    """Observer that looks at this process at some simulated times."""

    def __init__(self) -> None:
        self.found: dict[str, float] = {}
        self._waiting = list(LOOKS_S)
        self._begin_s = time.perf_counter()

    def snapshot(self, snapshot: Snapshot) -> None:
        """Note memory, descriptors, threads and time, if it is time to."""
        if self._waiting and snapshot.t_s >= self._waiting[0]:
            at = f"at_{self._waiting.pop(0):.0f}_s"
            status = (PROCESS / "status").read_text()
            self.found |= {
                f"memory_mb_{at}": _number(status, "VmRSS") / 1000.0,
                f"descriptors_{at}": float(sum(1 for _ in (PROCESS / "fd").iterdir())),
                f"threads_{at}": _number(status, "Threads"),
                f"wall_s_{at}": time.perf_counter() - self._begin_s,
                f"cpu_s_{at}": time.process_time(),
            }


def _number(status: str, name: str) -> float:
    return float(re.findall(rf"{name}:\s+(\d+)", status)[0])


def soak() -> dict[str, float]:
    """Run two hours with speech; return what the process held, and the size of the folder."""
    looks = Looks()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "run"
        summary = run(
            soak_scenario(), out=folder, observer=looks, cameras=False, speech=True, latency="fixed"
        ).summary
        size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
    return {
        **looks.found,
        "real_time_factor": summary.real_time_factor,
        "cpu_s": summary.cpu_s,
        "folder_mb": size / 1e6,
    }


def soak_scenario(duration_s: float = DURATION_S) -> Scenario:
    """Return two aircraft that fly to and fro, and report their level again and again."""
    document = load("s02c_nominal").model_dump(mode="json")
    ends = [{"type": "from_centre", "bearing_deg": side, "distance_nm": 30} for side in (90, 270)]
    for actor in document["actors"]:
        actor["route"] = ends * 20
        actor["on_roster"] = True
    line: dict[str, Any] = document["radio"]["lines"][0]
    document["radio"]["lines"] = [
        line
        | {
            "id": f"level{index}",
            "at_s": 3.0 + BETWEEN_CALLS_S * index,
            "text": "Potomac Approach, American one two three, level at "
            f"{LEVELS[index % len(LEVELS)]} thousand.",
        }
        for index in range(math.ceil((duration_s - 10.0) / BETWEEN_CALLS_S))
    ]
    document |= {"name": "soak", "duration_s": duration_s, "cameras": [], "end_when": []}
    document |= {"perturbations": [], "conflict": None}
    return Scenario.model_validate(document)
