"""Numbers over the runs of a table: which runs count, and by how much time."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from airhilt.metrics.estimates import mean_of, rate_of, share_of
from airhilt.metrics.measures import AVOIDED, LEAD, MEASURES, NOMINAL_NUISANCE, NUISANCE

RUNS = pd.DataFrame(
    {
        "nominal": pd.array([True, False, None, True], "boolean"),
        "nuisance_alerts": pd.array([1, 5, 7, None], "Int64"),
        "duration_s": [1800.0, 1800.0, 3600.0, 7200.0],
        "avoided": pd.array([True, False, None, True], "boolean"),
        "scenario": "s01a_one",
        "seed": range(4),
    }
)


def test_nuisance_in_nominal_traffic_is_that_of_runs_without_a_conflict() -> None:
    assert NOMINAL_NUISANCE.estimate(RUNS).value == pytest.approx(1 / 0.5)


def test_the_time_of_a_run_whose_alerts_nobody_counted_is_not_counted_either() -> None:
    assert NUISANCE.estimate(RUNS).value == pytest.approx(13 / 2.0)


TEN = pd.DataFrame(
    {
        "nominal": [False] * 10,
        "duration_s": np.linspace(900.0, 1800.0, 10),
        "nuisance_alerts": [0, 1, 2, 0, 3, 1, 0, 0, 5, 1],
        "lead_before_closest_approach_s": np.linspace(5.0, 60.0, 10) ** 1.2,
        "avoided": [True] * 7 + [False] * 3,
        "scenario": [f"s01a_{number % 5}" for number in range(10)],
        "seed": range(10),
    }
)


def test_each_number_has_the_interval_of_its_kind_over_the_scenarios() -> None:
    """Shares in percent, rates by the hour."""
    clusters = np.arange(10) % 5
    leads = TEN["lead_before_closest_approach_s"].to_numpy()
    alerts, hours = TEN["nuisance_alerts"].to_numpy(float), TEN["duration_s"].to_numpy() / 3600.0
    assert LEAD.estimate(TEN) == mean_of(leads, clusters)
    assert NUISANCE.estimate(TEN) == rate_of(alerts, hours, clusters)
    assert AVOIDED.estimate(TEN) == share_of([True] * 7 + [False] * 3, clusters).times(100.0)
    for each in (LEAD, NUISANCE, AVOIDED):
        found = each.estimate(TEN)
        assert None not in (found.low, found.high)


def test_without_the_column_or_without_values_nothing_is_known() -> None:
    for each in MEASURES:
        assert each.estimate(pd.DataFrame({"duration_s": [1.0], "nominal": [True]})).n == 0
    assert NOMINAL_NUISANCE.estimate(TEN).n == 0
