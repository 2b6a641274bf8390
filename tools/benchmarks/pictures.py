"""Pictures: drawing them, looking at them, and whole runs with cameras."""

from __future__ import annotations

import math
import re
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path

import numpy as np

from airhilt import load, run
from airhilt.assistant.vision.detector import Picture, Shot
from airhilt.assistant.vision.detectors.embedded import EmbeddedDetector
from airhilt.assistant.vision.gating import Gate
from airhilt.errors import RendererError
from airhilt.sensors.cameras.renderer_process import RendererProcess, probe
from airhilt.sensors.cameras.renderers import FAMILY
from airhilt.sensors.cameras.scene.bodies import BodyState
from benchmarks.landing import LandingScene, watched_landing
from benchmarks.rounds import ROUNDS


def render() -> dict[str, float]:
    """Take pictures of 640 by 360 pixels with three bodies in them, turn by turn.

    A camera is fixed, or on the nose of a 737 on final, flying straight (moving) or turning by
    more than a pixel a picture, so that all is drawn anew (turning); or nothing moves before it
    (idle). Each number is the CPU time of a picture, the mean of a second, in the best second.
    ``numpy_exp_ms``, 1.4 million exponentials, tells how fast the machine is just now.
    """
    landing = LandingScene()
    numbers = np.random.default_rng(0).random((640 * 360, 6), dtype=np.float32)
    renderers = {name: landing.renderer(name) for name in installed()}
    measured: dict[str, list[float]] = {}
    scenes = [
        ("fixed", "runway_01", landing.bodies()),
        ("idle", "runway_01", [list[BodyState]()] * 16),
        ("moving", "nose", landing.bodies()),
        ("turning", "nose", landing.bodies(turn_rad=0.002)),
    ]

    def measure(name: str, shots: Sequence[Callable[[], object]]) -> None:
        begun = time.process_time()
        for shoot in shots:
            shoot()
        spent = 1000.0 * (time.process_time() - begun) / len(shots)
        measured.setdefault(name, []).append(spent)

    for _ in range(2 * ROUNDS):
        measure("numpy_exp_ms", [partial(np.exp, numbers)] * 16)
        for name, renderer in renderers.items():
            for what, camera, scene in scenes:
                shots = [partial(renderer.shoot, [camera], bodies, 0) for bodies in scene]
                measure(f"{name}_{what}_ms", shots)
    for renderer in renderers.values():
        renderer.close()
    return {name: min(times) for name, times in measured.items()}


def detection() -> dict[str, float]:
    """Look at pictures of 640 by 360 pixels with the detector that ships.

    They are those of `render`, with three bodies, from the runway and from the nose. Numbers are
    the CPU time of a picture, the mean of a second, in the best second, of a look at all of it and
    (``gated``) as a run looks, at what has changed; and how many places are looked at twice.
    """
    landing, detector = LandingScene(), EmbeddedDetector(threads=1)
    renderer = landing.renderer("embree")
    shown = {
        camera: [renderer.shoot([camera], scene, 0)[0].colour for scene in landing.bodies()]
        for camera in ("runway_01", "nose")
    }
    renderer.close()
    measured: dict[str, float] = {}
    for camera, pictures in shown.items():
        times: list[float] = []
        first: list[float] = []
        gated: list[float] = []
        ways: list[tuple[list[float], Callable[[Picture], object]]] = [
            (times, detector.detect),
            (first, detector.proposed),
            (gated, partial(Gate(detector).look, Shot(camera, 0))),
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


def frames() -> dict[str, float]:
    """Take 10,000 pictures in the process of its own, and ask for its memory on the way."""
    scenario = load("s01b_nominal")
    scene = [[bodies[0]._replace(actor="AAL123")] for bodies in LandingScene().bodies()]
    found: dict[str, float] = {}
    for name in installed():
        with RendererProcess(scenario, ["runway_01"], name) as renderer:
            for taken in range(10_001):
                renderer.take(["runway_01"], scene[taken % len(scene)], 0)
                if taken in (1_000, 10_000):
                    held = memory_mb(renderer.processes[0].process_id, "VmRSS")
                    found[f"{name}_mb_after_{taken}"] = held
            found[f"{name}_mb_at_most"] = memory_mb(renderer.processes[0].process_id, "VmHWM")
    return found


def sight() -> dict[str, float]:
    """Run s02a_headon as it comes, and a landing before four cameras, with detection."""
    measured: dict[str, float] = {}
    for name, scenario, renderer in (
        (f"{kind}_{renderer}", scenario, renderer)
        for kind, scenario in (("headon", load("s02a_headon")), ("four_cameras", watched_landing()))
        for renderer in installed()
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


def installed() -> list[str]:
    """Return the names of the renderers that can draw here."""
    found = []
    for name in FAMILY.names():
        with suppress(RendererError):
            probe(name)
            found.append(name)
    return found


def memory_mb(process_id: int, what: str) -> float:
    """Return a number of a process's memory, as Linux tells it."""
    told = Path(f"/proc/{process_id}/status").read_text(encoding="utf-8")
    found = re.search(rf"^{what}:\s+(\d+) kB", told, re.MULTILINE)
    return int(found[1]) / 1024.0 if found else math.nan
