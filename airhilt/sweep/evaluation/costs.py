"""Costs of an assistant to people, as cells of a table."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from airhilt.metrics.estimates import Estimate
from airhilt.sweep.evaluation import scores
from airhilt.sweep.evaluation.preset import Row
from airhilt.sweep.evaluation.scores import Baselines
from airhilt.sweep.evaluation.tables import Cell, number

COSTS = ("extra broken off", "extra frequency, s", "advisories, 1/h")
"""The costs that stand beside other columns."""
EVERY_COST = (*COSTS, "extra level, ft s", "extra path, NM s", "questions, 1/h", "spoken advice, s")
NOTE = (
    "Extra: more than in the runs without an assistant, per run: go-arounds and rejected "
    "take-offs; time for which somebody is on the air; deviations from levels and paths times "
    "their duration. Questions: for what was heard in doubt. Spoken advice: time of its voice in a "
    "run."
)


def costs(
    rows: Sequence[Row], baselines: Baselines, names: Sequence[str] = COSTS
) -> tuple[Cell, ...]:
    """Return the cells of some costs."""

    def added(value: Callable[[Row], float]) -> Estimate:
        return scores.added(rows, baselines, value)

    found: dict[str, Callable[[], Cell]] = {
        "extra broken off": lambda: number(added(scores.broken_off), 2),
        "extra frequency, s": lambda: number(added(lambda row: row["radio_occupied_s"])),
        "advisories, 1/h": lambda: number(scores.per_hour(rows, "advisories")),
        "extra level, ft s": lambda: number(
            added(lambda row: row["costs_level_deviation_ft_s"]), 0
        ),
        "extra path, NM s": lambda: number(added(lambda row: row["costs_path_deviation_nm_s"])),
        "questions, 1/h": lambda: number(scores.per_hour(rows, "clarifications")),
        "spoken advice, s": lambda: number(scores.mean(rows, "costs_advice_spoken_s")),
    }
    return tuple(found[name]() for name in names)
