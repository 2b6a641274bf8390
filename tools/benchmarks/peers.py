"""AIRHILT beside bare JSBSim and other simulators, all in one run."""

from __future__ import annotations

import importlib.metadata
import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

from airhilt._version import __version__
from airhilt.cosim.setup import TICK_S
from benchmarks import peer_loops
from benchmarks.traffic import (
    airframes_of,
    bare_cpu_s,
    crowd_cpu_s,
    crowd_scenario,
    headon,
    step_s_of,
)

SIMULATED_S = {2: 200.0, 50: 60.0, 500: 18.0}
"""Simulated seconds that are measured, by the number of aircraft."""


class Row(NamedTuple):
    """How fast a simulator flies a number of aircraft."""

    simulator: str
    version: str
    aircraft: int
    step_s: float | None
    """Simulated time between two steps of all aircraft, in s."""
    per_cpu_s: float | None
    """Simulated seconds per second of CPU in the best round."""
    lacks: str
    """Package that is not installed."""

    def __str__(self) -> str:
        name = f"{self.simulator} {self.version}".strip()
        if self.lacks:
            return f"{name:24}{self.aircraft:4} aircraft: not installed (pip install {self.lacks})"
        return (
            f"{name:24}{self.aircraft:4} aircraft: {self.per_cpu_s:10.2f} simulated seconds per "
            f"CPU second, step {self.step_s:.4f} s"
        )


def rows(python: str, rounds: int) -> Iterator[Row]:
    """Return a row for each number of aircraft and simulator, all of which take turns."""
    for count, simulated_s in SIMULATED_S.items():
        measured: dict[str, list[dict[str, Any]]] = {}
        for _ in range(rounds):
            for name, measure in _simulators(python).items():
                measured.setdefault(name, []).append(measure(count, simulated_s))
        for name, found in measured.items():
            yield row_of(name, count, found)


def row_of(name: str, count: int, found: list[dict[str, Any]]) -> Row:
    """Return the best of what was measured of a simulator with a number of aircraft."""
    fastest = max((each["per_cpu_s"] for each in found if "per_cpu_s" in each), default=None)
    first = found[0]
    return Row(
        name,
        first.get("version", ""),
        count,
        first.get("step_s"),
        fastest,
        first.get("lacks", ""),
    )


def bluesky(python: str) -> dict[str, float]:
    """Compare the head-on encounter with two aircraft of BlueSky at the same step, by wall time.

    Raises
    ------
    SystemExit
        There is no BlueSky in that environment.
    """
    ours = headon()["real_time_factor_best"]
    found = [timed(python, "bluesky", 2, SIMULATED_S[2]) for _ in range(3)]
    if "lacks" in found[0]:
        sys.exit(
            f"{python}: BlueSky is not installed; make an environment with "
            "`pip install bluesky-simulator` and give its python with --peers-python"
        )
    theirs = max(each["per_wall_s"] for each in found)
    return {"airhilt_x": ours, "bluesky_x": theirs, "ratio": ours / theirs}


def timed(python: str, name: str, count: int, simulated_s: float) -> dict[str, Any]:
    """Return the rates of another simulator, or what it lacks.

    Raises
    ------
    SystemExit
        It is installed, and fails.
    """
    command = [python, peer_loops.__file__, name, str(count), "--seconds", str(simulated_s)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{python}: {name} failed: {done.stderr.strip().splitlines()[-1:]}")
    found: dict[str, Any] = json.loads(done.stdout.strip().splitlines()[-1])
    return found


def _simulators(python: str) -> dict[str, Callable[[int, float], dict[str, Any]]]:
    others = {name: partial(timed, python, name) for name in peer_loops.LOOPS}
    return {"airhilt": _airhilt, "jsbsim": _jsbsim, **others}


def _airhilt(count: int, simulated_s: float) -> dict[str, Any]:
    rate = 1.0 / crowd_cpu_s(count, simulated_s)
    return {"version": __version__, "step_s": TICK_S, "per_cpu_s": rate}


def _jsbsim(count: int, simulated_s: float) -> dict[str, Any]:
    """Step the aircraft of AIRHILT alone, without an autopilot or anything around them."""
    airframes = airframes_of(crowd_scenario(count, 1.0))
    step_s = step_s_of(airframes)
    rate = 1.0 / bare_cpu_s(airframes, simulated_s, 1.0 / step_s)
    version = importlib.metadata.version("jsbsim")
    return {"version": version, "step_s": step_s, "per_cpu_s": rate}
