"""Checks that each scenario comes to what it declares if nobody is warned, in every seed.

    python tools/check_unassisted.py
    python tools/check_unassisted.py s01a_tight_timing s01a_intersecting --seeds 20
    python tools/check_unassisted.py --json

Runs each scenario with a conflict with ``--assistant none``, without cameras and speech, and prints
for each seed the outcome. The exit code is 1 if the conflict window of a run did not open, or the
outcome was milder than the `unassisted` that its scenario declares.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import airhilt
import standard_output
from airhilt.host import library
from airhilt.metrics.summary import Summary

HEAD = f"{'scenario':28}{'seed':>5}  {'declared':20}{'outcome':20}{'incursion':11}{'closest':>9}"


class Row(NamedTuple):
    """The outcome of one run."""

    scenario: str
    seed: int
    declared: str
    as_declared: bool
    outcome: str
    incursion: str | None
    closest_m: float | None


def main() -> None:
    """Run the scenarios and print what they came to."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scenarios", nargs="*", help="names; without one, all with a conflict")
    parser.add_argument("--seeds", type=int, default=10, help="seeds 0 to this one less one")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    given = parser.parse_args()
    rows = []
    if not given.json:
        print(HEAD)
    for row in checked(given.scenarios or with_conflict(), range(given.seeds)):
        rows.append(row)
        if not given.json:
            _print(row)
    failed = sum(not row.as_declared for row in rows)
    print(
        json.dumps([row._asdict() for row in rows], indent=2)
        if given.json
        else f"{len(rows)} runs, {failed} not as declared"
    )
    sys.exit(0 if all(row.as_declared for row in rows) else 1)


def with_conflict() -> list[str]:
    """Return the names of the shipped scenarios that declare a conflict."""
    return [name for name in library.names("scenarios") if airhilt.load(name).conflict is not None]


def checked(scenarios: Sequence[str], seeds: Sequence[int]) -> Iterator[Row]:
    """Yield the outcome of each scenario with each seed."""
    for scenario in scenarios:
        for seed in seeds:
            yield _row(scenario, seed)


def _row(name: str, seed: int) -> Row:
    scenario = airhilt.load(name)
    with tempfile.TemporaryDirectory(prefix="airhilt-") as scratch:
        summary = airhilt.run(
            scenario,
            seed=seed,
            assistant="none",
            latency="fixed",
            cameras=False,
            speech=False,
            out=Path(scratch) / "run",
        ).summary
    closest = summary.closest_approach
    return Row(
        scenario=name,
        seed=seed,
        declared=scenario.conflict.unassisted if scenario.conflict else "-",
        as_declared=bool(summary.unassisted_as_declared),
        outcome=_worst(summary),
        incursion=summary.runway_incursion_category,
        closest_m=(closest.horizontal_m**2 + closest.vertical_m**2) ** 0.5 if closest else None,
    )


def _worst(summary: Summary) -> str:
    """Return the most severe outcome of a run."""
    for name in ("collision", "nmac", "loss_of_separation"):
        if getattr(summary, name):
            return name
    return "no conflict" if summary.t_window_s is None else "none of these"


def _print(row: Row) -> None:
    closest = "-" if row.closest_m is None else f"{row.closest_m:.0f} m"
    mark = "" if row.as_declared else "  NOT AS DECLARED"
    print(
        f"{row.scenario:28}{row.seed:>5}  {row.declared:20}{row.outcome:20}"
        f"{row.incursion or '-':11}{closest:>9}{mark}",
        flush=True,
    )


if __name__ == "__main__":
    standard_output.run(main)
