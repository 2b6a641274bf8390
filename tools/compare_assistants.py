"""Runs scenarios with several assistants, and compares what became of them.

    python tools/compare_assistants.py --assistants reference,adsb_only --seeds 3 --out runs/rows
    python tools/compare_assistants.py --scenarios "s01a_*" --assistants paper --out runs/rows

Each scenario is run with `none` first: only runs that end badly without an assistant can be
avoided. Latencies are fixed, so a run gives the same row again. Rows that the folder has already
are not run again.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
from collections.abc import Iterator, Sequence
from fnmatch import fnmatch
from functools import partial
from pathlib import Path

from rich.console import Console
from rich.progress import track

import standard_output
from airhilt.assistant.reference import NO_ASSISTANT
from airhilt.library import names
from comparison.rows import Case, Row, run_case
from comparison.tables import by_family, not_avoided, nuisances


def main() -> None:
    """Run what is missing, and print the tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenarios", default="*", help="patterns, separated by commas")
    parser.add_argument("--assistants", default="reference", help="names, separated by commas")
    parser.add_argument("--seeds", type=int, default=3, help="number of seeds, from 0 on")
    parser.add_argument("--cameras", action="store_true", help="draw and look at pictures")
    parser.add_argument("--speech", action="store_true", help="radio calls as sound")
    parser.add_argument("--latency", default="fixed", help="latency source of all runs")
    parser.add_argument("--out", type=Path, required=True, help="folder for the rows")
    parser.add_argument("--workers", type=int, default=2, help="runs at the same time")
    parser.add_argument("--json", action="store_true", help="print the rows as JSON")
    given = parser.parse_args()
    cases = list(_cases(given))
    rows = _run(cases, given.out, given.workers)
    if given.json:
        print(json.dumps([row.model_dump() for row in rows], indent=2))
        return
    console = Console()
    for table in (by_family(rows), nuisances(rows), not_avoided(rows)):
        console.print(table)


def _cases(given: argparse.Namespace) -> Iterator[Case]:
    patterns = given.scenarios.split(",")
    assistants = [NO_ASSISTANT, *given.assistants.split(",")]
    for scenario in names("scenarios"):
        if not any(fnmatch(scenario, pattern) for pattern in patterns):
            continue
        for seed in range(given.seeds):
            for assistant in dict.fromkeys(assistants):
                yield Case(
                    scenario=scenario,
                    seed=seed,
                    assistant=assistant,
                    cameras=given.cameras and assistant != NO_ASSISTANT,
                    speech=given.speech,
                    latency=given.latency,
                )


def _run(cases: Sequence[Case], folder: Path, workers: int) -> list[Row]:
    """Return the row of each case; those that the folder lacks are run and written to it."""
    folder.mkdir(parents=True, exist_ok=True)
    missing = [case for case in cases if not (folder / case.file_name).exists()]
    context = multiprocessing.get_context("spawn")
    # Not concurrent.futures: in Python 3.11 it stops for ever when it replaces a worker (115634).
    with context.Pool(workers, maxtasksperchild=20) as pool:
        done = pool.imap_unordered(partial(run_case, folder=folder), missing)
        for _ in track(done, "running", total=len(missing), console=Console(stderr=True)):
            pass
    return [Row.model_validate_json((folder / case.file_name).read_text()) for case in cases]


if __name__ == "__main__":
    standard_output.run(main)
