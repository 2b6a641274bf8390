"""Comparisons: runs with runs, sweeps with sweeps, assistants of one sweep with each other."""

from __future__ import annotations

from pathlib import Path

from airhilt.errors import AirhiltError
from airhilt.host.library import nearest
from airhilt.metrics.frames import frame_of
from airhilt.record import open_run
from airhilt.record.damage import Notice
from airhilt.record.sweep_folder import SweepFolder, is_sweep
from airhilt.report.comparison.runs import RunComparison, compare_runs
from airhilt.report.comparison.sweeps import Side, SweepComparison, compare_sides
from airhilt.report.sweeps.data import parameters_of


def compare(
    first: Path,
    second: Path | None = None,
    assistants: tuple[str, str] | None = None,
    notice: Notice | None = None,
) -> RunComparison | SweepComparison:
    """Return what differs between two runs, two sweeps, or two assistants of one sweep.

    Without a notice Python warns of what is damaged. It raises `AirhiltError` if there is nothing
    that could be compared; the message says why.
    """
    if second is None:
        if assistants is None:
            raise AirhiltError(
                f"{first}: expected a second folder to compare it with, or two of its assistants: "
                "--assistants NAME,NAME"
            )
        return _of_assistants(first, assistants, notice)
    if assistants is not None:
        raise AirhiltError(
            "--assistants compares two assistants of one sweep; expected one folder with it"
        )
    are_sweeps = [is_sweep(folder) for folder in (first, second)]
    names = _name(first, second), _name(second, first)
    if all(are_sweeps):
        return compare_sides(_side(first, names[0], notice), _side(second, names[1], notice))
    if any(are_sweeps):
        raise AirhiltError(
            f"{first}, {second}: one is a sweep and the other a run; expected two of one kind"
        )
    return compare_runs(open_run(first, notice), open_run(second, notice), names)


def _of_assistants(folder: Path, names: tuple[str, str], notice: Notice | None) -> SweepComparison:
    whole = _side(folder, str(folder), notice)
    known = sorted(whole.runs["assistant"].dropna().unique())
    for name in names:
        if name not in known:
            raise AirhiltError(f"{folder}: no runs of assistant {name!r}{nearest(name, known)}")
    if names[0] == names[1]:
        raise AirhiltError(f"--assistants {names[0]},{names[1]}: expected two different ones")
    one, other = (
        Side(name, whole.runs[whole.runs["assistant"] == name], whole.parameters) for name in names
    )
    return compare_sides(one, other)


def _side(folder: Path, name: str, notice: Notice | None) -> Side:
    sweep = SweepFolder.open(folder, notice)
    table = sweep.table()
    parameters = parameters_of(table, str(sweep.table_path))
    runs = frame_of(table)
    return Side(name, runs[runs["status"] == "finished"], parameters)


def _name(folder: Path, other: Path) -> str:
    name = folder.absolute().name
    return str(folder) if name == other.absolute().name else name
