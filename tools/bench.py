"""Benchmarks, each printed as ratios within one run.

    python tools/bench.py headon            one encounter against bare JSBSim and real time
    python tools/bench.py fifty             fifty aircraft: real-time factor and memory
    python tools/bench.py terminal          2 aircraft, 2 vehicles and a deer at an airport
    python tools/bench.py airport           20 aircraft and 20 vehicles at an airport
    python tools/bench.py procedures        every procedure, type and weather, over 20 seeds
    python tools/bench.py phraseology       calls that are read in a second on one core
    python tools/bench.py speech            what sound costs a call, and how late words come
    python tools/bench.py render            CPU time of a picture, with both renderers
    python tools/bench.py frames            memory of a renderer's process over 10,000 pictures
    python tools/bench.py sight             whole runs with cameras against real time
    python tools/bench.py startup           from the command to the first simulated second
    python tools/bench.py bluesky --bluesky-python VENV/bin/python
    python tools/bench.py headon --json

Each number is the best of several rounds, because other load on a machine only ever slows it.
"""

from __future__ import annotations

import argparse
import json
import math
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from airhilt.assistant.vision.detector import Picture
    from airhilt.metrics.summary import Summary
    from airhilt.scenario import Scenario
    from airhilt.sensors.cameras import RendererName
    from airhilt.sensors.cameras.scene.bodies import BodyState
    from airhilt.sensors.cameras.scene_renderer import SceneRenderer

ROUNDS = 5

BLUESKY = """
import time, bluesky as bs
bs.init(mode="sim", detached=True)
bs.settings.simdt = 0.05
bs.sim.simdt = 0.05
for i, lon in enumerate((-77.4, -76.6)):
    bs.traf.cre(f"AC{i}", "B737", 38.9, lon, 90 if i == 0 else 270, 35000 * 0.3048, 135)
bs.sim.op()
best = 0.0
for _ in range(3):
    begun, from_s = time.perf_counter(), bs.sim.simt
    for _ in range(4000):
        bs.sim.step()
    best = max(best, (bs.sim.simt - from_s) / (time.perf_counter() - begun))
print(best)
"""


def best(measure: Callable[[], float], rounds: int = ROUNDS) -> float:
    """Return the least of several measurements."""
    return min(measure() for _ in range(rounds))


def headon() -> dict[str, float]:
    """Compare s02a_headon with stepping its two aircraft bare, turn by turn."""
    from airhilt import load, run
    from airhilt.cosim.setup import TICK_S
    from airhilt.scenario.perturbation import realise
    from airhilt.world.actors import build_actors
    from airhilt.world.site import ScenarioSite

    scenario = load("s02a_headon")
    factors, whole, bare = [], [], []
    for _ in range(ROUNDS):
        with tempfile.TemporaryDirectory() as scratch:
            summary = run(scenario, out=Path(scratch) / "run", cameras=False).summary
        factors.append(summary.real_time_factor)
        whole.append(summary.cpu_s / summary.duration_s)
        realised, _ = realise(scenario, 0)
        cast = build_actors(realised, ScenarioSite.of(realised), 0, TICK_S)
        steppers = [flight.body._airframe.step for flight in cast.values()]
        begun = time.process_time()
        for _ in range(60 * round(6 / TICK_S)):
            for step in steppers:
                step()
        bare.append((time.process_time() - begun) / 60.0)
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


def fifty_scenario() -> Scenario:
    """Return fifty 737s on ten levels that all fly to one point."""
    from airhilt import load
    from airhilt.scenario import Scenario

    document = load("s02a_headon").model_dump(mode="json")
    template = document["actors"][0]
    document |= {"name": "fifty", "conflict": None, "end_when": [], "perturbations": []}
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
    from airhilt import run

    with tempfile.TemporaryDirectory() as scratch:
        summary = run(fifty_scenario(), out=Path(scratch) / "run").summary
    peak_kib = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return {"real_time_factor": summary.real_time_factor, "peak_memory_mb": peak_kib / 1024.0}


