"""The process that runs cases, one after the other.

It tells its `Environment` first, and then for each `Request` one `Outcome`: lines of JSON on two
pipes. It is a process of its own so that a run that hangs, eats memory or crashes can be ended
without the worker that asked for it. `airhilt.sweep.runner_process` starts it, and it ends when
there are no more questions.
"""

from __future__ import annotations

import os
import queue
import socket
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from shutil import rmtree

from airhilt.cosim.observer import Observer
from airhilt.cosim.simulation import run
from airhilt.errors import AirhiltError, failure_in, is_of_machine
from airhilt.host.child_process import cpu_s
from airhilt.metrics.columns import metrics_of
from airhilt.metrics.summary import Summary
from airhilt.options import Options
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.renderer_link import RendererKeeper
from airhilt.sweep.environment import environment
from airhilt.sweep.files import require_planned
from airhilt.sweep.outcome import Machine, Outcome, Request, Status


def main(arguments: Sequence[str]) -> None:
    """Tell the environment, and run what is asked for until the questions end.

    Parameters
    ----------
    arguments
        Descriptors of questions and answers, the renderer that the runs ask for (empty without
        cameras), and a folder for what is not kept of them.
    """
    questions, answers = (int(number) for number in arguments[:2])
    renderer, scratch = arguments[2], Path(arguments[3])
    with os.fdopen(answers, "w", encoding="utf-8") as told:
        try:
            text = environment(renderer).model_dump_json()
        except AirhiltError as error:
            sys.exit(str(error))
        told.write(text + "\n")
        told.flush()
        requests: queue.SimpleQueue[str] = queue.SimpleQueue()
        reading = threading.Thread(target=_read, args=(questions, requests, scratch), daemon=True)
        reading.start()
        keeper = RendererKeeper()
        while True:
            request = Request.model_validate_json(requests.get())
            outcome = run_request(request, keeper, scratch)
            told.write(outcome.model_dump_json() + "\n")
            told.flush()


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


def _read(questions: int, requests: queue.SimpleQueue[str], scratch: Path) -> None:
    """Pass on the lines of questions; end the process when they do, whatever it is doing."""
    with os.fdopen(questions, encoding="utf-8") as lines:
        for line in lines:
            requests.put(line)
    rmtree(scratch, ignore_errors=True)  # The worker may have been killed, and leave it to nobody.
    os._exit(0)


if __name__ == "__main__":
    main(sys.argv[1:])
