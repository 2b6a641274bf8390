"""The runner tells what is the run's own fault from what is the machine's."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from airhilt import load
from airhilt.errors import RendererLost, RunFolderError, ScenarioError
from airhilt.sensors.cameras.renderer_process import RendererProcess
from airhilt.sweep import runner
from airhilt.sweep.files import NamedFiles, require_planned
from airhilt.sweep.outcome import Outcome, Request
from breadth import mostly_slow

FULL = OSError(28, "No space left on device")


def run_request(request: Request) -> Outcome:
    """Return the outcome of a run that is done in this process."""
    opened = runner.Runner()
    with closing(opened.keeper):
        return opened.run(request)


@pytest.mark.parametrize(
    ("error", "status"),
    [
        (RunFolderError("log.mcap: cannot be written any more"), "crashed"),
        (MemoryError(), "crashed"),
        (RendererLost("the process that draws has ended"), "crashed"),
        (ScenarioError("a speed that nothing flies"), "failed"),
        (ZeroDivisionError(), "failed"),
    ],
)
def test_a_disk_or_memory_that_is_full_is_no_result_of_the_run(
    error: Exception, status: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(runner, "_summary", fail)
    request = Request(key="k", scenario={}, options={}, keep="none", folder=str(tmp_path / "run"))
    outcome = run_request(request)
    assert outcome.status == status
    assert outcome.cause
    assert outcome.metrics == {}


@pytest.mark.parametrize("strict", mostly_slow([False, True], False))
def test_a_run_whose_renderer_was_killed_is_no_result_of_it(
    strict: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The run itself goes on without pictures, and would finish on any machine with them."""
    take = RendererProcess.take

    def killed(renderer: RendererProcess, *asked: Any) -> Any:
        renderer.processes[0].kill()
        return take(renderer, *asked)

    monkeypatch.setattr(RendererProcess, "take", killed)
    scenario = load("s02a_headon").model_dump(mode="json") | {"duration_s": 0.5}
    options = {"speech": False, "latency": "fixed", "renderer": "embree", "strict": strict}
    folder = str(tmp_path / "run")
    request = Request(key="k", scenario=scenario, options=options, keep="failed", folder=folder)
    outcome = run_request(request)
    assert (outcome.status, outcome.metrics) == ("crashed", {})
    assert "the process of renderer embree has ended (signal 9)" in outcome.cause
    assert outcome.is_kept


def test_a_run_whose_file_is_not_that_of_its_key_is_not_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A worker in another folder, or a file that has changed, would give a row of another run."""
    scenario = load("s02a_headon").model_dump(mode="json")
    options = {"cameras": False, "radio_profile": "noise.onnx"}
    here, elsewhere = tmp_path / "here", tmp_path / "elsewhere"
    for folder in (here, elsewhere):
        folder.mkdir()
    (here / "noise.onnx").write_bytes(b"planned")
    monkeypatch.chdir(here)
    planned = NamedFiles().of(scenario, options)
    request = Request(
        key="k", scenario=scenario, options=options, keep="none", folder="", files=planned
    )
    require_planned(planned, scenario, options)
    (here / "noise.onnx").write_bytes(b"changed")
    for folder, problem in ((here, "another file than"), (elsewhere, "not the file that was")):
        monkeypatch.chdir(folder)
        found = run_request(request)
        assert found.status == "crashed"
        assert f"noise.onnx: {problem}" in found.cause
