"""Fixtures for all tests."""

from __future__ import annotations

import gc
import io
import json
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Generator, Iterator
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest
from hypothesis import settings

from airhilt import load, run
from airhilt.cli import main
from airhilt.host.machine import available_cores
from airhilt.scenario import Scenario
from airhilt.world.loading import load_text
from devtools import BROWSERS, Page, browser_page

# Without deadlines: a busy machine says nothing of the code.
settings.register_profile("long", max_examples=20_000, deadline=None)
settings.register_profile("new", deadline=None)
settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")
WHOLE_RUNS = ("station", "bus", "cli", "cosim", "docs", "sweep")
"""Folders of tests that take long each."""
CORE = (
    "audio", "bus", "cosim", "geodesy", "host", "metrics", "phraseology", "record", "scenario",
    "seats", "shapes", "sim", "surveillance", "workers", "world",
)  # fmt: skip
"""Folders of tests of a run and of what it is made of: no models, pictures, sweeps and pages."""
DRAWN = [
    {
        "path": "actors/AAL123/initial/position/distance_nm",
        "distribution": {"type": "normal", "sigma": 1.0, "limit": 2.0},
    },
    {
        "path": "actors/DAL456/initial/cas_kt",
        "distribution": {"type": "uniform", "limit": 8.0},
    },
]
"""Perturbations of the encounter: the two stay on one line and level."""
Cli = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def encounter() -> Scenario:
    """Half a minute of a head-on encounter, without cameras, and with a warning after 2 s."""
    document = load("s02a_headon").model_dump(mode="json")
    for actor in document["actors"]:
        actor["initial"]["position"]["distance_nm"] = 13.0
    document |= {"name": "encounter", "duration_s": 30.0, "cameras": [], "perturbations": DRAWN}
    return load_text(json.dumps(document), "encounter")


@pytest.fixture
def encounter_file(encounter: Scenario, tmp_path: Path) -> Path:
    """The encounter as a file."""
    path = tmp_path / "encounter.json"
    path.write_text(encounter.model_dump_json())
    return path


@pytest.fixture(scope="session")
def recorded_run(encounter: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run of 8 s; nobody changes it."""
    short = encounter.model_copy(update={"duration_s": 8.0})
    out = tmp_path_factory.mktemp("recorded") / "run"
    return run(
        short, out=out, latency="fixed", assistant="adsb_only", speech=False, report=False
    ).folder


@pytest.fixture
def run_copy(recorded_run: Path, tmp_path: Path) -> Path:
    """A copy of that run, to be damaged."""
    return Path(shutil.copytree(recorded_run, tmp_path / "run"))


@pytest.fixture(scope="session")
def browser() -> Iterator[Page]:
    """A browser; where there is none, its tests are skipped."""
    executable = next((found for name in BROWSERS if (found := shutil.which(name))), None)
    if executable is None:
        pytest.skip("no Chromium on PATH: apt-get install chromium")
    with browser_page(executable) as page:
        yield page


@pytest.fixture
def page(browser: Page) -> Iterator[Page]:
    """A page that must have nothing to complain of but a server that the test has ended."""
    browser.open("about:blank")
    browser.complaints.clear()
    yield browser
    assert [each for each in browser.complaints if "ERR_CONNECTION_REFUSED" not in each] == []


@pytest.fixture
def airhilt_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Cli]:
    """Runs the command line in an empty folder, in the process of the tests."""
    monkeypatch.chdir(tmp_path)
    numbers = (signal.SIGINT, signal.SIGTERM)
    handlers = [signal.getsignal(number) for number in numbers]

    def call(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
        given = [str(argument) for argument in arguments]
        monkeypatch.setattr(sys, "argv", ["airhilt", *given])
        out, err = io.StringIO(), io.StringIO()
        with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as ended:
            main()
        assert isinstance(ended.value.code, int)
        return subprocess.CompletedProcess(given, ended.value.code, out.getvalue(), err.getvalue())

    yield call
    for number, handler in zip(numbers, handlers, strict=True):
        signal.signal(number, handler)


def pytest_xdist_auto_num_workers() -> int:
    """One more than there are processors: many tests wait for processes of their own."""
    return available_cores() + 1


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Leave the tests that are collected to no garbage collection: to look at them takes long."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.enable()
        gc.freeze()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the core, and begin with whole runs: no process is left alone with them at the end."""
    for item in items:
        folder = item.path.relative_to(item.config.rootpath / "tests").parts[0]
        if folder in CORE and not {"slow", "browser"} & {mark.name for mark in item.iter_markers()}:
            item.add_marker("core")
    items.sort(key=lambda item: item.path.parent.name not in WHOLE_RUNS)