def terminal_scenario() -> Scenario:
    """Return a landing, a departure, two vehicles that drive, and a deer."""
    from airhilt import load
    from airhilt.scenario import Scenario

    document = load("s01b_nominal").model_dump(mode="json")
    departure = load("s01a_tight_timing").model_dump(mode="json")["actors"][1]
    deer = load("s01c_nominal").model_dump(mode="json")["actors"][1]
    document["actors"] += [departure, deer]
    document["actors"][2]["commands"] = [
        {"action": "taxi", "to": {"type": "hold_short", "runway": "01", "taxiway": "A"}}
    ]
    document |= {"name": "terminal", "duration_s": 150.0, "end_when": [], "perturbations": []}
    return Scenario.model_validate(document)


def terminal() -> dict[str, float]:
    """Run 2 aircraft, 2 vehicles and an animal."""
    return _repeated(terminal_scenario())


def airport_scenario() -> Scenario:
    """Return five arrivals, five departures and ten taxiing aircraft among twenty vehicles."""
    from airhilt.scenario import Scenario
    from airhilt.world.surface.airport import load_airport
    from airhilt.world.surface.layout import Layout

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
    from airhilt import run

    factors = []
    for _ in range(rounds):
        with tempfile.TemporaryDirectory() as scratch:
            summary = run(scenario, out=Path(scratch) / "run", cameras=False).summary
        factors.append(summary.real_time_factor)
    return {
        "real_time_factor_best": max(factors),
        "real_time_factor_median": statistics.median(factors),
    }


def calls() -> tuple[list[str], tuple[str, ...]]:
    """Return calls as they are made, and who is on the frequency.

    They are the lines of the scenario suite, and instructions and readbacks of all kinds in both
    phraseologies, each as it is written and as a recogniser writes it.
    """
    from airhilt import load
    from airhilt.library import names
    from airhilt.phraseology import Instruction, say

    callsigns = ("AAL123", "DAL456", "BAW38", "DLH4AB", "UAL1200", "N172SP", "G-ABCD", "OPS1")
    told = [
        [Instruction("cleared_to_land", "19")],
        [Instruction("cleared_for_takeoff", "01L", immediate=True)],
        [Instruction("line_up", "33", condition="behind the landing cessna")],
        [Instruction("cross", "15", "M"), Instruction("hold_short", "01")],
        [Instruction("taxi", "19", via=("A", "K")), Instruction("hold_short", "15")],
        [Instruction("altitude", sense="climb", altitude_ft=33_000.0)],
        [
            Instruction("heading", turn="right", heading_deg=90.0),
            Instruction("altitude", sense="descend", altitude_ft=4500.0),
        ],
        [Instruction("contact", position="washington centre", frequency_khz=134_325)],
        [Instruction("go_around"), Instruction("altitude", sense="climb", altitude_ft=3000.0)],
        [Instruction("speed", speed_kt=180.0, condition="until 4 mile final")],
    ]
    said = [
        speak(callsign, instructions, style)
        for speak in (say.speak_instruction, say.speak_readback)
        for style in ("faa", "icao")
        for callsign in callsigns
        for instructions in told
    ]
    said += [line.text for name in names("scenarios") for line in load(name).radio.lines]
    return said + [re.sub(r"[^a-z ]", "", text.lower()) for text in said], callsigns


def phraseology() -> dict[str, float]:
    """Read calls, in the time of one core that it takes."""
    from airhilt.phraseology import parse_call

    said, callsigns = calls()

    def once() -> float:
        begun = time.process_time()
        for text in said:
            parse_call(text, callsigns)
        return time.process_time() - begun

    once()
    spent = [once() for _ in range(3 * ROUNDS)]
    return {
        "calls": len(said),
        "calls_per_s_best": len(said) / min(spent),
        "calls_per_s_median": len(said) / statistics.median(spent),
    }


FIRST_SECOND = """
import sys, time
from pathlib import Path
from airhilt.cosim import Observer, run
from airhilt.options import Options
from airhilt.world.loading import load
class First(Observer):
    def snapshot(self, snapshot):
        if snapshot.t_s >= 1.0:
            print(time.time())
            sys.stdout.flush()
            raise KeyboardInterrupt
try:
    run(load("s02a_headon"), Options(out=Path(sys.argv[1]) / "run"), First())
except KeyboardInterrupt:
    pass
"""


