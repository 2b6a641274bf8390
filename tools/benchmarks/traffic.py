"""Runs without cameras: one encounter, many aircraft, a terminal, a busy airport."""

from __future__ import annotations

import math
import resource
import statistics
import tempfile
import time
from pathlib import Path

from airhilt import load, run
from airhilt.cosim.setup import TICK_S
from airhilt.scenario import Scenario
from airhilt.scenario.perturbation import realise
from airhilt.world.actors import build_actors
from airhilt.world.flight import Aircraft
from airhilt.world.flight.airframe import Airframe
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.airport import load_airport
from airhilt.world.surface.layout import Layout
from benchmarks.rounds import ROUNDS

BARE_STEPS_HZ = 120.0
"""Steps a second of bare JSBSim in `headon`, whatever AIRHILT takes: JSBSim's own default."""


def headon() -> dict[str, float]:
    """Compare s02a_headon with its two aircraft at 120 bare steps a second, turn by turn."""
    scenario = load("s02a_headon")
    factors, whole, bare = [], [], []
    for _ in range(ROUNDS):
        with tempfile.TemporaryDirectory() as scratch:
            summary = run(scenario, out=Path(scratch) / "run", cameras=False).summary
        factors.append(summary.real_time_factor)
        whole.append(summary.cpu_s / summary.duration_s)
        bare.append(bare_cpu_s(airframes_of(scenario), 60.0, BARE_STEPS_HZ))
    return {
        "real_time_factor_best": max(factors),
        "real_time_factor_median": statistics.median(factors),
        "cpu_ms_per_simulated_s": 1000.0 * min(whole),
        "bare_cpu_ms_per_simulated_s": 1000.0 * min(bare),
        "cpu_ratio_to_bare_best": min(whole) / min(bare),
        "cpu_ratio_to_bare_median": statistics.median(
            a / b for a, b in zip(whole, bare, strict=True)
        ),
    }


def airframes_of(scenario: Scenario) -> list[Airframe]:
    """Return the flight dynamics of a scenario's aircraft, without anything around them."""
    realised, _ = realise(scenario, 0)
    actors = build_actors(realised, ScenarioSite.of(realised), 0, TICK_S)
    bodies = (actor.body for actor in actors.values())
    return [each.en_route.systems.airframe for each in bodies if isinstance(each, Aircraft)]


def step_s_of(airframes: list[Airframe]) -> float:
    """Return the step of the flight dynamics, in s."""
    step_s: float = airframes[0]._fdm.get_delta_t()
    return step_s


def bare_cpu_s(airframes: list[Airframe], simulated_s: float, steps_hz: float) -> float:
    """Return the CPU time of a simulated second of the flight dynamics alone, in s."""
    steppers = [airframe.step for airframe in airframes]
    begun = time.process_time()
    for _ in range(round(simulated_s * steps_hz)):
        for step in steppers:
            step()
    return (time.process_time() - begun) / simulated_s


def fifty_scenario() -> Scenario:
    """Return fifty 737s on ten levels that all fly to one point."""
    document = load("s02a_headon").model_dump(mode="json")
    template = document["actors"][0]
    document |= {
        "name": "fifty",
        "conflict": None,
        "end_when": [],
        "perturbations": [],
        "nominal_twin": None,
    }
    document |= {"duration_s": 60.0, "radio": {}, "cameras": []}
    document["actors"] = [
        template
        | {
            "callsign": f"TST{index}",
            "icao24": f"{0xABC000 + index:06x}",
            "initial": {
                "type": "airborne",
                "position": {
                    "type": "from_centre",
                    "bearing_deg": index * 7.2,
                    "distance_nm": 40.0 + 3.0 * (index % 5),
                },
                "altitude_ft": 29_000 + 1000.0 * (index % 10),
                "cas_kt": 255.0,
            },
            "route": [{"type": "from_centre", "bearing_deg": 0.0, "distance_nm": 0.0}],
        }
        for index in range(50)
    ]
    return Scenario.model_validate(document)


def fifty() -> dict[str, float]:
    """Run fifty aircraft."""
    with tempfile.TemporaryDirectory() as scratch:
        summary = run(fifty_scenario(), out=Path(scratch) / "run").summary
    peak_kib = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return {"real_time_factor": summary.real_time_factor, "peak_memory_mb": peak_kib / 1024.0}


def crowd_scenario(count: int, duration_s: float) -> Scenario:
    """Return 737s on ten levels that fly to the east, spread evenly over 150 nautical miles."""
    document = fifty_scenario().model_dump(mode="json")
    template = document["actors"][0]
    document |= {"name": "crowd", "duration_s": duration_s}
    document["actors"] = [
        template
        | {
            "callsign": f"TST{index}",
            "icao24": f"{0xABC000 + index:06x}",
            "initial": template["initial"]
            | {
                "position": _spread(index, count),
                "altitude_ft": 29_000 + 1000.0 * (index % 10),
            },
            "route": [{"type": "from_centre", "bearing_deg": 90.0, "distance_nm": 500.0}],
        }
        for index in range(count)
    ]
    return Scenario.model_validate(document)


