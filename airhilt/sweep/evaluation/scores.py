"""Scores of groups of runs, with intervals by clusters of scenarios or seeds.

A run is compared with another of the same scenario and seed: one without an assistant, or one with
another assistant. docs/evaluation.md has the definitions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from airhilt.metrics.estimates import (
    Estimate,
    IntArray,
    clusters_of,
    mean_of,
    median_of,
    rate_of,
    share_of,
)
from airhilt.metrics.measures import HOUR_S
from airhilt.sweep.evaluation.preset import Row

AVOIDED = "avoided"
SERIOUS_INCURSIONS = ("A", "B")
"""Categories of runway incursions that are harm; an accident is a collision."""
Pair = tuple[str, int]
"""Scenario and seed, which runs with different assistants share."""
SEVERITIES: Mapping[str, Callable[[Row], int]] = {
    "INFO, ADVISORY": lambda row: int(row["advisories"] - row["cautions"] - row["warnings"]),
    "CAUTION": lambda row: int(row["cautions"]),
    "WARNING": lambda row: int(row["warnings"]),
}
"""Number of a run's advisories by their highest severity."""


@dataclass(frozen=True)
class Baselines:
    """Runs that others are compared with, by scenario and seed.

    Attributes
    ----------
    lost
        Runs without an assistant that ended with harm to the pair.
    nobody
        Runs without an assistant.
    well_clear_s
        Time of the first warning of `well_clear`, where it gave one.
    """

    lost: frozenset[Pair]
    nobody: Mapping[Pair, Row]
    well_clear_s: Mapping[Pair, float]

    @classmethod
    def of(cls, nobody: Sequence[Row], well_clear: Sequence[Row]) -> Baselines:
        """Return the baselines in runs without an assistant, and with `well_clear`."""
        return cls(
            frozenset(pair_of(row) for row in nobody if row["avoided"] is False),
            {pair_of(row): row for row in nobody},
            {
                pair_of(row): row["t_first_warning_s"]
                for row in well_clear
                if row["t_first_warning_s"] is not None
            },
        )


def pair_of(row: Row) -> Pair:
    """Return scenario and seed of a run."""
    return row["scenario"], row["seed"]


def with_conflict(rows: Sequence[Row]) -> list[Row]:
    """Return the runs of scenarios that declare a conflict."""
    return [row for row in rows if row["nominal"] is False]


def known(rows: Sequence[Row], column: str) -> list[Row]:
    """Return the runs in which a column is not null."""
    return [row for row in rows if row.get(column) is not None]


def values(rows: Sequence[Row], column: str) -> list[Any]:
    """Return the values of a column that are not null."""
    return [row[column] for row in known(rows, column)]


def share(rows: Sequence[Row], column: str) -> Estimate:
    """Return the share of runs in which a column is true, of those in which it is not null."""
    return share_of(values(rows, column), _clusters(known(rows, column)))


def share_where(rows: Sequence[Row], is_so: Callable[[Row], bool]) -> Estimate:
    """Return the share of runs of which something is so."""
    return share_of([is_so(row) for row in rows], _clusters(rows))


def mean(rows: Sequence[Row], column: str) -> Estimate:
    """Return the mean of a column over the runs in which it is not null."""
    return mean_of(values(rows, column), _clusters(known(rows, column)))


def median(rows: Sequence[Row], column: str) -> Estimate:
    """Return the median of a column over the runs in which it is not null."""
    return median_of(values(rows, column), _clusters(known(rows, column)))


def mean_over(rows: Sequence[Row], number: Callable[[Row], float]) -> Estimate:
    """Return the mean of a number over runs."""
    return mean_of([number(row) for row in rows], _clusters(rows))


def _clusters(rows: Sequence[Row]) -> IntArray:
    return clusters_of([row["scenario"] for row in rows], [row["seed"] for row in rows])


def per_hour(rows: Sequence[Row], column: str) -> Estimate:
    """Return the sum of a column in an hour of the runs."""
    hours = [row["duration_s"] / HOUR_S for row in rows]
    return rate_of([row[column] for row in rows], hours, _clusters(rows))


def avoided(rows: Sequence[Row], baselines: Baselines) -> Estimate:
    """Return the share of runs without harm to the pair, of those with harm without an assistant.

    The runs are the same but for the assistant, so whatever is different came of it, also where
    its warning was over before the conflict began.
    """
    lost = [row for row in rows if pair_of(row) in baselines.lost]
    return share_of([row["avoided"] is not False for row in lost], _clusters(lost))


def harm_of(row: Row) -> str:
    """Return the worst that a run came to, `AVOIDED` if the pair came to no harm."""
    if row["avoided"] is not False:
        return AVOIDED
    category = row["runway_incursion_category"]
    found = {
        "collision": row["collision"],
        "NMAC": row["nmac"],
        f"incursion {category}": category in SERIOUS_INCURSIONS,
    }
    return next((harm for harm, has_it in found.items() if has_it), "loss of separation")


def margin_over_well_clear(rows: Sequence[Row], baselines: Baselines) -> Estimate:
    """Return the mean time by which a warning came before that of `well_clear`, in s."""
    warned, others_s = known(rows, "t_first_warning_s"), baselines.well_clear_s
    both = [row for row in warned if pair_of(row) in others_s]
    return mean_over(both, lambda row: others_s[pair_of(row)] - row["t_first_warning_s"])


def nuisance_per_hour(rows: Sequence[Row]) -> Estimate:
    """Return the nuisance alerts in an hour of nominal traffic, where they were counted."""
    counted = known(rows, "nuisance_alerts")
    return per_hour([row for row in counted if row["nominal"] is True], "nuisance_alerts")


def broken_off(row: Row) -> int:
    """Return how many approaches and take-offs were broken off in a run."""
    return int(row["costs_go_arounds"] + row["costs_rejected_takeoffs"])


def added(rows: Sequence[Row], baselines: Baselines, number: Callable[[Row], float]) -> Estimate:
    """Return the mean of a number of runs less that of the runs without an assistant."""
    paired = [row for row in rows if pair_of(row) in baselines.nobody]
    return mean_over(paired, lambda row: number(row) - number(baselines.nobody[pair_of(row)]))


def followed_by_loss(
    rows: Sequence[Row], severity: str, is_lost: Callable[[Row], bool]
) -> Estimate:
    """Return the share of the advisories of a severity that are in runs with a loss.

    Its number of runs is that of those with such an advisory.
    """
    count = SEVERITIES[severity]
    having = [row for row in rows if count(row)]
    return share_of(
        [is_lost(row) for row in having], _clusters(having), [count(row) for row in having]
    )
