"""Measures how long before the closest approach assistants warn, if nobody does what they say.

    python tools/warning_leads.py
    python tools/warning_leads.py --scenarios "s02a_*" --assistants tcas,tcas:hmd --seeds 3
    python tools/warning_leads.py --json

Runs have no cameras and no sound, and fixed latencies. No crew complies, so all assistants are
measured against the same closest approach. Nuisance alerts do not count. With several seeds the
numbers are medians.
"""

from __future__ import annotations

import argparse
import json
import statistics
import tempfile
from collections.abc import Sequence
from fnmatch import fnmatch
from pathlib import Path
from typing import NamedTuple

from rich.console import Console
from rich.progress import track
from rich.table import Table

import standard_output
from airhilt import load, run
from airhilt.host.library import names
from airhilt.messages import Advisory, Severity
from airhilt.metrics.summary import Summary
from airhilt.record import read_log
from airhilt.scenario import Scenario
from airhilt.scenario.models import AircraftSpec
from airhilt.units import SECOND_NS

ASSISTANTS = "tcas,tcas:hmd,well_clear,conflict_alert,adsb_only,reference"
SCENARIOS = "s02a_*,s02b_*"


class Lead(NamedTuple):
    """Seconds before the closest approach; None where there was no such advisory."""

    scenario: str
    seed: int
    assistant: str
    caution_s: float | None
    warning_s: float | None


def main() -> None:
    """Run all combinations and print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenarios", default=SCENARIOS, help="patterns, separated by commas")
    parser.add_argument("--assistants", default=ASSISTANTS, help="names, separated by commas")
    parser.add_argument("--seeds", type=int, default=1, help="number of seeds, from 0 on")
    parser.add_argument("--json", action="store_true", help="print all leads as JSON")
    given = parser.parse_args()
    patterns, assistants = given.scenarios.split(","), given.assistants.split(",")
    cases = [
        (scenario, seed, assistant)
        for scenario in names("scenarios")
        if any(fnmatch(scenario, pattern) for pattern in patterns)
        for seed in range(given.seeds)
        for assistant in assistants
    ]
    leads = [
        _lead(scenario, seed, assistant)
        for scenario, seed, assistant in track(
            cases, "flying", disable=given.json, transient=True, console=Console(stderr=True)
        )
    ]
    if given.json:
        print(json.dumps([lead._asdict() for lead in leads], indent=2))
    else:
        Console().print(_table(leads, assistants))


def _lead(name: str, seed: int, assistant: str) -> Lead:
    """Return the leads of one run."""
    with tempfile.TemporaryDirectory() as scratch:
        result = run(
            unheeded(load(name)), seed=seed, assistant=assistant, out=Path(scratch) / "run",
            cameras=False, speech=False, latency="fixed",
        )  # fmt: skip
        advisories = [
            Advisory.model_validate_json(logged.data)
            for logged in read_log(result.folder / "log.mcap")
            if logged.key.startswith("advisory/")
        ]
    caution_s, warning_s = (
        lead_s(result.summary, advisories, severity)
        for severity in (Severity.CAUTION, Severity.WARNING)
    )
    return Lead(name, seed, assistant, caution_s, warning_s)


def lead_s(summary: Summary, advisories: Sequence[Advisory], severity: Severity) -> float | None:
    """Return how long before the closest approach the first advisory came that is so severe."""
    meant = {one.id for one in summary.advisories if not one.nuisance_to}
    times = [
        each.t_ns for each in advisories if each.id in meant and each.severity.rank >= severity.rank
    ]
    closest = summary.closest_approach
    return None if not times or closest is None else closest.t_s - min(times) / SECOND_NS


def unheeded(scenario: Scenario) -> Scenario:
    """Return a scenario in which no crew complies, and in which nobody else warns."""
    actors = tuple(
        actor.model_copy(update={"pilot": actor.pilot.model_copy(update={"compliance": 0.0})})
        if isinstance(actor, AircraftSpec)
        else actor
        for actor in scenario.actors
    )
    return scenario.model_copy(update={"actors": actors, "equipment": ()})


def _table(leads: Sequence[Lead], assistants: Sequence[str]) -> Table:
    table = Table("scenario", *assistants)
    for name in dict.fromkeys(lead.scenario for lead in leads):
        cells = []
        for assistant in assistants:
            own = [each for each in leads if (each.scenario, each.assistant) == (name, assistant)]
            cells.append(f"{median_of(own, 'caution_s')} / {median_of(own, 'warning_s')}")
        table.add_row(name, *cells)
    return table


def median_of(leads: Sequence[Lead], field: str) -> str:
    """Return the median of a field where there was such an advisory, as the table shows it."""
    found = [value for lead in leads if (value := getattr(lead, field)) is not None]
    return f"{statistics.median(found):.0f}" if found else "-"


if __name__ == "__main__":
    standard_output.run(main)