def _spread(index: int, count: int) -> dict[str, object]:
    """Return one of a number of places that are equally dense in a circle (Vogel, 1979)."""
    return {
        "type": "from_centre",
        "bearing_deg": math.degrees(index * math.pi * (3.0 - math.sqrt(5.0))) % 360.0,
        "distance_nm": 150.0 * math.sqrt((index + 0.5) / count),
    }


def crowd() -> dict[str, float]:
    """Run a hundred aircraft, and five hundred."""
    return {f"cpu_s_per_simulated_s_of_{count}": crowd_cpu_s(count, 20.0) for count in (100, 500)}


def crowd_cpu_s(count: int, simulated_s: float) -> float:
    """Return the CPU time of a simulated second of a crowd, in s, without start and end."""
    short, long = (
        _cpu_s(crowd_scenario(count, duration_s)) for duration_s in (1.0, 1.0 + simulated_s)
    )
    return (long - short) / simulated_s


def _cpu_s(scenario: Scenario) -> float:
    with tempfile.TemporaryDirectory() as scratch:
        begun = time.process_time()
        run(scenario, out=Path(scratch) / "run", report=False)
        return time.process_time() - begun


def terminal_scenario() -> Scenario:
    """Return a landing, a departure, two vehicles that drive, and a deer."""
    document = load("s01b_nominal").model_dump(mode="json")
    departure = load("s01a_tight_timing").model_dump(mode="json")["actors"][1]
    deer = load("s01c_nominal").model_dump(mode="json")["actors"][1]
    document["actors"] += [departure, deer]
    document["actors"][2]["commands"] = [
        {"action": "taxi", "to": {"type": "hold_short", "runway": "01", "taxiway": "A"}}
    ]
    document |= {
        "name": "terminal",
        "duration_s": 150.0,
        "end_when": [],
        "perturbations": [],
        "nominal_twin": None,
    }
    return Scenario.model_validate(document)


def terminal() -> dict[str, float]:
    """Run 2 aircraft, 2 vehicles and an animal."""
    return _repeated(terminal_scenario())


def airport_scenario() -> Scenario:
    """Return five arrivals, five departures and ten taxiing aircraft among twenty vehicles."""
    layout = Layout(load_airport("KDCA"))
    stands, holds = list(layout.stands), ["A", "D", "E", "F", "N"]

    def stand(index: int) -> dict[str, object]:
        position = {"type": "node", "node": stands[index % len(stands)]}
        return {"type": "standing", "position": position, "heading_deg": 85.0}

    def to_hold(index: int) -> dict[str, object]:
        place = {"type": "hold_short", "runway": "01", "taxiway": holds[index % len(holds)]}
        return {"action": "taxi", "to": place}

    actors: list[dict[str, object]] = []
    for index in range(20):
        aircraft = {
            "type": "aircraft",
            "callsign": f"TST{index}",
            "icao24": f"{0xABC000 + index:06x}",
            "aircraft": "737",
        }
        if index < 10:
            final = {"type": "final", "runway": "01", "distance_nm": 2.0 + 1.2 * index}
            land = {"action": "land", "runway": "01"}
            actors.append(aircraft | {"initial": final, "commands": [land]})
        else:
            actors.append(aircraft | {"initial": stand(index), "commands": [to_hold(index)]})
    for index in range(20):
        actors.append(
            {
                "type": "vehicle",
                "callsign": f"OPS{index}",
                "icao24": f"{0xABD000 + index:06x}",
                "kind": "follow_me",
                "initial": stand(index),
                "commands": [to_hold(index + 2)],
                "transponder": {"equipped": True},
            }
        )
    return Scenario.model_validate(
        {
            "name": "airport",
            "title": "A busy airport",
            "family": "S01A",
            "scene": {"type": "airport", "airport": "KDCA"},
            "duration_s": 90.0,
            "actors": actors,
        }
    )


def airport() -> dict[str, float]:
    """Run 20 aircraft and 20 vehicles."""
    return _repeated(airport_scenario(), rounds=2)


def _repeated(scenario: Scenario, rounds: int = ROUNDS) -> dict[str, float]:
    factors = []
    for _ in range(rounds):
        with tempfile.TemporaryDirectory() as scratch:
            summary = run(scenario, out=Path(scratch) / "run", cameras=False).summary
        factors.append(summary.real_time_factor)
    return {
        "real_time_factor_best": max(factors),
        "real_time_factor_median": statistics.median(factors),
    }
