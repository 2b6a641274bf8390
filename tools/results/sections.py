"""The sections of the page, each with its runs.

A section is one entry of `SECTIONS` and one text of its name, such as ``paper.md``. A preset of
`airhilt evaluate` is a `PresetSection`.
"""

from __future__ import annotations

import json
import math
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from rich.console import Console
from rich.progress import track

from airhilt.cli.output import tell
from airhilt.cli.sweep_output import sweep_progress
from airhilt.errors import AirhiltError
from airhilt.host.files import make_folder, replace_file
from airhilt.host.machine import available_cores
from airhilt.metrics.estimates import Estimate, share_of
from airhilt.sweep.evaluation.engine import estimates, evaluate
from airhilt.sweep.evaluation.preset import Choice, Preset
from airhilt.sweep.evaluation.presets import FAMILY
from airhilt.sweep.evaluation.tables import NOTHING, Table, share
from airhilt.sweep.work import Work
from judge_encounters import (
    CREWS,
    Counts,
    closed_loop_counts,
    closed_loop_flights,
    closed_loop_rows,
)
from results.record import ROOT, Code, write_document

ASSISTANT = "reference"
"""Assistant in the random encounters."""
ENCOUNTERS_SEED = 0
BENCH_OUT_OF_RANGE = 1
"""Exit status of the benchmark if a number is out of its range."""


@dataclass(frozen=True)
class Wanted:
    """What is to be run.

    Attributes
    ----------
    work
        Folder with a folder for each section.
    seeds
        Number of seeds of each evaluation; None: its own.
    workers
        Number of local workers; None: as many as this machine has cores and memory for.
    """

    work: Path
    code: Code
    seeds: int | None = None
    encounters: int = 1000
    has_cameras: bool = False
    workers: int | None = None


@dataclass(frozen=True)
class Size:
    """Runs of a section, those that are left, and their wall time in s; None: not estimated."""

    runs: int
    left: int
    left_s: float | None


class Section(Protocol):
    """A section of the page."""

    @property
    def name(self) -> str:
        """Name of its text and of its folder."""

    def size(self, wanted: Wanted) -> Size:
        """Return what it takes; one run is tried."""

    def make(self, wanted: Wanted) -> bool | None:
        """Run what is missing, and write ``evaluation.json`` into its folder.

        Returns
        -------
        bool or None
            Whether all runs finished; None if there is nothing to write.

        Raises
        ------
        KeyboardInterrupt
            The user stopped it; what was finished is kept.
        """


@dataclass(frozen=True)
class PresetSection:
    """A preset of `airhilt evaluate`.

    Attributes
    ----------
    seeds
        Number of seeds unless the user gives one; None: the preset's.
    """

    name: str
    seeds: int | None = None

    def size(self, wanted: Wanted) -> Size:
        """Return the sum over the sweeps, by a run of each kind that is tried."""
        found = estimates(*self._work(wanted))
        return Size(
            runs=sum(each.runs for each in found.values()),
            left=sum(each.runs - each.finished for each in found.values()),
            left_s=sum(each.total_s or 0.0 for each in found.values()),
        )

    def make(self, wanted: Wanted) -> bool | None:
        """Run the sweeps, each from where it was stopped."""
        found = evaluate(*self._work(wanted), lambda name: sweep_progress(name, quiet=False))
        if found is None:
            raise KeyboardInterrupt
        return found.is_complete

    def _work(self, wanted: Wanted) -> tuple[Preset, Choice, Work]:
        preset: Preset = FAMILY.load(self.name)
        seeds = wanted.seeds or self.seeds or preset.seeds
        choice = Choice(seeds, {} if wanted.has_cameras else {"cameras": False})
        return preset, choice, Work(wanted.work / self.name, workers=wanted.workers)