def speech() -> dict[str, float]:
    """Compare a run with sound, its voices cached, with one without, turn by turn."""
    from airhilt import run
    from airhilt.assistant.asr.engines import asr_engine
    from airhilt.audio.wav import read_wav
    from airhilt.voices.engine import SAMPLE_RATE_HZ

    engine = asr_engine("embedded")

    def measured(*, is_spoken: bool) -> tuple[float, Summary, float]:
        """Return CPU time, summary, and the CPU time of recognition by the length of the calls."""
        with tempfile.TemporaryDirectory() as scratch:
            begun = time.process_time()
            done = run("s01a_misaddressed", out=Path(scratch) / "run", speech=is_spoken)
            cpu_s = time.process_time() - begun
            calls = [read_wav(path) for path in sorted(done.folder.glob("audio/[!a]*.wav"))]
            begun = time.process_time()
            for call in calls:
                engine.recognise(call, ("AAL123", "DAL456"))
            heard_s = sum(map(len, calls)) / SAMPLE_RATE_HZ
            return cpu_s, done.summary, (time.process_time() - begun) / max(heard_s, 1e-9)

    measured(is_spoken=True)
    silent_s = spoken_s = factor = late_s = math.inf
    for _ in range(ROUNDS):
        silent_s = min(silent_s, measured(is_spoken=False)[0])
        cpu_s, summary, of_time = measured(is_spoken=True)
        spoken_s, factor = min(spoken_s, cpu_s), min(factor, of_time)
        late_s = min(late_s, summary.latencies["asr_after_end"].p95_s or math.inf)
    return {
        "cpu_ms_a_call": 1e3 * (spoken_s - silent_s) / summary.radio.transmissions,
        "asr_real_time_factor": factor,
        "asr_after_end_p95_s": late_s,
        "cpu_ratio_to_no_speech": spoken_s / silent_s,
    }


def render() -> dict[str, float]:
    """Take pictures of 640 by 360 pixels with three bodies in them, turn by turn.

    A camera is fixed, or on the nose of a 737 on final, flying straight (moving) or turning by
    more than a pixel a picture, so that all is drawn anew (turning); or nothing moves before it
    (idle). Each number is the CPU time of a picture, the mean of a second, in the best second.
    ``numpy_exp_ms``, 1.4 million exponentials, tells how fast the machine is just now.
    """
    import numpy as np

    from airhilt.sensors.cameras import RENDERERS
    from airhilt.sensors.cameras.scene.bodies import BodyState

    stage = Stage()
    numbers = np.random.default_rng(0).random((640 * 360, 6), dtype=np.float32)
    studios = {name: stage.studio(name) for name in RENDERERS}
    measured: dict[str, list[float]] = {}
    scenes = [
        ("fixed", "runway_01", stage.scene()),
        ("idle", "runway_01", [list[BodyState]()] * 16),
        ("moving", "nose", stage.scene()),
        ("turning", "nose", stage.scene(turn_rad=0.002)),
    ]

    def measure(name: str, shots: Sequence[Callable[[], object]]) -> None:
        begun = time.process_time()
        for shoot in shots:
            shoot()
        spent = 1000.0 * (time.process_time() - begun) / len(shots)
        measured.setdefault(name, []).append(spent)

    for _ in range(2 * ROUNDS):
        measure("numpy_exp_ms", [partial(np.exp, numbers)] * 16)
        for name, studio in studios.items():
            for what, camera, scene in scenes:
                shots = [partial(studio.shoot, [camera], bodies, 0) for bodies in scene]
                measure(f"{name}_{what}_ms", shots)
    for studio in studios.values():
        studio.close()
    return {name: min(times) for name, times in measured.items()}


def detection() -> dict[str, float]:
    """Look at pictures of 640 by 360 pixels with the detector that ships.

    They are those of `render`, with three bodies, from the runway and from the nose. Numbers are
    the CPU time of a picture, the mean of a second, in the best second, of a look at all of it and
    (``gated``) as a run looks, at what has changed; and how many places are looked at twice.
    """
    from airhilt.assistant.vision.detectors.embedded import EmbeddedDetector
    from airhilt.assistant.vision.gating import Gate

    stage, detector = Stage(), EmbeddedDetector(threads=1)
    studio = stage.studio("moderngl")
    shown = {
        camera: [studio.shoot([camera], scene, 0)[0].colour for scene in stage.scene()]
        for camera in ("runway_01", "nose")
    }
    studio.close()
    measured: dict[str, float] = {}
    for camera, pictures in shown.items():
        times: list[float] = []
        first: list[float] = []
        gated: list[float] = []
        ways: list[tuple[list[float], Callable[[Picture], object]]] = [
            (times, detector.detect),
            (first, detector.proposed),
            (gated, partial(Gate(detector).look, camera)),
        ]
        for _ in range(2 * ROUNDS):
            for spent, look in ways:
                begun = time.process_time()
                for picture in pictures:
                    look(picture)
                spent.append(1000.0 * (time.process_time() - begun) / len(pictures))
        places = [len(detector.uncalibrated(picture)) for picture in pictures]
        measured[f"{camera}_ms"] = min(times)
        measured[f"{camera}_gated_ms"] = min(gated)
        measured[f"{camera}_first_network_ms"] = min(first)
        measured[f"{camera}_places"] = sum(places) / len(places)
    return measured


