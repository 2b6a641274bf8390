"""The page of a run that goes on, in a headless Chromium beside the run: frames and late frames."""

from __future__ import annotations

import itertools
import json
import shutil
import sys
import tempfile
from pathlib import Path

import psutil

from airhilt.scenario import Scenario
from benchmarks.traffic import airport_scenario

sys.path.append(str(Path(__file__).parents[2] / "tests" / "support"))

from devtools import BROWSERS, Page, browser_page
from stations import running

SETTLING_S = 10
MEASURED_S = 30
COUNTED = """
    const pen = CanvasRenderingContext2D.prototype;
    let isDrawn = false;
    const noted = (inner) => function (...given) {
        if (this.canvas.id === "plan") isDrawn = true;
        return inner.apply(this, given);
    };
    for (const name of ["fillRect", "drawImage"]) pen[name] = noted(pen[name]);
    window.counted = { frames: 0, plans: [] };
    const look = (now) => {
        window.counted.frames += 1;
        if (isDrawn) window.counted.plans.push(now);
        isDrawn = false;
        requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
"""
"""Script that counts the frames of a page, and notes those in which the plan was drawn, in ms."""


def page() -> dict[str, float]:
    """Follow a run of 20 aircraft; return frames a second, and how long the plan stood still."""
    executable = next((found for name in BROWSERS if (found := shutil.which(name))), None)
    if executable is None:
        sys.exit("no Chromium on PATH: apt-get install chromium")
    with tempfile.TemporaryDirectory() as scratch:
        file = Path(scratch) / "airport.json"
        file.write_text(twenty_aircraft().model_dump_json())
        with (
            running(file, Path(scratch) / "run") as (process, url),
            browser_page(executable) as browser,
        ):
            browser.call("Page.addScriptToEvaluateOnNewDocument", source=COUNTED)
            browser.open(url, width=1280, height=720)
            browser.wait_for("document.querySelectorAll('#traffic tbody tr').length >= 20")
            pause(browser, SETTLING_S)
            run, chromium = psutil.Process(process.pid), chromium_process()
            before_s, browser_before_s = cpu_s(run), cpu_s(chromium)
            browser.evaluate("counted.frames = 0, counted.plans = []")
            pause(browser, MEASURED_S)
            counted = json.loads(browser.evaluate("JSON.stringify(counted)"))
            used_s, browser_s = cpu_s(run) - before_s, cpu_s(chromium) - browser_before_s
            browser.open("about:blank")
    plans = counted["plans"]
    stood_ms = sorted(b - a for a, b in itertools.pairwise(plans))
    return {
        "frames_per_s": counted["frames"] / MEASURED_S,
        "plans_per_s": len(plans) / MEASURED_S,
        "plan_stood_ms_p95": stood_ms[int(0.95 * len(stood_ms))],
        "plan_stood_ms_most": stood_ms[-1],
        "run_and_server_cores": used_s / MEASURED_S,
        "browser_cores": browser_s / MEASURED_S,
    }


def twenty_aircraft() -> Scenario:
    """Return five arrivals, five departures and ten taxiing aircraft."""
    busy = airport_scenario()
    aircraft = tuple(actor for actor in busy.actors if actor.type == "aircraft")
    return busy.model_copy(update={"actors": aircraft})


def chromium_process() -> psutil.Process:
    """Return the browser that this process has started."""
    children = psutil.Process().children()
    return next(child for child in children if "chrom" in child.name())


def cpu_s(process: psutil.Process) -> float:
    """Return the CPU time of a process and its children, in s."""
    processes = [process, *process.children(recursive=True)]
    return sum(sum(one.cpu_times()[:2]) for one in processes)


def pause(browser: Page, seconds: int) -> None:
    """Let the page go on for some seconds."""
    browser.evaluate(f"new Promise((done) => setTimeout(done, {1000 * seconds}))")
