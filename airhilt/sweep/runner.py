"""The process that runs cases, one after the other.

It tells its `Environment` when it is asked first, and then for each `Request` one `Outcome`. It is
a process of its own so that a run that hangs, eats memory or crashes can be ended without the
worker that asked for it. `airhilt.sweep.runner_process` starts it.
"""

from __future__ import annotations

import os
import socket
import sys
import tempfile
import time
from contextlib import suppress
from functools import partial
from pathlib import Path
from shutil import rmtree
from typing import Any

from airhilt.cosim.observer import Observer
from airhilt.cosim.simulation import run
from airhilt.errors import AirhiltError, failure_in, is_of_machine
from airhilt.host.child_process import cpu_s, serve
from airhilt.metrics.columns import metrics_of
from airhilt.metrics.summary import Summary
from airhilt.options import Options
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.renderer_link import RendererKeeper
from airhilt.sweep.environment import environment
from airhilt.sweep.files import require_planned
from airhilt.sweep.outcome import Machine, Outcome, Request, Status


def answer(question: Any, keeper: RendererKeeper, scratch: Path) -> str:
    """Run what is asked for, or tell the environment, as JSON.

    Parameters
    ----------
    question
        A `Request`; first the renderer that the runs ask for, empty without cameras.
    scratch
        Folder for what is not kept of the runs.
    """
    if "renderer" in question:
        try:
            return environment(question["renderer"]).model_dump_json()
        except AirhiltError as error:
            sys.exit(str(error))
    request = Request.model_validate(question)
    return run_request(request, keeper, scratch).model_dump_json()


def run_request(
    request: Request, keeper: RendererKeeper | None = None, scratch: Path | None = None
) -> Outcome:
    """Run one case and return its outcome, even after an error; its folder stays if asked for.

    Parameters
    ----------
    keeper
        Keeps the process that draws from one run to the next; None: each run has one of its own.
    scratch
        Folder for a run folder that cannot stay; None: that of the system for temporary files.
    """
    status: Status = "finished"
    cause, metrics = "", {}
    begun_wall, begun_cpu = time.perf_counter(), cpu_s()
    with tempfile.TemporaryDirectory(prefix="airhilt-run-", dir=scratch) as temporary:
        folder = Path(temporary) / "run"
        losses = _Losses()
        try:
            if request.keep != "none":
                folder = _emptied(request.partial_folder)
            metrics = metrics_of(_summary(request, folder, keeper, losses))
        except Exception as error:  # A mistake in any part of a run is a row, not the sweep's end.
            status = "crashed" if is_of_machine(error) else "failed"
            cause = " ".join(_told(error).split()).replace(f"{folder}/", "")
        if losses.causes and status != "crashed":  # A result that another machine would not have.
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


def _told(error: Exception) -> str:
    return str(error) if isinstance(error, AirhiltError) else failure_in(error)


def _summary(
    request: Request, folder: Path, keeper: RendererKeeper | None, observer: Observer
) -> Summary:
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


def main(questions: int, answers: int, scratch: Path) -> None:
    """Answer on the pipes of these descriptors."""
    keeper = RendererKeeper()
    # The worker may have been killed, and leave the folder to nobody.
    remove = partial(rmtree, scratch, ignore_errors=True)
    serve(questions, answers, lambda question: answer(question, keeper, scratch), remove)


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]))
