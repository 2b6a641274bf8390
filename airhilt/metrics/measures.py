"""Measures of many runs: a share, a mean or a rate of a column of the table of a sweep."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from airhilt.metrics.estimates import UNKNOWN, Estimate, clusters_of, mean_of, rate_of, share_of

if TYPE_CHECKING:
    from pandas import DataFrame

HOUR_S = 3600.0
PERCENT = 100.0


@dataclass(frozen=True)
class Measure:
    """A number over many runs, of the values in one column that are not null."""

    name: str
    title: str
    unit: str
    kind: Literal["share", "mean", "per_hour"]
    """share: of the runs in which the column is true; mean: of the values; per_hour: sum of the
    column by simulated hour."""
    column: str
    only_nominal: bool = False
    """True if only runs without a conflict count."""

    @property
    def columns(self) -> list[str]:
        """Columns that the number is made of."""
        return list(dict.fromkeys((self.column, "nominal", "duration_s", "scenario", "seed")))

    @property
    def label(self) -> str:
        """Title with the unit, for an axis."""
        return f"{self.title} ({self.unit})"

    def estimate(self, runs: DataFrame) -> Estimate:
        """Return the number over some runs of a table, in its unit.

        It is unknown if the table has no such column, or no values in it.
        """
        estimate = self._estimate(runs)
        return estimate.times(PERCENT) if self.unit == "%" else estimate

    def _estimate(self, runs: DataFrame) -> Estimate:
        if self.column not in runs.columns:
            return UNKNOWN
        if self.only_nominal:
            runs = runs[runs["nominal"].fillna(False).astype(bool)]
        values = runs[self.column].dropna()
        known = runs.loc[values.index]
        clusters = clusters_of(known["scenario"].to_numpy(), known["seed"].to_numpy())
        if self.kind == "share":
            return share_of(values.to_numpy(dtype=np.bool_), clusters)
        if self.kind == "mean":
            return mean_of(values.to_numpy(dtype=np.float64), clusters)
        hours = known["duration_s"].to_numpy(dtype=np.float64) / HOUR_S
        return rate_of(values.to_numpy(dtype=np.float64), hours, clusters)


TIME_TO_FIRST_WARNING = Measure(
    "time_to_first_warning", "Time to first warning", "s", "mean", "time_to_first_warning_s"
)
TIME_AFTER_WINDOW = Measure(
    "time_to_first_warning_after_window",
    "Time to first warning from the conflict window on",
    "s",
    "mean",
    "time_to_first_warning_after_window_s",
)
WARNED = Measure("warned", "Warned", "%", "share", "warned")
IN_TIME = Measure("warned_in_time", "Warned in time", "%", "share", "warned_in_time")
MISSED = Measure("missed", "Missed", "%", "share", "missed")
AVOIDED = Measure("avoided", "Avoided", "%", "share", "avoided")
LOST = Measure("lost", "Separation lost or worse", "%", "share", "lost")
LEAD = Measure(
    "lead", "Lead before closest approach", "s", "mean", "lead_before_closest_approach_s"
)
NUISANCE = Measure("nuisance", "Nuisance alerts", "1/h", "per_hour", "nuisance_alerts")
NOMINAL_NUISANCE = Measure(
    "nominal_nuisance", "Nuisance in nominal traffic", "1/h", "per_hour", "nuisance_alerts", True
)
WORD_ERRORS = Measure("wer", "Word error rate", "%", "mean", "radio_wer")
FIRST_DETECTION = Measure(
    "first_detection_range", "First detection range", "m", "mean", "first_detection_range_m"
)
RECALL = Measure("recall", "Recall of sightings", "%", "mean", "vision_recall")
GO_AROUNDS = Measure("go_arounds", "Go-arounds", "per run", "mean", "costs_go_arounds")
REJECTED_TAKEOFFS = Measure(
    "rejected_takeoffs", "Rejected take-offs", "per run", "mean", "costs_rejected_takeoffs"
)
LEVEL_DEVIATION = Measure(
    "level_deviation", "Off the planned level", "ft s", "mean", "costs_level_deviation_ft_s"
)
PATH_DEVIATION = Measure(
    "path_deviation", "Off the planned path", "NM s", "mean", "costs_path_deviation_nm_s"
)
TRANSMISSIONS = Measure("transmissions", "Transmissions", "per run", "mean", "radio_transmissions")
OCCUPIED = Measure("occupied", "Frequency occupied", "s", "mean", "radio_occupied_s")
CLARIFICATIONS = Measure(
    "clarifications", "Clarifications asked", "per run", "mean", "radio_clarifications"
)
ADVISORIES = Measure("advisories", "Advisories", "1/h", "per_hour", "advisories")
ADVICE_SPOKEN = Measure("advice_spoken", "Advice spoken", "s", "mean", "costs_advice_spoken_s")
COSTS = (
    GO_AROUNDS,
    REJECTED_TAKEOFFS,
    LEVEL_DEVIATION,
    PATH_DEVIATION,
    TRANSMISSIONS,
    OCCUPIED,
    CLARIFICATIONS,
    ADVISORIES,
    ADVICE_SPOKEN,
)
"""Costs of a run to the people in it; those of an assistant are the difference to a run without."""
MEASURES = (
    TIME_TO_FIRST_WARNING,
    TIME_AFTER_WINDOW,
    WARNED,
    IN_TIME,
    MISSED,
    AVOIDED,
    LOST,
    LEAD,
    NUISANCE,
    NOMINAL_NUISANCE,
    WORD_ERRORS,
    FIRST_DETECTION,
    RECALL,
    *COSTS,
)
"""All of them, in the order in which pages show them."""
