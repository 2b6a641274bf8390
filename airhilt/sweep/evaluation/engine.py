"""An evaluation, from its preset to its tables. The main path begins at `evaluate`."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from airhilt.errors import AirhiltError
from airhilt.host.files import replace_file, sha256
from airhilt.report.evaluation.tables import render
from airhilt.report.figures import Figures
from airhilt.sweep.cases import Case, LoadedScenarios, cases
from airhilt.sweep.engine import SweepObserver, SweepResult, sweep
from airhilt.sweep.estimate import Estimate, Probes, estimate_of
from airhilt.sweep.evaluation.preset import Choice, Preset, Results
from airhilt.sweep.evaluation.tables import Table
from airhilt.sweep.executors import Executors
from airhilt.sweep.specification import Specification
from airhilt.sweep.work import Work, require_scheduler

FORMAT = 1


@dataclass(frozen=True)
class Evaluation:
    """Result of an evaluation.

    Attributes
    ----------
    folder
        Folder with the tables as ``evaluation.json``, ``evaluation.md`` and ``evaluation.html``,
        and a sweep folder for each sweep.
    """

    folder: Path
    preset: str
    choice: Choice
    sweeps: dict[str, SweepResult]
    tables: tuple[Table, ...]

    @property
    def runs(self) -> int:
        """Number of runs of all sweeps."""
        return sum(each.runs for each in self.sweeps.values())

    @property
    def rows(self) -> int:
        """Number of runs that have a row."""
        return sum(each.rows for each in self.sweeps.values())

    @property
    def is_complete(self) -> bool:
        """True if every run finished."""
        return not any(each.failed or each.missing for each in self.sweeps.values())

    def markdown(self) -> str:
        """Return the tables as Markdown."""
        return "\n".join(table.markdown() for table in self.tables)

    def document(self) -> dict[str, Any]:
        """Return ``evaluation.json``."""
        return {
            "format": FORMAT,
            "preset": self.preset,
            "seeds": self.choice.seeds,
            "options": dict(self.choice.options),
            "sweeps": {
                name: {
                    "runs": each.runs,
                    "rows": each.rows,
                    "failed": each.failed,
                    "missing": each.missing,
                    "table_sha256": sha256(each.folder.table_path),
                }
                for name, each in self.sweeps.items()
            },
            "tables": [table.model_dump(mode="json") for table in self.tables],
        }

    def write(self) -> None:
        """Write ``evaluation.json``, ``evaluation.md``, ``evaluation.html`` and its figures.

        Raises
        ------
        AirhiltError
            The disk takes no more.
        """
        document, figures = self.document(), Figures()
        texts = {
            "json": f"{json.dumps(document, indent=2)}\n",
            "md": self.markdown(),
            "html": f"{render(document, figures)}\n",
        }
        figures.write(self.folder / "figures")
        try:
            for ending, text in texts.items():
                replace_file(self.folder / f"evaluation.{ending}", text.encode())
        except OSError as error:
            raise AirhiltError(
                f"{self.folder}: cannot be written: {error.strerror}; the runs are kept"
            ) from None


def evaluate(
    preset: Preset,
    choice: Choice,
    work: Work,
    watched: Callable[[str], AbstractContextManager[SweepObserver]],
) -> Evaluation | None:
    """Run what the sweeps of a preset do not have yet, and make its tables.

    Parameters
    ----------
    work
        How the sweeps are run; its folder is that of the evaluation.
    watched
        Returns who is told how a sweep is doing, by the sweep's name.

    Returns
    -------
    Evaluation or None
        None if an observer stopped it; what was finished is kept.

    Raises
    ------
    AirhiltError
        Something that was given is wrong, or the folder cannot be written.
    """
    found = [ending for ending in ("md", "html") if (work.out / f"evaluation.{ending}").exists()]
    if found and not (work.out / "evaluation.json").exists():
        raise AirhiltError(
            f"{work.out}: holds evaluation.{found[0]} of no evaluation; choose another folder with "
            "--out"
        )
    sweeps: dict[str, SweepResult] = {}
    specifications = preset.specifications(choice)
    with Executors(work) as executors:
        for name, grid in _grids(specifications, work).items():
            with watched(name) as observer:
                own = replace(work, out=work.out / name)
                sweeps[name] = sweep(specifications[name], own, observer, grid, executors)
                if observer.stops:
                    return None
    rows = {
        name: [row for row in each.folder.table().to_pylist() if row["status"] == "finished"]
        for name, each in sweeps.items()
    }
    failed = _absent({name: each.failed for name, each in sweeps.items()}, "failed")
    missing = _absent({name: each.missing for name, each in sweeps.items()}, "did not begin")
    tables = tuple(
        table.model_copy(update={"notes": (*table.notes, *failed, *missing)})
        for table in preset.tables(Results(choice, rows))
    )
    evaluation = Evaluation(work.out, preset.name, choice, sweeps, tables)
    evaluation.write()
    return evaluation


def estimates(preset: Preset, choice: Choice, work: Work) -> dict[str, Estimate]:
    """Return the size of each sweep of a preset by its name; a run of each kind is tried.

    Raises
    ------
    AirhiltError
        A run cannot be as it is asked for, or one that is tried fails.
    """
    require_scheduler(work.scheduler)
    with closing(Probes(work.limits)) as probes:
        return {
            name: estimate_of(grid, replace(work, out=work.out / name), probes)
            for name, grid in _grids(preset.specifications(choice), work).items()
        }


def _grids(specifications: Mapping[str, Specification], work: Work) -> dict[str, list[Case]]:
    """Return the runs of all sweeps by their names, once every one is checked."""
    scenarios = LoadedScenarios(work.allowed)
    return {name: cases(each, scenarios=scenarios) for name, each in specifications.items()}


def _absent(counts: Mapping[str, int], how: str) -> tuple[str, ...]:
    """Return a note on the runs of each sweep that are in no number of the tables, if any."""
    total = sum(counts.values())
    if not total:
        return ()
    where = ", ".join(f"{count} of `{name}`" for name, count in counts.items() if count)
    words = f"1 run {how} and is" if total == 1 else f"{total} runs {how} and are"
    cause = ": the causes are in machine.parquet there" if how == "failed" else ""
    return (f"{words} left out of the tables ({where}){cause}.",)
