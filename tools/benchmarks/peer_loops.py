"""Loops of other simulators, each timed in the Python that has it, which needs no AIRHILT.

    PYTHON peer_loops.py bluesky 50 --seconds 20

It prints one JSON object: version, step, and simulated seconds per second of CPU and of wall time,
or what is not installed.
"""

from __future__ import annotations

import argparse
import copy
import importlib
import importlib.metadata
import json
import math
import os
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from typing import Any

Loop = Iterator[float]
"""Each item is the simulated time, in s, after one more step of all aircraft."""

BLUESKY_STEP_S = 0.05
RADAR_SWEEP_S = 6
"""Step of BluebirdATC in its own examples, in s: one sweep of a radar."""
INTERACTIONS_HZ = 5.0
"""Actions a second in jsbgym unless told otherwise; JSBSim takes 12 steps in each."""


def bluesky(count: int) -> Loop:
    """Fly point masses of BlueSky on ten levels, spread over 150 nautical miles."""
    bs: Any = importlib.import_module("bluesky")
    bs.init(mode="sim", detached=True)
    bs.settings.simdt = bs.sim.simdt = BLUESKY_STEP_S
    for index in range(count):
        bearing = index * math.pi * (3.0 - math.sqrt(5.0))
        distance_deg = 2.5 * math.sqrt((index + 0.5) / count)
        bs.traf.cre(
            f"AC{index}",
            "B737",
            38.9 + distance_deg * math.cos(bearing),
            -77.0 + distance_deg * math.sin(bearing) / math.cos(math.radians(38.9)),
            90.0,
            (29_000.0 + 1000.0 * (index % 10)) * 0.3048,
            135.0,
        )
    bs.sim.op()
    while True:
        bs.sim.step()
        yield bs.sim.simt


def bluebird_dt(count: int) -> Loop:
    """Fly point masses of BluebirdATC along the route of a sector, each on its own level."""
    os.environ["BLUEBIRD_LOG_DIR"] = tempfile.mkdtemp()
    module: Any = importlib.import_module("bluebird_dt.simulator.simulator")
    simulator = module.Simulator.from_category(
        "Two Aircraft",
        "I-Sector",
        save_log_to_file=False,
        save_csv=False,
        autosave_interval=None,
    )
    aircraft = simulator.manager.environment.aircraft
    first = next(iter(aircraft.values()))
    aircraft.clear()
    for index in range(count):
        aircraft[f"AC{index}"] = another = copy.deepcopy(first)
        another.callsign = f"AC{index}"
    begun = simulator.manager.environment.time
    while True:
        simulator.evolve(RADAR_SWEEP_S)
        if len(simulator.manager.environment.aircraft) != count:
            sys.exit("aircraft left the sector; give fewer --seconds")
        yield simulator.manager.environment.time - begun


def jsbgym(count: int) -> Loop:
    """Hold the heading of as many Airbus A320 of jsbgym, with controls in the middle."""
    gymnasium: Any = importlib.import_module("gymnasium")
    importlib.import_module("jsbgym")
    warnings.simplefilter("ignore")
    name = "A320-HeadingControlTask-Shaping.STANDARD-NoFG-v0"
    environments = [gymnasium.make(name) for _ in range(count)]
    for environment in environments:
        environment.reset(seed=0)
    action = 0.0 * environments[0].action_space.sample()
    steps = 0
    while True:
        for environment in environments:
            _, _, terminated, truncated, _ = environment.step(action)
            if terminated or truncated:
                environment.reset(seed=0)
        steps += 1
        yield steps / INTERACTIONS_HZ


LOOPS: dict[str, tuple[Callable[[int], Loop], str]] = {
    "bluesky": (bluesky, "bluesky-simulator"),
    "bluebird-dt": (bluebird_dt, "bluebird-dt"),
    "jsbgym": (jsbgym, "jsbgym"),
}
"""Loop and package of each simulator."""


def rates(loop: Loop, simulated_s: float) -> dict[str, float]:
    """Return step and simulated seconds per second of CPU and of wall time, set-up left out."""
    from_s, now_s, steps = next(loop), 0.0, 0
    begun, cpu_begun = time.perf_counter(), time.process_time()
    while now_s - from_s < simulated_s:
        now_s, steps = next(loop), steps + 1
    return {
        "step_s": (now_s - from_s) / steps,
        "per_cpu_s": (now_s - from_s) / (time.process_time() - cpu_begun),
        "per_wall_s": (now_s - from_s) / (time.perf_counter() - begun),
    }


def main() -> None:
    """Time one loop."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name", choices=LOOPS)
    parser.add_argument("count", type=int)
    parser.add_argument("--seconds", type=float, default=200.0)
    given = parser.parse_args()
    loop, package = LOOPS[given.name]
    try:
        version = importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        print(json.dumps({"lacks": package}))
        return
    print(json.dumps({"version": version, **rates(loop(given.count), given.seconds)}))


if __name__ == "__main__":
    main()
