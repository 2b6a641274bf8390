"""The ranking of assistants by Youden's index over conflicts and their nominal twins.

The index (Youden, Cancer 3:32, 1950) is the share of conflicts averted, less those that an
assistant has brought about, plus the share of nominal twins that it left undisturbed, minus one.
Who says nothing has 0, and who warns of everything has at most 0.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from pydantic import JsonValue

from airhilt.engine_families import NONE
from airhilt.metrics.estimates import Estimate, sum_of_ratios
from airhilt.sweep.evaluation import scores
from airhilt.sweep.evaluation.assistants import CONTROLS, Assistant, shipped_scenarios
from airhilt.sweep.evaluation.costs import COSTS, NOTE, costs
from airhilt.sweep.evaluation.preset import Choice, Row
from airhilt.sweep.evaluation.scores import Baselines
from airhilt.sweep.evaluation.tables import Cell, Scatter, Table, number, share
from airhilt.sweep.specification import Specification

TWINS = "twins_"
"""Beginning of the names of the sweeps of nominal twins; the assistant's name follows."""
COLUMNS = (
    "assistant", "index", "averted", "brought about", "twins undisturbed", "warning, s",
    "warning after window, s", "nuisance, 1/h", "questions, 1/h", *COSTS,
)  # fmt: skip


@dataclass(frozen=True)
class Tried:
    """Runs of one assistant with conflicts, and with their nominal twins."""

    conflicts: Sequence[Row]
    twins: Sequence[Row]


def sweeps(
    choice: Choice,
    assistants: Sequence[Assistant],
    names: Sequence[str],
    settled: Mapping[str, JsonValue],
) -> dict[str, Specification]:
    """Return the sweeps of a ranking over scenarios, by name.

    There are two of each assistant and each control, with conflicts and with their twins, and one
    without an assistant.
    """
    found = {NONE: choice.specification(names, {**settled, "assistant": NONE})}
    for each in (*assistants, *CONTROLS):
        found |= both_sweeps(choice, each, names, settled)
    return found


def both_sweeps(
    choice: Choice, assistant: Assistant, names: Sequence[str], settled: Mapping[str, JsonValue]
) -> dict[str, Specification]:
    """Return the two sweeps of an assistant over the scenarios that it applies to, by name."""
    own = [name for name in names if assistant.applies_to(shipped_scenarios()[name])]
    with_conflicts = choice.specification(own, {**settled, **_options(assistant)})
    return {assistant.label: with_conflicts, **twins(choice, assistant, own, settled)}


def twins(
    choice: Choice,
    assistant: Assistant,
    names: Sequence[str],
    settled: Mapping[str, JsonValue],
    axes: Mapping[str, Sequence[JsonValue]] | None = None,
) -> dict[str, Specification]:
    """Return the sweep of an assistant with the nominal twins of scenarios, by its name."""
    own = [name for name in names if shipped_scenarios()[name].nominal_twin is not None]
    options = {**settled, **_options(assistant), "twin": True}
    return {f"{TWINS}{assistant.label}": choice.specification(own, options, axes)}


def _options(assistant: Assistant) -> dict[str, JsonValue]:
    return {"assistant": assistant.name, "modalities": assistant.modalities}


def tried(rows: Mapping[str, Sequence[Row]]) -> dict[str, Tried]:
    """Return the runs of each assistant that has twins, by its name."""
    return {
        name: Tried(scores.with_conflict(own), rows[f"{TWINS}{name}"])
        for name, own in rows.items()
        if f"{TWINS}{name}" in rows
    }


def youden_index(tried: Tried, nobody: Sequence[Row]) -> Estimate:
    """Return the index of an assistant, with an interval by scenarios.

    ``nobody`` are the runs without an assistant, which are compared by scenario and seed.
    """
    was_lost = {scores.pair_of(row): bool(row["lost"]) for row in nobody}
    conflicts = [row for row in tried.conflicts if scores.pair_of(row) in was_lost]
    names = sorted({row["scenario"] for row in (*conflicts, *tried.twins)})
    above, below = np.zeros((len(names), 2)), np.zeros((len(names), 2))
    for row in conflicts:
        place = names.index(row["scenario"]), 0
        above[place] += was_lost[scores.pair_of(row)] - bool(row["lost"])
        below[place] += was_lost[scores.pair_of(row)]
    for row in scores.known(tried.twins, "nuisance_alerts"):
        place = names.index(row["scenario"]), 1
        above[place] += is_undisturbed(row)
        below[place] += 1
    found = sum_of_ratios(above, below, len(conflicts) + len(tried.twins))
    return found.plus(-1.0).within(-1.0, 1.0)


def is_undisturbed(twin: Row) -> bool:
    """Return whether nobody was alerted or asked in a nominal twin, nor came to harm."""
    return not (twin["nuisance_alerts"] or twin["clarifications"] or twin["lost"])


def table(tried: Mapping[str, Tried], nobody: Sequence[Row]) -> Table:
    """Return the ranking of what was tried, by name, the highest index first."""
    baselines = Baselines.of(nobody, ())
    indices = {name: youden_index(own, nobody) for name, own in tried.items()}
    in_order = sorted(tried, key=lambda name: _or_last(indices[name].value), reverse=True)
    return Table(
        name="ranking",
        title="Ranking",
        columns=COLUMNS,
        rows=tuple((name, *_cells(tried[name], indices[name], baselines)) for name in in_order),
        notes=(
            "Index: share of the conflicts averted, less those brought about, plus the share of "
            "nominal twins undisturbed, minus 1 (Youden). Averted: no harm to anybody, of the runs "
            "with harm without an assistant. Brought about: harm, of the others. Undisturbed: no "
            "alert, no question and no harm in the same traffic without its conflict, over which "
            "nuisance and questions are counted too. Warning: mean time from the event by which "
            "the conflict comes about, and from the opening of its window, to the first warning. "
            "`silent` and `cry_wolf` are negative controls. Each is ranked over the scenarios that "
            "it is made for.",
            NOTE,
        ),
        figure=Scatter(x="twins undisturbed", y="averted"),
    )


def _or_last(index: float | None) -> float:
    return -math.inf if index is None or math.isnan(index) else index


def _cells(tried: Tried, index: Estimate, baselines: Baselines) -> tuple[Cell, ...]:
    known = [row for row in tried.conflicts if scores.pair_of(row) in baselines.nobody]
    lost = [row for row in known if baselines.nobody[scores.pair_of(row)]["lost"]]
    others = [row for row in known if not baselines.nobody[scores.pair_of(row)]["lost"]]
    twins = scores.known(tried.twins, "nuisance_alerts")
    return (
        number(index, 2),
        share(scores.share_where(lost, lambda row: not row["lost"])),
        share(scores.share_where(others, lambda row: bool(row["lost"]))),
        share(scores.share_where(twins, is_undisturbed)),
        number(scores.mean(tried.conflicts, "time_to_first_warning_s"), 1),
        number(scores.mean(tried.conflicts, "time_to_first_warning_after_window_s"), 1),
        number(scores.nuisance_per_hour(tried.twins)),
        number(scores.per_hour(tried.twins, "clarifications")),
        *costs(tried.conflicts, baselines),
    )