class Stage:
    """Washington: a 737 on final to runway 01, a 747 and a fire truck on it, and two cameras."""

    def __init__(self) -> None:
        from airhilt import load
        from airhilt.sensors.cameras.mounts import Camera, Mount, cameras_of
        from airhilt.sensors.cameras.scene.bodies import Model, aircraft_model, vehicle_model
        from airhilt.sensors.cameras.scene.builder import light_of, world_of
        from airhilt.sensors.cameras.view import Intrinsics, Pose
        from airhilt.world.site import ScenarioSite

        scenario = load("s01b_nominal")
        self._setting = ScenarioSite.of(scenario)
        self._light = light_of(scenario, self._setting)
        self._world = world_of(scenario, self._setting, self._light)
        self._models: dict[str, Model] = {
            "737": aircraft_model("737"),
            "B747": aircraft_model("B747"),
            "fire_truck": vehicle_model("fire_truck"),
        }
        nose = Mount("737", Pose.of((0.0, 17.5, 1.0), 0.0, -0.03), sees_own_aircraft=False)
        self._cameras = [
            cameras_of(scenario, self._setting, self._models)["runway_01"],
            Camera("nose", Intrinsics(640, 360, math.radians(60.0)), nose),
        ]

    def studio(self, renderer: RendererName) -> SceneRenderer:
        """Return a studio with both cameras."""
        from airhilt.sensors.cameras.scene_renderer import SceneRenderer

        return SceneRenderer(self._world, self._light, self._models, self._cameras, renderer)

    def scene(self, turn_rad: float = 0.0) -> list[list[BodyState]]:
        """Return where all are in the pictures of a second, 70 m/s down a path of 3 degrees."""
        return [
            [
                self._body("737", 4.4 * k - 700.0, 45.0 - 0.23 * k, turn_rad * k, "gear"),
                self._body("B747", 900.0 + k, 4.1, 1.2, "gear"),
                self._body("fire_truck", 500.0 + k, 0.0, 1.5, "driving"),
            ]
            for k in range(16)
        ]

    def _body(
        self, actor: str, along_m: float, up_m: float, turned: float, shape: str
    ) -> BodyState:
        from airhilt.geodesy.positions import RunwayPosition
        from airhilt.sensors.cameras.mounts import frame_of
        from airhilt.sensors.cameras.scene.bodies import BodyState

        assert self._setting.layout is not None
        course = self._setting.layout.runway("01").course_rad
        place = RunwayPosition(type="runway", runway="01", along_m=along_m)
        east, north = frame_of(self._setting).to_local(self._setting.place(place))
        return BodyState(actor, east, north, up_m, course + turned, 0.0, 0.0, shape, True)


def frames() -> dict[str, float]:
    """Take 10,000 pictures in the process of its own, and ask for its memory on the way."""
    from airhilt import load
    from airhilt.sensors.cameras.renderer_process import RendererProcess

    scenario = load("s01b_nominal")
    scene = [[bodies[0]._replace(actor="AAL123")] for bodies in Stage().scene()]
    found: dict[str, float] = {}
    for renderer in ("open3d", "moderngl"):
        with RendererProcess(scenario, ["runway_01"], renderer) as studio:
            for taken in range(10_001):
                studio.shoot(["runway_01"], scene[taken % len(scene)], 0)
                if taken in (1_000, 10_000):
                    held = memory_mb(studio.process_id, "VmRSS")
                    found[f"{renderer}_mb_after_{taken}"] = held
            found[f"{renderer}_mb_at_most"] = memory_mb(studio.process_id, "VmHWM")
    return found