@dataclass(frozen=True)
class ClosedLoop:
    """Random encounters in which crews act (`tools/judge_encounters.py`)."""

    name: str = "closed_loop"

    def size(self, wanted: Wanted) -> Size:
        """Return the number of encounters; one is flown."""
        left = max(wanted.encounters - len(self._flown(wanted)), 0)
        begun = time.monotonic()
        if left > 0:
            closed_loop_counts(0, ENCOUNTERS_SEED, ASSISTANT)
        one_s = time.monotonic() - begun
        at_once = wanted.workers or available_cores()
        return Size(wanted.encounters, left, math.ceil(left / at_once) * one_s)

    def make(self, wanted: Wanted) -> bool | None:
        """Fly the encounters that are not flown yet; each is on the disk before the next."""
        flown = self._flown(wanted)
        left = range(len(flown), wanted.encounters)
        path = self._path(wanted)
        make_folder(path.parent)
        kept = "".join(f"{json.dumps(line)}\n" for line in (self._heading(wanted), *flown))
        replace_file(path, kept.encode())
        with path.open("a", encoding="utf-8") as stream:
            made = closed_loop_flights(left, ENCOUNTERS_SEED, ASSISTANT, wanted.workers)
            console = Console(stderr=True)
            for counts in track(made, "encounters", len(left), console=console):
                flown.append(counts)
                stream.write(f"{json.dumps(flown[-1])}\n")
                stream.flush()
        encounters = flown[: wanted.encounters]
        document = {
            "encounters": len(encounters),
            "seed": ENCOUNTERS_SEED,
            "assistant": ASSISTANT,
            "tables": [closed_loop_table(encounters).model_dump(mode="json")],
        }
        write_document(wanted.work / self.name, document)
        return True

    def _path(self, wanted: Wanted) -> Path:
        return wanted.work / self.name / "encounters.jsonl"

    def _heading(self, wanted: Wanted) -> dict[str, Any]:
        code = {"commit": wanted.code.commit, "is_dirty": wanted.code.is_dirty}
        return {**code, "seed": ENCOUNTERS_SEED, "assistant": ASSISTANT}

    def _flown(self, wanted: Wanted) -> list[list[Counts]]:
        """Return what is flown already, of the same code."""
        path = self._path(wanted)
        if wanted.code.is_dirty or not path.exists():
            return []
        heading, *flown = list(_lines(path)) or [None]
        return flown if heading == self._heading(wanted) else []


def _lines(path: Path) -> Iterator[Any]:
    """Yield the documents of a file; the last line may have been cut off."""
    for line in path.read_text(encoding="utf-8").splitlines(keepends=True):
        if line.endswith("\n"):
            yield json.loads(line)


def closed_loop_table(encounters: Sequence[Sequence[Counts]]) -> Table:
    """Return what encounters came to, for each pair of crews."""
    sums = closed_loop_rows(encounters)
    rows = []
    for place, (crews, total) in enumerate(zip(CREWS, sums, strict=True)):
        own = [encounter[place] for encounter in encounters]
        close = [bool(one["unresolved"]) for one in own if one["unassisted"]]
        apart = [bool(one["induced"]) for one in own if not one["unassisted"]]
        rows.append(
            (
                crews.model,
                ", ".join(crews.manners),
                share(_share(close)),
                share(_share(apart)),
                total["alerts"],
                total["reversals"],
            )
        )
    return Table(
        name="closed_loop",
        title="Near mid-air collisions of random encounters",
        columns=("crews", "first and second", "unresolved", "induced", "alerts", "reversals"),
        rows=tuple(rows),
        notes=(
            "Unresolved: of the encounters with a near mid-air collision without the assistant, "
            "those that have one with it too. Induced: of the others, those that have one with it. "
            "In brackets: 95 % interval (Wilson).",
        ),
    )


def _share(flags: Sequence[bool]) -> Estimate:
    return share_of(flags, np.arange(len(flags)))


@dataclass(frozen=True)
class Procedures:
    """Climbs and go-arounds beside what is published (`tools/bench.py procedures`)."""

    name: str = "procedures"

    def size(self, wanted: Wanted) -> Size:  # noqa: ARG002
        """Return one run of the benchmark."""
        return Size(1, 1, None)

    def make(self, wanted: Wanted) -> bool | None:
        """Run the benchmark with one seed: what is published is compared in calm air."""
        command = [sys.executable, "tools/bench.py", "procedures", "--seeds", "1", "--json"]
        done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, check=False, text=True)
        if done.returncode not in (0, BENCH_OUT_OF_RANGE):
            raise AirhiltError(f"{' '.join(command[1:])}: ended with {done.returncode}")
        rows = [row for row in json.loads(done.stdout) if "published" in row]
        if not rows:
            tell(f"{self.name}: left out, no number of the benchmark has a published one beside it")
            return None
        document = {"tables": [published_table(rows).model_dump(mode="json")]}
        write_document(wanted.work / self.name, document)
        return True


def published_table(rows: Sequence[dict[str, Any]]) -> Table:
    """Return what is flown beside what is published."""
    return Table(
        name="published",
        title="Flown, beside what is published",
        columns=("type", "number", "range", "basis", "flown"),
        rows=tuple(
            (row["type"], row["number"], *_range(*row["published"]), f"{row['flown']:.1f}")
            for row in rows
        ),
    )


def _range(at_least: float | None, at_most: float | None, basis: str) -> tuple[str, str]:
    if at_least is None and at_most is None:
        return NOTHING, NOTHING
    ends = f"up to {at_most:.4g}" if at_least is None else f"{at_least:.4g} to {at_most:.4g}"
    return ends, basis


SECTIONS: tuple[Section, ...] = (
    PresetSection("paper"),
    PresetSection("full"),
    PresetSection("roc"),
    PresetSection("recipients", seeds=20),
    ClosedLoop(),
    Procedures(),
)
"""The sections, in the order of the page."""
