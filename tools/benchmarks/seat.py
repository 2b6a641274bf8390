"""A controller's seat in a headless Chromium beside a run of 20 aircraft: frames and memory."""

from __future__ import annotations

import itertools
import json
import math
import shutil
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import psutil

from airhilt import load
from airhilt.scenario import Scenario
from benchmarks.page import COUNTED, SETTLING_S, chromium_process, cpu_s, pause
from benchmarks.soak import soak_scenario

sys.path.append(str(Path(__file__).parents[2] / "tests" / "support"))

from devtools import BROWSERS, Page, browser_page
from microphone import BUTTON, FAKE, TALK_STATE, open_microphone, sit_down
from stations import running

AIRCRAFT = 20
LEVELS_FT = range(4_000, 9_000, 1_000)
"""Altitudes in ft, each of which has as many aircraft."""
LONGEST_PERIOD_S = 60
"""Longest time between two looks, in s."""


class Look(NamedTuple):
    """Frames since the look before, and what the processes hold; a plan is a drawn plan view."""

    minutes: float
    frames_per_s: float
    plans_per_s: float
    plan_stood_ms_p95: float
    plan_stood_ms_most: float
    run_and_server_cores: float
    browser_cores: float
    run_mb: float
    server_mb: float
    page_mb: float
    page_heap_mb: float


def looks(minutes: float, *, has_sound: bool, has_camera: bool) -> Iterator[Look]:
    """Sit at the seat for some minutes, and look at most once a minute.

    With sound, calls are spoken, recognised and heard at the seat, whose microphone is open. With
    a camera, the pictures of a tower are drawn, looked at by the detector, and shown.
    """
    executable = next((found for name in BROWSERS if (found := shutil.which(name))), None)
    if executable is None:
        sys.exit("no Chromium on PATH: apt-get install chromium")
    period_s = min(LONGEST_PERIOD_S, math.ceil(60.0 * minutes))
    count = math.ceil(60.0 * minutes / period_s)
    with tempfile.TemporaryDirectory() as scratch:
        file = Path(scratch) / "sector.json"
        duration_s = count * 2.0 * period_s + 300.0  # Looks take time, too.
        file.write_text(sector_scenario(duration_s, has_camera=has_camera).model_dump_json())
        with (
            running(file, Path(scratch) / "run", "--seat", "tower", speech=has_sound) as run,
            browser_page(executable, *FAKE) as browser,
        ):
            process, url = run
            browser.call("Page.addScriptToEvaluateOnNewDocument", source=COUNTED)
            sit_down(browser, url)
            browser.wait_for("document.body.dataset.seat === 'controller'")
            browser.wait_for(f"document.querySelectorAll('.flight-strip').length >= {AIRCRAFT}")
            if has_sound:
                open_microphone(browser)
                if browser.evaluate(BUTTON) != "Hold to talk":
                    sys.exit(f"no microphone: {browser.evaluate(TALK_STATE)}")
            if has_camera:
                browser.wait_for("document.getElementById('camera-image').src")
            pause(browser, SETTLING_S)
            for number in range(1, count + 1):
                yield _look(browser, psutil.Process(process.pid), period_s, number)
            browser.open("about:blank")


def _look(browser: Page, run: psutil.Process, period_s: int, number: int) -> Look:
    chromium = chromium_process()
    before_s, browser_before_s = cpu_s(run), cpu_s(chromium)
    browser.evaluate("counted.frames = 0, counted.plans = []")
    pause(browser, period_s)
    counted = json.loads(browser.evaluate("JSON.stringify(counted)"))
    used_s, browser_s = cpu_s(run) - before_s, cpu_s(chromium) - browser_before_s
    stood_ms = sorted(b - a for a, b in itertools.pairwise(counted["plans"])) or [math.inf]
    browser.call("HeapProfiler.collectGarbage")
    server = next(one for one in run.children(recursive=True) if "view" in one.cmdline())
    renderers = (one for one in chromium.children(recursive=True) if _is_renderer(one))
    return Look(
        minutes=number * period_s / 60.0,
        frames_per_s=counted["frames"] / period_s,
        plans_per_s=len(counted["plans"]) / period_s,
        plan_stood_ms_p95=stood_ms[int(0.95 * len(stood_ms))],
        plan_stood_ms_most=stood_ms[-1],
        run_and_server_cores=used_s / period_s,
        browser_cores=browser_s / period_s,
        run_mb=_held_mb(run),
        server_mb=_held_mb(server),
        page_mb=max(map(_held_mb, renderers)),
        page_heap_mb=browser.call("Runtime.getHeapUsage")["usedSize"] / 1e6,
    )


def _is_renderer(process: psutil.Process) -> bool:
    return any(one.startswith("--type=renderer") for one in process.cmdline())


def _held_mb(process: psutil.Process) -> float:
    return float(process.memory_info().rss) / 1e6


def sector_scenario(duration_s: float, *, has_camera: bool = False) -> Scenario:
    """Return aircraft that fly to and fro on five levels, one of which calls again and again."""
    document = soak_scenario(duration_s).model_dump(mode="json")
    first = document["actors"][0]
    document["actors"] = [
        first
        | {
            "callsign": first["callsign"] if not index else f"TST{index}",
            "icao24": f"{0xABC000 + index:06x}",
            "initial": first["initial"]
            | {
                "position": _from_centre(18.0 * index, 6.0 + index),
                "altitude_ft": float(LEVELS_FT[index % len(LEVELS_FT)]),
            },
            "route": [_from_centre(18.0 * index + side, 30.0) for side in (90.0, 270.0)]
            * math.ceil(duration_s / 600.0),
        }
        for index in range(AIRCRAFT)
    ]
    at_tower = [one for one in load("s01b_nominal").cameras if one.name == "delta_tower"]
    cameras = [one.model_dump(mode="json") for one in at_tower] if has_camera else []
    return Scenario.model_validate(
        document | {"name": "sector", "title": "A busy sector", "cameras": cameras}
    )


def _from_centre(bearing_deg: float, distance_nm: float) -> dict[str, object]:
    return {"type": "from_centre", "bearing_deg": bearing_deg % 360.0, "distance_nm": distance_nm}
