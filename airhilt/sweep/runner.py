"""The process that runs cases, one after the other.

It is a process of its own so that a run that hangs, eats memory or crashes can be ended without the
worker that asked for it. `airhilt.sweep.runner_process` starts it.
"""

from __future__ import annotations

import os
import socket
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from shutil import rmtree

from airhilt.cosim.observer import Observer
from airhilt.cosim.simulation import run
from airhilt.errors import AirhiltError, failure_in, is_of_machine
from airhilt.host.child_process import serve
from airhilt.host.machine import cpu_s
from airhilt.metrics.columns import metrics_of
from airhilt.metrics.summary import Summary
from airhilt.options import Options
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.renderer_process import RendererKeeper
from airhilt.sweep.environment import Environment, environment
from airhilt.sweep.files import require_planned
from airhilt.sweep.outcome import Machine, Outcome, Request, Status


class Runner:
    """Runs cases; the process that draws stays from one run to the next."""

    def __init__(self) -> None:
        self.keeper = RendererKeeper()

    def environment(self, renderer: str) -> Environment:
        """Return the environment of this process; see `airhilt.sweep.environment.environment`."""
        return environment(renderer)

    def run(self, request: Request) -> Outcome:
        """Run one case and return its outcome, even after an error; its folder stays if asked for.

        A run folder that cannot stay is in the system's folder for temporary files.
        """
        status: Status = "finished"
        cause, metrics = "", {}
        begun_wall, begun_cpu = time.perf_counter(), cpu_s()
        with tempfile.TemporaryDirectory(prefix="airhilt-run-") as temporary:
            folder = Path(temporary) / "run"
            losses = _Losses()
            try:
                if request.keep != "none":
                    folder = _emptied(request.partial_folder)
                metrics = metrics_of(_summary(request, folder, self.keeper, losses))
            except Exception as error:  # A mistake in any part of a run is a row.
                status = "crashed" if is_of_machine(error) else "failed"
                told = str(error) if isinstance(error, AirhiltError) else failure_in(error)
                cause = " ".join(told.split()).replace(f"{folder}/", "")
            if losses.causes and status != "crashed":  # Another machine would not have this result.
                status, cause, metrics = "crashed", losses.causes[0], {}
            is_kept = request.settle(folder, status)
        machine = Machine(
            wall_s=time.perf_counter() - begun_wall,
            cpu_s=cpu_s() - begun_cpu,
            peak_memory_mb=0.0,
            host=socket.gethostname(),
            process=os.getpid(),
        )
        return Outcome(
            key=request.key,
            status=status,
            cause=cause,
            is_kept=is_kept,
            metrics=metrics,
            machine=machine,
        )


class _Losses(Observer):
    """Keeps the causes of what a run lost through its machine."""

    def __init__(self) -> None:
        self.causes: list[str] = []

    def machine_failed(self, cause: str) -> None:
        """Keep a cause."""
        self.causes.append(" ".join(cause.split()))


def _summary(request: Request, folder: Path, keeper: RendererKeeper, observer: Observer) -> Summary:
    require_planned(request.files, request.scenario, request.options)
    scenario = Scenario.model_validate(request.scenario)
    options = Options.model_validate(
        request.options | {"out": folder, "report": request.keep == "all"}
    )
    return run(scenario, options, observer, keeper=keeper).summary


def _emptied(folder: Path) -> Path:
    """Delete what an earlier attempt at this run left, and return its folder."""
    with suppress(FileNotFoundError):
        rmtree(folder)
    folder.parent.mkdir(parents=True, exist_ok=True)
    return folder


if __name__ == "__main__":
    serve(Runner())
