"""AIRHILT: a reproducible testbed for assistants that warn pilots and controllers.

>>> import airhilt
>>> scenario = airhilt.load("s02a_headon")
>>> result = airhilt.run(scenario, seed=1, latency="fixed", out="runs/headon")  # doctest: +SKIP
>>> result.summary.avoided  # doctest: +SKIP
True
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from airhilt._version import __version__
from airhilt.errors import AirhiltError

if TYPE_CHECKING:
    from airhilt.cosim.simulation import Observer, Result
    from airhilt.scenario import Scenario

__all__ = ["AirhiltError", "__version__", "load", "run"]


def load(name_or_file: str | Path) -> Scenario:
    """Return a scenario that ships with AIRHILT, by name, or one from a file.

    Raises
    ------
    AirhiltError
        There is none of that name, or it is not valid.
    """
    from airhilt.world.loading import load as load_scenario

    return load_scenario(name_or_file)


def run(
    scenario: Scenario | str | Path,
    *,
    out: str | Path | None = None,
    observer: Observer | None = None,
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
        Is told how the run is doing.
    options
        Fields of `airhilt.options.Options`: ``seed``, ``assistant``, ``latency``, ``pace`` ...

    Raises
    ------
    AirhiltError
        Something that was given is wrong.
    TypeError
        There is no such option.
    """
    from airhilt.cosim.simulation import run as run_scenario
    from airhilt.options import Options

    if isinstance(scenario, str | Path):
        scenario = load(scenario)
    folder = None if out is None else Path(out)
    return run_scenario(scenario, Options(out=folder, **options), observer)
