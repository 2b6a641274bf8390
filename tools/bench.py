"""Benchmarks, each printed as ratios within one run.

    python tools/bench.py headon            one encounter against bare JSBSim and real time
    python tools/bench.py fifty             fifty aircraft: real-time factor and memory
    python tools/bench.py crowd             100 and 500 aircraft: CPU time of a simulated second
    python tools/bench.py terminal          2 aircraft, 2 vehicles and a deer at an airport
    python tools/bench.py airport           20 aircraft and 20 vehicles at an airport
    python tools/bench.py procedures        climbs and go-arounds beside what is published, then
                                            every procedure, type and weather, over 20 seeds;
                                            exits 1 if a number is out of its range
    python tools/bench.py phraseology       calls that are read in a second on one core
    python tools/bench.py speech            what sound costs a call, and how late words come
    python tools/bench.py render            CPU time of a picture, with both renderers
    python tools/bench.py detection         CPU time of a look at a picture
    python tools/bench.py frames            memory of a renderer's process over 10,000 pictures
    python tools/bench.py sight             whole runs with cameras against real time
    python tools/bench.py many              runs one after the other in a process: CPU, memory
    python tools/bench.py page              frames a second of the page that follows 20 aircraft
    python tools/bench.py seat              the page of a controller beside 20 aircraft: frames
    python tools/bench.py seat --minutes 120    and memory of run, server and page each minute
    python tools/bench.py seat --sound --camera     with speech, a microphone and a tower camera
    python tools/bench.py soak              two simulated hours with speech: memory, time
    python tools/bench.py sweep             overhead of a sweep, gain of a second worker
    python tools/bench.py startup           from the command to the first simulated second
    python tools/bench.py bluesky --peers-python VENV/bin/python
                                            the head-on encounter beside BlueSky, by wall time
    python tools/bench.py peers --peers-python VENV/bin/python --rounds 3
                                            AIRHILT, bare JSBSim at its step, BlueSky, BluebirdATC
                                            and jsbgym with 2, 50 and 500 aircraft, by CPU time
    python tools/bench.py headon --json

Each number is the best of several rounds, because other load on a machine only ever slows it.
"""

from __future__ import annotations

import argparse
import importlib
import itertools
import json
import math
import sys
from collections.abc import Iterable
from typing import Any

import standard_output

BENCHMARKS = {
    "headon": "traffic",
    "fifty": "traffic",
    "crowd": "traffic",
    "terminal": "traffic",
    "airport": "traffic",
    "phraseology": "calls",
    "speech": "calls",
    "render": "pictures",
    "detection": "pictures",
    "frames": "pictures",
    "sight": "pictures",
    "many": "many_runs",
    "sweep": "sweeps",
    "page": "page",
    "soak": "soak",
    "startup": "startup",
}
"""Module of `benchmarks` that has the function of a name."""

LONGEST_MINUTES = 1440
"""Longest time at the seat, in minutes: a day."""


def main() -> None:
    """Run one benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("name", choices=[*BENCHMARKS, "bluesky", "peers", "procedures", "seat"])
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument(
        "--peers-python",
        "--bluesky-python",
        default=sys.executable,
        metavar="PYTHON",
        help="Python that has the other simulators",
    )
    parser.add_argument("--rounds", type=int, default=3, help="rounds of peers")
    parser.add_argument("--seeds", type=int, default=20, help="seeds of each procedure")
    parser.add_argument("--minutes", type=_minutes, default=1.0, help="time at the seat")
    parser.add_argument("--sound", action="store_true", help="speech and a microphone at the seat")
    parser.add_argument("--camera", action="store_true", help="pictures of a tower at the seat")
    given = parser.parse_args()
    if given.name == "procedures":
        from benchmarks import procedures, published_flight

        rows = itertools.chain(published_flight.rows(), procedures.rows(given.seeds))
        failed = [row.is_failed for row in print_rows(rows, as_json=given.json)]
        sys.exit(1 if any(failed) else 0)
    if given.name == "peers":
        from benchmarks import peers

        print_rows(peers.rows(given.peers_python, given.rounds), as_json=given.json)
        return
    if given.name == "seat":
        from benchmarks.seat import looks

        print_rows(
            looks(given.minutes, has_sound=given.sound, has_camera=given.camera), as_json=given.json
        )
        return
    numbers = measured(given.name, given.peers_python)
    if given.json:
        print(json.dumps(numbers, indent=2))
        return
    for name, value in numbers.items():
        print(f"{name:32} {value:10.3f}")


def _minutes(text: str) -> float:
    minutes = float(text)
    if not 0.0 < minutes <= LONGEST_MINUTES:
        raise argparse.ArgumentTypeError(
            f"{text}: expected more than 0 and up to {LONGEST_MINUTES}"
        )
    return minutes


def measured(name: str, peers_python: str) -> dict[str, float]:
    """Return the numbers of a benchmark; only its own module is imported."""
    if name == "bluesky":
        from benchmarks.peers import bluesky

        return bluesky(peers_python)
    benchmark = getattr(importlib.import_module(f"benchmarks.{BENCHMARKS[name]}"), name)
    numbers: dict[str, float] = benchmark()
    return numbers


def _finite(value: Any) -> Any:
    """Return a value as JSON has it: null for the open end of a range."""
    if isinstance(value, dict):
        return {name: _finite(one) for name, one in value.items()}
    if isinstance(value, tuple):
        return [_finite(one) for one in value]
    return None if isinstance(value, float) and math.isinf(value) else value


def print_rows(rows: Iterable[Any], *, as_json: bool) -> list[Any]:
    """Print the rows of a benchmark, line by line as they are measured; return them."""
    done = []
    for row in rows:
        done.append(row)
        if not as_json:
            print(row, flush=True)
    if as_json:
        print(json.dumps([_finite(row._asdict()) for row in done], indent=2))
    return done


if __name__ == "__main__":
    standard_output.run(main)
