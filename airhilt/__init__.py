"""AIRHILT: a reproducible testbed for assistants that warn pilots and controllers.

>>> import airhilt
>>> scenario = airhilt.load("s02a_headon")
>>> result = airhilt.run(scenario, seed=1, latency="fixed", out="runs/headon")  # doctest: +SKIP
>>> result.summary.avoided  # doctest: +SKIP
True
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, overload

from airhilt._version import __version__
from airhilt.errors import AirhiltError

if TYPE_CHECKING:
    from pandas import DataFrame
    from pyarrow import Table

    from airhilt import messages
    from airhilt.cosim.observer import Observer, Snapshot
    from airhilt.metrics.result import Result
    from airhilt.options import Options
    from airhilt.scenario import Scenario
    from airhilt.sim.worker import Input, Output
    from airhilt.workers import Step, Worker

__all__ = [
    "AirhiltError",
    "Input",
    "Observer",
    "Options",
    "Output",
    "Result",
    "Scenario",
    "Snapshot",
    "Step",
    "Worker",
    "__version__",
    "load",
    "messages",
    "open_run",
    "read_sweep",
    "run",
    "run_sweep",
]
_HOMES = {
    "Input": "airhilt.sim.worker",
    "Observer": "airhilt.cosim.observer",
    "Options": "airhilt.options",
    "Output": "airhilt.sim.worker",
    "Result": "airhilt.metrics.result",
    "Scenario": "airhilt.scenario",
    "Snapshot": "airhilt.cosim.observer",
    "Step": "airhilt.workers",
    "Worker": "airhilt.workers",
}
"""Module of each public name; it is imported when it is asked for, so that commands start fast."""

# ONNX Runtime reads it once, when it is loaded; its `disable_telemetry_events` comes too late.
os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")


def __getattr__(name: str) -> Any:
    """Import a public name when it is asked for."""
    if name == "messages":
        return import_module("airhilt.messages")
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def load(name_or_file: str | Path) -> Scenario:
    """Return a scenario that ships with AIRHILT, by name, or one from a file.

    Raises
    ------
    AirhiltError
        There is none of that name, or it is not valid.
    """
    from airhilt.world.loading import load as load_scenario

    return load_scenario(name_or_file)


def open_run(folder: str | Path) -> Result:
    """Open a run folder: its numbers, messages and frames, ``run.json``, and what is damaged.

    Python warns of each file that is not as the run wrote it; the rest can be read.

    Parameters
    ----------
    folder
        Folder of a run that has ended, was killed, or is still going on.

    Raises
    ------
    AirhiltError
        There is no run in it, or its ``run.json`` cannot be read.
    """
    from airhilt.metrics.result import open_result

    return open_result(folder)


@overload
def read_sweep(
    folder: str | Path, *, machine: bool = False, arrow: Literal[False] = False
) -> DataFrame: ...


@overload
def read_sweep(folder: str | Path, *, machine: bool = False, arrow: Literal[True]) -> Table: ...


def read_sweep(
    folder: str | Path, *, machine: bool = False, arrow: bool = False
) -> DataFrame | Table:
    """Return the runs of a sweep as a pandas data frame, a row a run.

    Python warns of a table that is not as the sweep wrote it.

    The columns are those of docs/sweep-columns.md. ``attrs`` of the data frame has their ``units``
    and ``descriptions`` by name.

    Parameters
    ----------
    folder
        The sweep folder.
    machine
        True adds what depends on the machine (time, memory, host, the folder of a run that is
        kept), and with it the runs that a limit ended or that crashed.
    arrow
        True returns a table of Apache Arrow (`pyarrow.Table`) instead; the metadata of its fields
        have ``unit`` and ``description``.

    Raises
    ------
    AirhiltError
        There is no sweep in the folder, or a table is not there or damaged.
    """
    from airhilt.metrics.frames import read_frame, read_table
    from airhilt.record.sweep_folder import SweepFolder

    read = read_table if arrow else read_frame
    return read(SweepFolder.open(Path(folder)), machine)


def run(
    scenario: Scenario | str | Path,
    *,
    out: str | Path | None = None,
    observer: Observer | None = None,
    workers: Sequence[Worker] = (),
    **options: Any,
) -> Result:
    """Run a scenario and leave a run folder.

    Parameters
    ----------
    scenario
        A scenario, or what `load` takes.
    out
        The run folder; None makes a new one under ``runs/``.
    observer
        Is told how the run is doing. None: a notebook shows it below the cell; elsewhere, with
        workers, Python warns of what the user should know, such as the loss of one.
    workers
        Workers of this process. Each takes the place of the reference worker of its modality. One
        that raises an error is lost, and the run goes on without it unless it is ``strict``.
    options
        Fields of `airhilt.Options`: ``seed``, ``assistant``, ``latency``, ``pace`` ...

    Raises
    ------
    AirhiltError
        Something that was given is wrong.
    RunStopped
        The run is ``strict``, and has lost a worker.
    TypeError
        There is no option of that name; the message gives the nearest.
    """
    from airhilt.configuration import read_configuration
    from airhilt.cosim.observer import NotebookProgress, WarningObserver
    from airhilt.cosim.simulation import run as run_scenario
    from airhilt.host.notebook import is_notebook
    from airhilt.options import options_of

    if isinstance(scenario, str | Path):
        scenario = load(scenario)
    if observer is None and is_notebook():
        observer = NotebookProgress(scenario.name)
    if isinstance(options.get("assistant_config"), str | Path):
        options["assistant_config"] = read_configuration(Path(options["assistant_config"]))
    given = options_of({"out": out, **options})
    if observer is None and workers:
        observer = WarningObserver()
    return run_scenario(scenario, given, observer, workers=workers)


def run_sweep(
    scenarios: str | Path | Sequence[str | Path],
    *,
    out: str | Path,
    seeds: int | Sequence[int] = 1,
    axes: Mapping[str, Any] | None = None,
    sample: Mapping[str, Any] | None = None,
    workers: int | None = None,
    scheduler: str = "local",
    keep: str = "none",
    retry: bool = False,
    **options: Any,
) -> DataFrame:
    """Run scenarios over seeds and parameters, and return a pandas data frame, a row a run.

    It is `read_sweep` of ``out``. What that folder has already is not run again. A notebook shows
    below the cell how many runs have ended. A script that calls this needs
    ``if __name__ == "__main__":``, because the workers are other processes.

    Parameters
    ----------
    scenarios
        Names, patterns such as ``s01a_*``, or files.
    out
        The sweep folder.
    seeds
        Number of seeds, from 0 on, or the seeds themselves.
    axes
        Values of each parameter of the grid, by its path: ``{"snr_db": [0, 10]}``, or a range
        ``{"snr_db": {"from": 0, "to": 20, "step": 5}}`` (docs/sweeps.md).
    sample
        Points to draw from intervals, as a sweep file has them: ``{"method": "sobol", "count": 64,
        "intervals": {"snr_db": {"from": 0, "to": 20}}}``.
    workers
        Number of worker processes; None: as many as this machine has cores and memory for.
    scheduler
        ``local``, the address of a Dask scheduler, or its scheduler file (docs/clusters.md).
    keep
        Run folders that stay: ``none``, ``failed``, ``all``, or ``sample:5`` for five of them.
    retry
        True runs again what a limit or a crash has ended.
    options
        Options that all runs have, as `run` takes them.

    Raises
    ------
    AirhiltError
        Something that was given is wrong; nothing was run.
    """
    from airhilt.host.notebook import is_notebook
    from airhilt.sweep.engine import NotebookSweepProgress, SweepObserver
    from airhilt.sweep.engine import sweep as sweep_all
    from airhilt.sweep.specification import first_seeds, specification_of
    from airhilt.sweep.work import Work, keep_of

    names = [scenarios] if isinstance(scenarios, str | Path) else scenarios
    document = {
        "scenarios": [str(name) for name in names],
        "seeds": first_seeds(seeds) if isinstance(seeds, int) else list(seeds),
        "axes": dict(axes or {}),
        "options": options,
        "sample": sample,
    }
    kept, sampled = keep_of(keep)
    work = Work(
        Path(out),
        workers=workers,
        scheduler=scheduler,
        keep=kept,
        sample=sampled,
        retry=retry,
    )
    observer = NotebookSweepProgress() if is_notebook() else SweepObserver()
    sweep_all(specification_of(document, "run_sweep"), work, observer)
    return read_sweep(out)