def watched_landing() -> Scenario:
    """Return a minute of a landing before a tower, a runway, a nose and a tail camera."""
    from airhilt import load
    from airhilt.scenario import Scenario
    from airhilt.units import DEGREE, FOOT
    from airhilt.world.surface.airport import load_airport

    document = load("s01b_nominal").model_dump(mode="json")
    document |= {"name": "watched", "duration_s": 60.0, "end_when": [], "cameras": []}
    for camera in load_airport("KDCA").cameras:
        if camera.name in ("tower_south", "runway_01"):
            latitude, longitude = (angle / DEGREE for angle in camera.place)
            place = {"type": "geodetic", "lat_deg": latitude, "lon_deg": longitude}
            mount = {
                "type": "fixed",
                "position": place,
                "height_ft": camera.height_m / FOOT,
                "azimuth_deg": camera.azimuth_deg,
                "elevation_deg": camera.elevation_deg,
            }
            fov_deg = camera.horizontal_fov_deg
            document["cameras"].append(
                {"name": camera.name, "mount": mount, "horizontal_fov_deg": fov_deg}
            )
    document["cameras"] += [
        {"name": station, "mount": {"type": "actor", "actor": "AAL123", "station": station}}
        for station in ("nose", "tail")
    ]
    return Scenario.model_validate(document)


def sight() -> dict[str, float]:
    """Run s02a_headon as it comes, and a landing before four cameras, with detection."""
    from airhilt import load, run

    measured: dict[str, float] = {}
    for name, scenario, renderer in (
        ("headon_open3d", load("s02a_headon"), "open3d"),
        ("four_cameras_moderngl", watched_landing(), "moderngl"),
    ):
        factors = []
        for _ in range(2):
            with tempfile.TemporaryDirectory() as scratch:
                out = Path(scratch) / "run"
                summary = run(scenario, out=out, renderer=renderer).summary
            factors.append(summary.real_time_factor)
        measured[f"{name}_real_time_factor_best"] = max(factors)
        measured[f"{name}_pictures_dropped"] = float(sum(summary.inputs_dropped.values()))
    return measured


def memory_mb(process_id: int, what: str) -> float:
    """Return a number of a process's memory, as Linux tells it."""
    told = Path(f"/proc/{process_id}/status").read_text(encoding="utf-8")
    found = re.search(rf"^{what}:\s+(\d+) kB", told, re.MULTILINE)
    return int(found[1]) / 1024.0 if found else math.nan


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


def bluesky(python: str) -> dict[str, float]:
    """Compare with BlueSky's point masses at the same step, BlueSky being in its own environment.

    Raises
    ------
    SystemExit
        There is no BlueSky in that environment.
    """
    ours = headon()["real_time_factor_best"]
    done = subprocess.run([python, "-c", BLUESKY], capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(
            f"{python}: cannot run BlueSky: {done.stderr.strip().splitlines()[-1:]}; make an "
            "environment with `pip install bluesky-simulator` and give its python"
        )
    theirs = float(done.stdout.strip().splitlines()[-1])
    return {"airhilt_x": ours, "bluesky_x": theirs, "ratio": ours / theirs}


def print_procedures(seeds: int, *, as_json: bool) -> None:
    """Print how well the procedures are flown, line by line as they are."""
    from procedures import rows

    done = []
    for row in rows(seeds):
        done.append(row._asdict())
        if not as_json:
            print(row, flush=True)
    if as_json:
        print(json.dumps(done, indent=2))


BENCHMARKS = {
    "headon": headon,
    "fifty": fifty,
    "terminal": terminal,
    "airport": airport,
    "phraseology": phraseology,
    "speech": speech,
    "render": render,
    "detection": detection,
    "frames": frames,
    "sight": sight,
    "startup": startup,
}


def main() -> None:
    """Run one benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("name", choices=[*BENCHMARKS, "bluesky", "procedures"])
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--bluesky-python", default="python3", metavar="PYTHON")
    parser.add_argument("--seeds", type=int, default=20, help="of the procedures")
    given = parser.parse_args()
    if given.name == "procedures":
        print_procedures(given.seeds, as_json=given.json)
        return
    numbers = bluesky(given.bluesky_python) if given.name == "bluesky" else BENCHMARKS[given.name]()
    if given.json:
        print(json.dumps(numbers, indent=2))
        return
    for name, value in numbers.items():
        print(f"{name:32} {value:10.3f}")


if __name__ == "__main__":
    main()
