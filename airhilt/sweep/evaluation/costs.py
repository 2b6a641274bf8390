"""Costs of an assistant to people, as cells of a table."""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.sweep.evaluation import scores
from airhilt.sweep.evaluation.preset import Row
from airhilt.sweep.evaluation.scores import Baselines
from airhilt.sweep.evaluation.tables import Cell, number

COSTS = ("extra broken off", "extra frequency, s", "advisories, 1/h")
NOTE = (
    "Extra: more than in the runs without an assistant, per run: go-arounds and rejected "
    "take-offs; time for which somebody is on the air."
)


def costs(rows: Sequence[Row], baselines: Baselines) -> tuple[Cell, ...]:
    """Return the cells of `COSTS`."""
    return (
        number(scores.added(rows, baselines, scores.broken_off), 2),
        number(scores.added(rows, baselines, scores.occupied_s)),
        number(scores.advisories_per_hour(rows)),
    )
