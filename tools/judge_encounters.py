"""Judges a decision engine on random encounters of two aircraft.

    python tools/judge_encounters.py
    python tools/judge_encounters.py --count 1000 --seed 7 --assistant reference
    python tools/judge_encounters.py --closed-loop --count 1000
    python tools/judge_encounters.py --json

In open loop nobody reacts. It counts the losses of separation (5 NM and 1,000 ft) of which no
CAUTION or WARNING told before, how long before a loss the WARNING came, and the encounters outside
of 1.5 times the minima in which there was one.

In closed loop the two pass close, and crews act: both as they are told, or one does nothing, or one
does the opposite because of a controller. For each response model it counts the near mid-air
collisions without the engine, those of them that it leaves (unresolved), and the others that come
about with it (induced). `pairs.geometry` gives the distributions.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial

import numpy as np
from rich.console import Console
from rich.progress import track
from rich.table import Table

import standard_output
from airhilt.engine_families import ASSISTANTS
from airhilt.scenario.models.responses import RESPONSE_MODELS
from pairs import closed_loop
from pairs.closed_loop import Crews, Manner
from pairs.flying import Outcome, fly
from pairs.geometry import draw, draw_close

IN_TIME_S = 30.0
"""A WARNING comes in time if it is at least this long before the loss, in s."""
LONG_BEFORE_S = 60.0
"""A manoeuvre that begins this long before the loss leaves time for a WARNING, in s."""
ALLOWANCE_S = 5.0
"""Time after the begin of a manoeuvre, in s, in which it shows in ADS-B and is believed."""
OUTSIDE = 1.5
MANNERS: tuple[tuple[Manner, Manner], ...] = (
    ("follows", "follows"),
    ("follows", "ignores"),
    ("follows", "opposite"),
)
"""Manners of the two crews, in closed loop."""
CREWS = tuple(Crews(model, manners) for model in RESPONSE_MODELS for manners in MANNERS)
Counts = dict[str, int]
"""Near mid-air collisions of one encounter (0 or 1 of each kind), alerts and reversals."""


def main() -> None:
    """Fly the encounters and print what they came to."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=300, help="number of encounters")
    parser.add_argument("--seed", type=int, default=0, help="seed of the draws")
    parser.add_argument("--assistant", default="reference", help="decision engine")
    parser.add_argument("--closed-loop", action="store_true", help="crews act")
    parser.add_argument(
        "--jobs", type=int, help="processes, in closed loop; as many as CPUs unless given"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    given = parser.parse_args()
    if given.closed_loop:
        print_closed_loop(given)
        return
    outcomes = []
    for number in track(range(given.count), "flying", disable=given.json, transient=True):
        encounter = draw(np.random.default_rng((given.seed, number)))
        outcomes.append(fly(encounter, ASSISTANTS.create(given.assistant), given.seed + number))
    numbers = judged(outcomes)
    if given.json:
        print(json.dumps(numbers, indent=2))
        return
    for name, value in numbers.items():
        print(f"{name:40}{value if value is not None else '-'}")


def print_closed_loop(given: argparse.Namespace) -> None:
    """Fly close encounters with crews that act, and print what they came to."""
    flown = closed_loop_flights(range(given.count), given.seed, given.assistant, given.jobs)
    counts = list(track(flown, "flying", given.count, disable=given.json, transient=True))
    rows = closed_loop_rows(counts)
    if given.json:
        print(json.dumps({"encounters": given.count, "rows": rows}, indent=2))
        return
    table = Table(*rows[0], title=f"{given.count} encounters")
    for row in rows:
        table.add_row(*map(str, row.values()))
    Console().print(table)


def closed_loop_flights(
    numbers: Iterable[int], seed: int, assistant: str, jobs: int | None = None
) -> Iterator[list[Counts]]:
    """Yield what close encounters came to, in their order, flown by so many processes."""
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(partial(closed_loop_counts, seed=seed, assistant=assistant), numbers)


def closed_loop_counts(number: int, seed: int, assistant: str) -> list[Counts]:
    """Fly a close encounter once with each of `CREWS`; return what it came to, in their order."""
    encounter = draw_close(np.random.default_rng((seed, number)))
    unassisted = closed_loop.fly_on(encounter)
    counts = []
    for crews in CREWS:
        flown = closed_loop.fly(encounter, ASSISTANTS.create(assistant), crews, seed + number)
        counts.append(
            {
                "unassisted": int(unassisted.is_nmac),
                "unresolved": int(flown.is_nmac and unassisted.is_nmac),
                "induced": int(flown.is_nmac and not unassisted.is_nmac),
                "alerts": flown.alerts,
                "reversals": flown.reversals,
            }
        )
    return counts


def closed_loop_rows(encounters: Sequence[Sequence[Counts]]) -> list[dict[str, int | str]]:
    """Return the sums over encounters for each of `CREWS`."""
    rows: list[dict[str, int | str]] = []
    for crews, counts in zip(CREWS, zip(*encounters, strict=True), strict=True):
        first, second = crews.manners
        sums = {name: sum(one[name] for one in counts) for name in counts[0]}
        rows.append({"crews": crews.model, "first": first, "second": second, **sums})
    return rows


def judged(outcomes: Sequence[Outcome]) -> dict[str, float | int | list[int] | None]:
    """Return what encounters came to; numbers of encounters where a list is given."""
    lost = {n: o for n, o in enumerate(outcomes) if o.loss_s is not None}
    steady = {n: o for n, o in lost.items() if _begun_long_before(o)}
    sudden = {n: o for n, o in lost.items() if n not in steady}
    outside = {n: o for n, o in enumerate(outcomes) if o.least > OUTSIDE}
    leads = [lead for o in steady.values() if (lead := _lead_s(o)) is not None]
    return {
        "encounters": len(outcomes),
        "losses": len(lost),
        "losses_missed": [n for n, o in lost.items() if not _was_told(o)],
        "losses_flown_on_as_begun": len(steady),
        "warning_late": [n for n, o in steady.items() if (_lead_s(o) or -1.0) < IN_TIME_S],
        "warning_lead_median_s": float(np.median(leads)) if leads else None,
        "warning_lead_least_s": min(leads, default=None),
        "losses_after_a_late_manoeuvre": len(sudden),
        "warning_late_for_the_manoeuvre": [n for n, o in sudden.items() if _is_late(o)],
        "outside_1.5_minima": len(outside),
        "warning_outside": [n for n, o in outside.items() if o.warning_s is not None],
        "caution_outside": [n for n, o in outside.items() if o.caution_s is not None],
    }


def _begun_long_before(outcome: Outcome) -> bool:
    begun_s = 0.0 if outcome.begun_s is None else outcome.begun_s
    return outcome.loss_s is not None and outcome.loss_s - begun_s >= LONG_BEFORE_S


def _was_told(outcome: Outcome) -> bool:
    """Return whether a CAUTION came before the loss, or as soon as a manoeuvre lets it."""
    if outcome.loss_s is None or outcome.caution_s is None:
        return False
    seen_s = -math.inf if outcome.begun_s is None else outcome.begun_s + ALLOWANCE_S
    return outcome.caution_s <= max(outcome.loss_s, seen_s)


def _lead_s(outcome: Outcome) -> float | None:
    if outcome.loss_s is None or outcome.warning_s is None:
        return None
    return outcome.loss_s - outcome.warning_s


def _is_late(outcome: Outcome) -> bool:
    """Return whether a WARNING came later than a manoeuvre allows, and under 30 s before."""
    lead_s = _lead_s(outcome)
    if lead_s is None or outcome.warning_s is None:
        return True
    since_s = outcome.warning_s - (outcome.begun_s or 0.0)
    return lead_s < IN_TIME_S and since_s > ALLOWANCE_S


if __name__ == "__main__":
    standard_output.run(main)
