"""Compares the time to first warning over the scenarios of S01A with that of the AIRHILT paper.

    python tools/validate_paper.py --out runs/validation
    python tools/validate_paper.py --out runs/validation --seeds 10 --assistant paper --json

The paper reports 7.66 s over its variants of runway overlap (arXiv 2511.18718). Each variant is run
with ``--latency paper`` and with sound, by default without cameras. Summaries that the folder has
already are not made again. docs/metrics.md says what is counted.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from rich.console import Console
from rich.progress import track
from rich.table import Table

import airhilt
import standard_output
from airhilt import library
from airhilt.files import replace_file
from airhilt.metrics.summary import Summary, WarningParts
from airhilt.metrics.warning_parts import WarningStatistics

FAMILY = "S01A"
PAPER_S = 7.66
"""Mean time to first warning of the paper, in s."""
LEAST_WIDTH = 140
"""Least width of the tables, in characters."""
OVERALL = "all"
"""Name of the row over all variants."""


def main() -> None:
    """Run what is missing, and print the tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", type=int, default=10, help="number of seeds, from 0 on")
    parser.add_argument("--assistant", default="paper", help="decision engine")
    parser.add_argument("--latency", default="paper", help="latency source")
    parser.add_argument("--cameras", action="store_true", help="draw and look at pictures")
    parser.add_argument("--scenario", action="append", help="only this one; may be given again")
    parser.add_argument("--out", type=Path, required=True, help="folder for the summaries")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    given = parser.parse_args()
    found = _summaries(given, given.scenario or variants())
    statistics = statistics_of(found)
    if given.json:
        print(json.dumps({name: own.model_dump() for name, own in statistics.items()}, indent=2))
        return
    console = Console()
    console.width = max(console.width, LEAST_WIDTH)
    console.print(times(statistics))
    console.print(parts(statistics))
    console.print(events(found))


def variants() -> list[str]:
    """Return the names of the scenarios of the family that have a conflict."""
    loaded = {name: airhilt.load(name) for name in library.names("scenarios")}
    return [name for name, one in loaded.items() if one.family == FAMILY and one.conflict]


def statistics_of(found: Mapping[str, Sequence[Summary]]) -> dict[str, WarningStatistics]:
    """Return the statistics of each variant, and of all runs together."""
    every = [summary for own in found.values() for summary in own]
    return {name: WarningStatistics.of(own) for name, own in {**found, OVERALL: every}.items()}


def times(statistics: Mapping[str, WarningStatistics]) -> Table:
    """Return the table of the times to first warning."""
    table = Table(title=f"time to first warning, in s; the paper: {PAPER_S}")
    for name in ("variant", "runs", "warned", "mean", "median", "before", "after the call"):
        table.add_column(name, justify="left" if name == "variant" else "right")
    for name, own in statistics.items():
        share = "-" if own.share_before is None else f"{own.share_before:.0%}"
        numbers = (_text(own.mean_s), _text(own.median_s), share, _text(own.mean_after_call_s))
        table.add_row(name, str(own.runs), str(own.warned), *numbers)
    return table


def parts(statistics: Mapping[str, WarningStatistics]) -> Table:
    """Return the table of what the times consist of."""
    table = Table(title="mean of each part, in s")
    table.add_column("variant")
    for name in WarningParts.model_fields:
        table.add_column(name.removesuffix("_s"), justify="right")
    for name, own in statistics.items():
        if own.parts is not None:
            table.add_row(name, *(_text(value) for value in own.parts.model_dump().values()))
    return table


def events(found: Mapping[str, Sequence[Summary]]) -> Table:
    """Return the table of the first warning of each run."""
    table = Table(title="each run")
    columns = ("variant", "seed", "begins", "warned", "time", "kind", "avoided")
    for name in (*columns, *(part.removesuffix("_s") for part in WarningParts.model_fields)):
        table.add_column(name, justify="left" if name in ("variant", "kind") else "right")
    for own in found.values():
        for one in own:
            spans = one.first_warning_parts.model_dump().values() if one.first_warning_parts else ()
            table.add_row(
                one.scenario,
                str(one.seed),
                _text(one.t_conflict_s),
                _text(one.t_first_warning_s),
                _text(one.time_to_first_warning_s),
                _kind(one),
                {True: "yes", False: "no", None: "-"}[one.avoided],
                *(_text(span) for span in spans),
            )
    return table


def _kind(summary: Summary) -> str:
    """Return kind and severity of the advisory that was heard first."""
    if summary.t_first_warning_s is None:
        return "-"
    told = [one for one in summary.advisories if one.t_spoken_s == summary.t_first_warning_s]
    return f"{told[0].kind} {told[0].severity}" if told else "-"


def _text(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f}"


def _summaries(given: argparse.Namespace, names: Sequence[str]) -> dict[str, list[Summary]]:
    """Return the summaries of all runs by scenario; those that are missing are made."""
    given.out.mkdir(parents=True, exist_ok=True)
    cases = [(name, seed) for name in names for seed in range(given.seeds)]
    found: dict[str, list[Summary]] = {name: [] for name in names}
    console = Console(stderr=True)
    for name, seed in track(cases, "running", console=console):
        found[name].append(_summary(given, name, seed))
    return found


def _summary(given: argparse.Namespace, name: str, seed: int) -> Summary:
    """Return the summary of one run: that of the folder, or else a new one."""
    sight = "cameras" if given.cameras else "no-cameras"
    latency = given.latency.translate(str.maketrans("", "", ":,="))
    path = given.out / f"{name}-{seed}-{given.assistant}-{sight}-{latency}.json"
    if not path.exists():
        with tempfile.TemporaryDirectory() as scratch:
            result = airhilt.run(
                name,
                seed=seed,
                assistant=given.assistant,
                latency=given.latency,
                cameras=given.cameras,
                out=Path(scratch) / "run",
            )
        replace_file(path, result.summary.model_dump_json(indent=2).encode())
    return Summary.model_validate_json(path.read_text(encoding="utf-8"))


if __name__ == "__main__":
    standard_output.run(main)
